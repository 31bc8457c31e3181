#include "mpc_profile.h"

#include "comm.h"
#include "domain.h"
#include "error.h"
#include "update.h"

#include <algorithm>

using namespace LAMMPS_NS;

MpcProfile::MpcProfile(LAMMPS *lmp, const std::string &file, bool append, const char *fix) :
    Pointers(lmp)
{
  if (comm->me != 0) return;
  file_ = std::fopen(file.c_str(), append ? "a" : "w");
  if (!file_) error->one(FLERR, "fix mpc: profile: cannot write {}", file);
  if (!append)
    std::fprintf(file_,
                 "# Chunk-averaged data for fix %s and group fluid\n"
                 "# Timestep Number-of-chunks Total-count\n"
                 "# Chunk Coord1 Ncount density/number vx temp\n",
                 fix);
}

MpcProfile::~MpcProfile()
{
  if (file_) std::fclose(file_);
}

void MpcProfile::look(const std::vector<mpc::Layer> &now)
{
  sums_.resize(now.size());
  for (std::size_t bin = 0; bin < now.size(); ++bin) {
    sums_[bin].count += now[bin].count;
    sums_[bin].momentum_x += now[bin].momentum_x;
    sums_[bin].squares += now[bin].squares;
  }
  ++looks_;
}

void MpcProfile::write(double particles)
{
  if (comm->me == 0) {
    const int bins = static_cast<int>(sums_.size());
    const double depth = domain->yprd / bins;
    const double volume = depth * domain->xprd * (domain->dimension == 3 ? domain->zprd : 1);
    std::fprintf(file_, BIGINT_FORMAT " %d %g\n", update->ntimestep, bins, particles);
    for (int bin = 0; bin < bins; ++bin) {
      const auto &layer = sums_[bin];
      const double occupied = std::max(layer.count, 1.0);
      std::fprintf(file_, "  %d %g %g %g %.6g %.6g\n", bin + 1,
                   domain->boxlo[1] + depth * (bin + 0.5), layer.count / looks_,
                   layer.count / looks_ / volume, layer.momentum_x / occupied,
                   layer.squares / (domain->dimension * occupied));
    }
    std::fflush(file_);
  }
  sums_.clear();
  looks_ = 0;
}

#include "mpc_flow.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;

template <int D>
MpcFlow<D>::MpcFlow(LAMMPS *lmp, const FlowArguments<D> &given, mpc::Processes &processes,
                    const char *fix) :
    Pointers(lmp), given_(given), processes_(processes), sums_(given.bins)
{
  if (comm->me != 0) return;
  file_ = std::fopen(given.file.c_str(), given.append ? "a" : "w");
  if (!file_) error->one(FLERR, "fix mpc: flow: cannot write {}", given.file);
  if (given.append) return;
  const bool flat = D == 2;
  std::fprintf(file_,
               "# Chunk-averaged data for fix %s and group fluid\n"
               "# Timestep Number-of-chunks Total-count\n"
               "# Chunk Coord1 Coord2%s Ncount density/number vx vy%s temp\n",
               fix, flat ? "" : " Coord3", flat ? "" : " vz");
}

template <int D> MpcFlow<D>::~MpcFlow()
{
  if (file_) std::fclose(file_);
}

// What is half a box behind the atom, along periodic axes.
template <int D> mpc::Vector<D> MpcFlow<D>::origin(const mpc::Grid<D> &grid) const
{
  mpc::Vector<D> origin{};
  if (given_.around == 0) return origin;
  std::array<double, D + 1> atom_at{};    // the last component counts
  for (int i = 0; i < atom->nlocal; ++i) {
    if (atom->tag[i] != given_.around) continue;
    for (int a = 0; a < D; ++a) atom_at[a] = atom->x[i][a] - domain->boxlo[a];
    atom_at[D] = 1;
  }
  processes_.sum(atom_at.data(), D + 1);
  if (atom_at[D] != 1)
    error->all(FLERR, "fix mpc: flow {}: there is no such atom", given_.around);
  for (int a = 0; a < D; ++a) {
    if (!grid.periodic[a]) continue;
    const double behind = atom_at[a] - 0.5 * grid.box[a];
    origin[a] = behind - grid.box[a] * std::floor(behind / grid.box[a]);
  }
  return origin;
}

template <int D> void MpcFlow<D>::look(mpc::AnySolver<D> &solver)
{
  solver.look(sums_, origin(solver.grid()));
}

template <int D> void MpcFlow<D>::write(double particles)
{
  sums_.fold(processes_, comm->me == 0);
  if (comm->me == 0) {
    double volume = 1;
    std::array<double, D> edge, first;
    std::size_t total = 1;
    for (int a = 0; a < D; ++a) {
      const int bins = sums_.bins()[a];
      edge[a] = domain->prd[a] / bins;
      volume *= edge[a];
      total *= bins;
      const bool centred = given_.around && domain->periodicity[a];
      first[a] = 0.5 * edge[a] + (centred ? -0.5 * domain->prd[a] : domain->boxlo[a]);
    }
    std::fprintf(file_, BIGINT_FORMAT " %zu %g\n", update->ntimestep, total, particles);
    for (std::size_t bin = 0; bin < total; ++bin) {
      std::fprintf(file_, "  %zu", bin + 1);
      std::array<double, D> at;
      for (std::size_t rest = bin, a = D; a-- > 0; rest /= sums_.bins()[a])
        at[a] = first[a] + edge[a] * (rest % sums_.bins()[a]);
      for (int a = 0; a < D; ++a) std::fprintf(file_, " %g", at[a]);
      const double *sum = &sums_.sums()[bin * mpc::FlowSums<D>::WIDTH];
      const double count = sum[D + 1], occupied = std::max(count, 1.0);
      std::fprintf(file_, " %g %g", count / sums_.looks(), count / sums_.looks() / volume);
      for (int a = 0; a < D; ++a) std::fprintf(file_, " %.6g", sum[a] / occupied);
      std::fprintf(file_, " %.6g\n", sum[D] / (D * occupied));
    }
    std::fflush(file_);
  }
  sums_.clear();
}

template <int D> std::vector<double> MpcFlow<D>::state()
{
  sums_.fold(processes_, comm->me == 0);
  return sums_.state();
}

template <int D> bool MpcFlow<D>::restore(const std::vector<double> &state)
{
  return sums_.restore(state, comm->me == 0);
}

template class LAMMPS_NS::MpcFlow<2>;
template class LAMMPS_NS::MpcFlow<3>;

#include "fix_wall_lj115.h"

#include "atom.h"
#include "domain.h"
#include "error.h"
#include "update.h"

#include <cmath>
#include <string>

using namespace LAMMPS_NS;
using namespace FixConst;

FixWallLJ115::FixWallLJ115(LAMMPS *lmp, int narg, char **arg) : Fix(lmp, narg, arg)
{
  const std::string faces[] = {"xlo", "xhi", "ylo", "yhi", "zlo", "zhi"};
  for (int i = 3; i < narg; i += 4) {
    int face = 0;
    while (face < 6 && faces[face] != arg[i]) ++face;
    if (face == 6) error->all(FLERR, "fix wall/lj115: unknown face {}", arg[i]);
    if (i + 4 > narg)
      error->all(FLERR, "fix wall/lj115: {} must be followed by EDGE epsilon sigma", arg[i]);
    if (std::string(arg[i + 1]) != "EDGE")
      error->all(FLERR, "fix wall/lj115: position {} of {}: must be EDGE", arg[i + 1], arg[i]);
    if (domain->periodicity[face / 2])
      error->all(FLERR, "fix wall/lj115: face {} is periodic", arg[i]);
    const double epsilon = utils::numeric(FLERR, arg[i + 2], false, lmp);
    const double sigma = utils::numeric(FLERR, arg[i + 3], false, lmp);
    if (!(epsilon >= 0))
      error->all(FLERR, "fix wall/lj115: epsilon {} of {}: must not be negative", arg[i + 2], arg[i]);
    if (!(sigma > 0))
      error->all(FLERR, "fix wall/lj115: sigma {} of {}: must be positive", arg[i + 3], arg[i]);
    walls_.push_back({face / 2, face % 2 == 1, epsilon, sigma});
  }
  if (walls_.empty()) error->all(FLERR, "fix wall/lj115: no face given");
  sums_.resize(1 + walls_.size());
  scalar_flag = vector_flag = 1;
  size_vector = static_cast<int>(walls_.size());
  global_freq = 1;
  extscalar = extvector = 1;
  energy_global_flag = 1;
  dynamic_group_allow = 1;
}

int FixWallLJ115::setmask()
{
  return POST_FORCE;
}

void FixWallLJ115::setup(int vflag)
{
  post_force(vflag);
}

// U(y) = (3 pi epsilon / 2) [21/32 u^11 - u^5 + 6/11 (160/231)^(5/6)], u = sigma / y, below its
// minimum, zero beyond (tabatabaei-2009, 3.35 and 3.36 corrected).
void FixWallLJ115::post_force(int)
{
  static const double shift = 6.0 / 11 * std::pow(160.0 / 231, 5.0 / 6);
  static const double minimum = std::pow(231.0 / 160, 1.0 / 6);

  std::fill(sums_.begin(), sums_.end(), 0.0);
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    const auto &wall = walls_[w];
    const double face = wall.upper ? domain->boxhi[wall.axis] : domain->boxlo[wall.axis];
    for (int i = 0; i < atom->nlocal; ++i) {
      if (!(atom->mask[i] & groupbit)) continue;
      const double x = atom->x[i][wall.axis];
      const double y = wall.upper ? face - x : x - face;
      if (!(y > 0))
        error->one(FLERR,
                   "fix wall/lj115: step {}: atom {} is at {} = {}, through the wall at {}: the "
                   "time step is too long, or the wall too weak",
                   update->ntimestep, atom->tag[i], "xyz"[wall.axis], x, face);
      if (y >= wall.sigma * minimum) continue;
      const double u = wall.sigma / y;
      const double u2 = u * u;
      const double u5 = u2 * u2 * u;
      const double u11 = u5 * u5 * u;
      const double force = 7.5 * M_PI * wall.epsilon * (231.0 / 160 * u11 - u5) / y;
      atom->f[i][wall.axis] += wall.upper ? -force : force;
      sums_[0] += 1.5 * M_PI * wall.epsilon * (21.0 / 32 * u11 - u5 + shift);
      sums_[1 + w] += wall.upper ? force : -force;
    }
  }
}

double FixWallLJ115::sum(int index)
{
  double total;
  MPI_Allreduce(&sums_[index], &total, 1, MPI_DOUBLE, MPI_SUM, world);
  return total;
}

double FixWallLJ115::compute_scalar()
{
  return sum(0);
}

double FixWallLJ115::compute_vector(int index)
{
  return sum(1 + index);
}

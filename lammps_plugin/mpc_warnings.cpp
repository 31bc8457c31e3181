#include "mpc_warnings.h"

#include "mpi_processes.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "lammps.h"
#include "modify.h"

#include <cmath>
#include <string>

using namespace LAMMPS_NS;

namespace {

constexpr double DENSITY_TOLERANCE = 0.05;    // of the density given

// What Modify keeps of a restart for fixes to come, which it does not show.
struct Kept : Modify {
  static constexpr auto ids = &Kept::id_restart_global;
  static constexpr auto styles = &Kept::style_restart_global;
};

}    // namespace

void LAMMPS_NS::warn_of_unread_fluid(LAMMPS *lmp, const char *id)
{
  const auto *modify = lmp->modify;
  std::string other;
  for (int i = 0; i < modify->nfix_restart_global; ++i) {
    if (std::string((modify->*Kept::styles)[i]) != "mpc") continue;
    other = (modify->*Kept::ids)[i];
    if (other == id) return;
  }
  if (!other.empty() && lmp->comm->me == 0)
    lmp->error->warning(FLERR,
                        "fix mpc: ID {}: the restart file holds the fluid of ID {}, which is not "
                        "read; give this fix that ID to go on with it",
                        id, other);
}

void LAMMPS_NS::expect_no_atoms(LAMMPS *lmp, double edge)
{
  if (lmp->atom->natoms > 0) return;
  lmp->atom->sortfreq = 0;
  if (lmp->comm->cutghostuser == 0) lmp->comm->cutghostuser = edge;
}

template <int D>
void LAMMPS_NS::warn_of_density(LAMMPS *lmp, double given, double particles, double edge,
                                const std::vector<mpc::Colloid<D>> &colloids,
                                const mpc::Coupling<D> *coupling)
{
  double cells = 1;
  for (int a = 0; a < D; ++a) cells *= lmp->domain->prd[a] / edge;
  for (const auto &colloid : colloids) {
    const double room = coupling->room(colloid.type) / edge;
    cells -= D == 2 ? M_PI * room * room : 4 * M_PI / 3 * room * room * room;
  }
  const double found = particles / cells;
  if (given > 0 && std::abs(found - given) > DENSITY_TOLERANCE * given && lmp->comm->me == 0)
    lmp->error->warning(FLERR,
                        "fix mpc: density {:g}: the fluid has {:.4g} particles in a cell; walls "
                        "slip, or drag too much, unless the two agree",
                        given, found);
}

template <int D>
void LAMMPS_NS::warn_of_unfelt(LAMMPS *lmp, int group_bit, const mpc::Coupling<D> *coupling,
                               MpiProcesses &processes)
{
  const auto *atom = lmp->atom;
  for (int type = 1; type <= atom->ntypes; ++type) {
    if (coupling && coupling->feels(type)) continue;
    bool there = false;
    for (int i = 0; i < atom->nlocal; ++i)
      there |= (atom->mask[i] & group_bit) && atom->type[i] == type;
    if (processes.any(there) && lmp->comm->me == 0)
      lmp->error->warning(FLERR,
                          "fix mpc: groupbig: the fluid does not feel atoms of type {}: they have "
                          "no force, reflect or collide",
                          type);
  }
}

namespace LAMMPS_NS {
template void warn_of_density<2>(LAMMPS *, double, double, double,
                                 const std::vector<mpc::Colloid<2>> &, const mpc::Coupling<2> *);
template void warn_of_density<3>(LAMMPS *, double, double, double,
                                 const std::vector<mpc::Colloid<3>> &, const mpc::Coupling<3> *);
template void warn_of_unfelt<2>(LAMMPS *, int, const mpc::Coupling<2> *, MpiProcesses &);
template void warn_of_unfelt<3>(LAMMPS *, int, const mpc::Coupling<3> *, MpiProcesses &);
}    // namespace LAMMPS_NS

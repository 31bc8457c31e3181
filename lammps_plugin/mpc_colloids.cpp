#include "mpc_colloids.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "force.h"
#include "neighbor.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using mpc::Colloid;
using mpc::Vector;

namespace {

constexpr double SPEED_MARGIN = 3;    // thermal speeds a colloid may gain between two collisions

}    // namespace

template <int D>
MpcColloids<D>::MpcColloids(LAMMPS *lmp, const MpcArguments<D> &given, MpiProcesses &processes) :
    Pointers(lmp), given_(given), processes_(processes)
{
}

template <int D> bool MpcColloids<D>::is_colloid(int i) const
{
  return (atom->mask[i] & given_.colloid_bit) && given_.interactions.count(atom->type[i]);
}

template <int D> Colloid<D> MpcColloids<D>::colloid(int i) const
{
  const auto &interaction = given_.interactions.at(atom->type[i]);
  const double mass = atom->rmass ? atom->rmass[i] : atom->mass[atom->type[i]];
  const auto id = static_cast<double>(atom->tag[i]);
  Colloid<D> colloid{id, {}, {}, mass, interaction.epsilon, interaction.sigma};
  for (int a = 0; a < D; ++a) {
    colloid.x[a] = atom->x[i][a] - domain->boxlo[a];
    colloid.v[a] = atom->v[i][a];
  }
  return colloid;
}

template <int D> std::vector<Colloid<D>> MpcColloids<D>::all() const
{
  std::vector<Colloid<D>> mine;
  for (int i = 0; i < atom->nlocal; ++i) {
    if (!is_colloid(i)) continue;
    mine.push_back(colloid(i));
  }
  return processes_.everyones(mine);
}

template <int D> void MpcColloids<D>::see(const mpc::Coupling<D> &coupling, double interval)
{
  seen_.clear();
  atoms_.clear();
  double bounds[2] = {0, 0};    // speed squared, and inverse mass
  double sigma = 0;
  for (int i = 0; i < atom->nlocal + atom->nghost; ++i) {
    if (!is_colloid(i)) continue;
    const auto &seen = seen_.emplace_back(colloid(i));
    atoms_.push_back(i);
    sigma = std::max(sigma, seen.sigma);
    if (i >= atom->nlocal) continue;
    bounds[0] = std::max(bounds[0], mpc::square<D>(seen.v));
    bounds[1] = std::max(bounds[1], 1 / seen.mass);
  }
  forces_.resize(seen_.size());
  if (comm->nprocs > 1) MPI_Allreduce(MPI_IN_PLACE, bounds, 2, MPI_DOUBLE, MPI_MAX, world);
  speed_ = std::sqrt(bounds[0]) + SPEED_MARGIN * std::sqrt(given_.temperature * bounds[1]);

  // cells reach beyond the sub-domain by the shift and half a cell, and colloids move
  if (seen_.empty()) return;
  const double needed = 1.5 * given_.edge + coupling.reach(sigma) + 3 * interval * speed_;
  for (int a = 0; a < D; ++a)
    if (comm->cutghost[a] < needed && domain->periodicity[a])
      error->one(FLERR, "fix mpc: the ghost cutoff {:.4g} is too short for the fluid to see all "
                 "colloids: use comm_modify cutoff {:.4g} or more", comm->cutghost[a], needed);

  // LAMMPS does not look whether anybody has crossed the skin with `check no`
  const int steps = std::max(neighbor->every, neighbor->delay) - 1;
  const double skin = 2 * steps * update->dt * speed_;
  if (force->pair && !neighbor->dist_check && neighbor->skin < skin)
    error->one(FLERR, "fix mpc: neigh_modify check no: the skin {:.4g} is too short for lists that "
               "are built every {} steps: use neighbor {:.4g} or more", neighbor->skin, steps + 1,
               skin);
}

// An image that is no longer among the ghosts is out of reach: it stays where it was seen last.
template <int D> void MpcColloids<D>::read()
{
  for (std::size_t s = 0; s < seen_.size(); ++s)
    if (atoms_[s] >= 0)
      for (int a = 0; a < D; ++a) {
        seen_[s].x[a] = atom->x[atoms_[s]][a] - domain->boxlo[a];
        seen_[s].v[a] = atom->v[atoms_[s]][a];
      }
}

template <int D> void MpcColloids<D>::follow()
{
  if (neighbor->ago == 0)    // atoms were exchanged; a colloid moves much less than its images
    for (std::size_t s = 0; s < seen_.size(); ++s)
      atoms_[s] = atom_at(seen_[s].id, seen_[s].x, given_.edge);
  read();
}

// The local or ghost atom of a colloid nearest to a place, within a distance; -1 if there is none.
template <int D>
int MpcColloids<D>::atom_at(double id, const Vector<D> &x, double distance) const
{
  int nearest = -1;
  double least = distance * distance;
  for (int i = 0; i < atom->nlocal + atom->nghost; ++i) {
    if (static_cast<double>(atom->tag[i]) != id) continue;
    double square = 0;
    for (int a = 0; a < D; ++a) {
      const double separation = atom->x[i][a] - domain->boxlo[a] - x[a];
      square += separation * separation;
    }
    if (square <= least) {
      least = square;
      nearest = i;
    }
  }
  return nearest;
}

template <int D> void MpcColloids<D>::apply_forces() const
{
  for (std::size_t s = 0; s < seen_.size(); ++s)
    if (atoms_[s] >= 0)
      for (int a = 0; a < D; ++a) atom->f[atoms_[s]][a] += forces_[s][a];
}

template <int D> void MpcColloids<D>::remember_pulls()
{
  pulls.clear();
  for (std::size_t s = 0; s < seen_.size(); ++s)
    if (mpc::square<D>(forces_[s]) > 0)
      pulls.push_back({static_cast<double>(comm->me), seen_[s].id, seen_[s].x, forces_[s]});
}

template <int D> bool MpcColloids<D>::repeat_pulls() const
{
  std::vector<int> atoms;
  for (const auto &pull : pulls) atoms.push_back(atom_at(pull.id, pull.x, 1e-9 * given_.edge));
  const bool moved = std::count(atoms.begin(), atoms.end(), -1) > 0;
  double known = static_cast<double>(pulls.size());
  processes_.sum(&known, 1);
  if (processes_.any(moved) || known == 0) return false;
  for (std::size_t k = 0; k < atoms.size(); ++k)
    for (int a = 0; a < D; ++a) atom->f[atoms[k]][a] += pulls[k].force[a];
  return true;
}

template class LAMMPS_NS::MpcColloids<2>;
template class LAMMPS_NS::MpcColloids<3>;

#include "mpc_colloids.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "force.h"
#include "neighbor.h"
#include "update.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

using namespace LAMMPS_NS;
using mpc::Colloid;
using mpc::Vector;

namespace {

constexpr double SPEED_MARGIN = 3;    // thermal speeds a colloid may gain between two collisions
constexpr double SPHERE = 0.4;        // moment of inertia over mass and square of the radius

}    // namespace

template <int D>
MpcColloids<D>::MpcColloids(LAMMPS *lmp, Fix *fix, int group_bit, double temperature, double edge,
                            MpiProcesses &processes) :
    Pointers(lmp), fix_(fix), group_bit_(group_bit), temperature_(temperature), edge_(edge),
    processes_(processes)
{
  processes_.images = [this](std::vector<double> &values, int width) { sum_images(values, width); };
}

template <int D> bool MpcColloids<D>::is_colloid(int i) const
{
  return coupling_ && (atom->mask[i] & group_bit_) && coupling_->feels(atom->type[i]);
}

template <int D> double MpcColloids<D>::mass_of(int i) const
{
  return atom->rmass ? atom->rmass[i] : atom->mass[atom->type[i]];
}

template <int D> Colloid<D> MpcColloids<D>::colloid(int i) const
{
  Colloid<D> colloid{static_cast<double>(atom->tag[i]), atom->type[i], {}, {}, {}, mass_of(i), 0};
  for (int a = 0; a < D; ++a) {
    colloid.x[a] = atom->x[i][a] - domain->boxlo[a];
    colloid.v[a] = atom->v[i][a];
  }
  if (atom->omega_flag) {
    colloid.inertia = SPHERE * colloid.mass * atom->radius[i] * atom->radius[i];
    for (std::size_t s = 0; s < colloid.spin.size(); ++s)
      colloid.spin[s] = atom->omega[i][D == 2 ? 2 : s];
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

// Summed by number, for the same bits on any number of processes.
template <int D> double MpcColloids<D>::mass() const
{
  std::vector<std::array<double, 2>> mine;
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & group_bit_) mine.push_back({static_cast<double>(atom->tag[i]), mass_of(i)});
  auto masses = processes_.everyones(mine);
  std::sort(masses.begin(), masses.end());
  double sum = 0;
  for (const auto &[id, mass] : masses) sum += mass;
  return sum;
}

template <int D> void MpcColloids<D>::see(double interval)
{
  seen_.clear();
  atoms_.clear();
  const int atoms = atom->nlocal + (coupling_->sees_images() ? atom->nghost : 0);
  double bounds[2] = {0, 0};    // speed squared, and inverse mass
  for (int i = 0; i < atoms; ++i) {
    if (!is_colloid(i)) continue;
    const auto &seen = seen_.emplace_back(colloid(i));
    atoms_.push_back(i);
    if (i >= atom->nlocal) continue;
    bounds[0] = std::max(bounds[0], mpc::square<D>(seen.v));
    bounds[1] = std::max(bounds[1], 1 / seen.mass);
  }
  forces_.assign(seen_.size(), {});
  if (coupling_->after_flight()) remember_places();
  if (comm->nprocs > 1) MPI_Allreduce(MPI_IN_PLACE, bounds, 2, MPI_DOUBLE, MPI_MAX, world);
  speed_ = std::sqrt(bounds[0]) + SPEED_MARGIN * std::sqrt(temperature_ * bounds[1]);

  // LAMMPS does not look whether anybody has crossed the skin with `check no`
  const int steps = std::max(neighbor->every, neighbor->delay) - 1;
  const double skin = 2 * steps * update->dt * speed_;
  if (force->pair && !neighbor->dist_check && neighbor->skin < skin)
    error->one(FLERR, "fix mpc: neigh_modify check no: the skin {:.4g} is too short for lists that "
               "are built every {} steps: use neighbor {:.4g} or more", neighbor->skin, steps + 1,
               skin);

  // cells reach beyond the sub-domain by the shift and half a cell, and colloids move
  if (seen_.empty() || !coupling_->sees_images()) return;
  const double needed = 1.5 * edge_ + coupling_->reach() + 3 * interval * speed_;
  for (int a = 0; a < D; ++a)
    if (comm->cutghost[a] < needed && domain->periodicity[a])
      error->one(FLERR, "fix mpc: the ghost cutoff {:.4g} is too short for the fluid to see all "
                 "colloids: use comm_modify cutoff {:.4g} or more", comm->cutghost[a], needed);
}

template <int D> void MpcColloids<D>::remember_places()
{
  struct Place {
    double id;
    Vector<D> x;
  };
  std::vector<Place> mine;
  for (std::size_t s = 0; s < seen_.size(); ++s)
    if (atoms_[s] < atom->nlocal) mine.push_back({seen_[s].id, seen_[s].x});
  began_.clear();
  for (const auto &place : processes_.everyones(mine)) began_[place.id] = place.x;
}

template <int D>
Vector<D> MpcColloids<D>::mean_velocity(const Colloid<D> &colloid, double interval) const
{
  const auto &began = began_.at(colloid.id);
  Vector<D> mean;
  for (int a = 0; a < D; ++a) {
    double way = colloid.x[a] - began[a];
    if (domain->periodicity[a]) way -= domain->prd[a] * std::rint(way / domain->prd[a]);
    mean[a] = way / interval;
  }
  return mean;
}

template <int D> void MpcColloids<D>::see_velocities(double interval)
{
  seen_.clear();
  atoms_.clear();
  for (int i = 0; i < atom->nlocal; ++i) {
    if (!is_colloid(i)) continue;
    seen_.push_back(colloid(i));
    atoms_.push_back(i);
  }
  if (!coupling_->sees_images()) return;
  constexpr int spins = std::tuple_size<mpc::Spin<D>>::value;
  width_ = D + spins;
  carried_.assign(static_cast<std::size_t>(width_) * (atom->nlocal + atom->nghost), 0);
  for (std::size_t s = 0; s < seen_.size(); ++s) {
    double *values = &carried_[width_ * atoms_[s]];
    std::copy_n(seen_[s].v.begin(), D, values);
    std::copy_n(seen_[s].spin.begin(), spins, values + D);
  }
  comm->forward_comm(fix_, width_);
  for (int i = atom->nlocal; i < atom->nlocal + atom->nghost; ++i) {
    if (!is_colloid(i)) continue;
    auto &image = seen_.emplace_back(colloid(i));
    const double *values = &carried_[width_ * i];
    std::copy_n(values, D, image.v.begin());
    std::copy_n(values + D, spins, image.spin.begin());
    atoms_.push_back(i);
  }
  if (coupling_->after_flight())
    for (auto &colloid : seen_) colloid.mean = mean_velocity(colloid, interval);
}

template <int D> void MpcColloids<D>::sum_images(std::vector<double> &values, int width)
{
  width_ = width;
  carried_.assign(static_cast<std::size_t>(width) * (atom->nlocal + atom->nghost), 0);
  for (std::size_t s = 0; s < seen_.size(); ++s)
    std::copy_n(&values[width * s], width, &carried_[width * atoms_[s]]);
  comm->reverse_comm(fix_, width);
  comm->forward_comm(fix_, width);
  for (std::size_t s = 0; s < seen_.size(); ++s)
    std::copy_n(&carried_[width * atoms_[s]], width, &values[width * s]);
}

template <int D> int MpcColloids<D>::pack(int count, const int *atoms, double *buffer) const
{
  for (int k = 0; k < count; ++k)
    std::copy_n(&carried_[width_ * atoms[k]], width_, buffer + k * width_);
  return count * width_;
}

template <int D> int MpcColloids<D>::pack(int count, int first, double *buffer) const
{
  std::copy_n(carried_.data() + width_ * first, count * width_, buffer);
  return count * width_;
}

template <int D> void MpcColloids<D>::add(int count, const int *atoms, const double *buffer)
{
  for (int k = 0; k < count; ++k)
    for (int w = 0; w < width_; ++w) carried_[width_ * atoms[k] + w] += *buffer++;
}

template <int D> void MpcColloids<D>::set(int count, int first, const double *buffer)
{
  std::copy_n(buffer, count * width_, carried_.data() + width_ * first);
}

template <int D> void MpcColloids<D>::apply_impulses(const std::vector<mpc::Push<D>> &impulses)
{
  constexpr int spins = std::tuple_size<mpc::Spin<D>>::value, width = D + spins;
  std::vector<double> values;
  for (const auto &push : impulses) {
    values.insert(values.end(), push.linear.begin(), push.linear.end());
    values.insert(values.end(), push.angular.begin(), push.angular.end());
  }
  if (coupling_->sees_images()) sum_images(values, width);
  for (std::size_t s = 0; s < seen_.size(); ++s) {
    const int i = atoms_[s];
    if (i >= atom->nlocal) continue;
    const double *push = &values[width * s];
    for (int a = 0; a < D; ++a) atom->v[i][a] += push[a] / seen_[s].mass;
    if (seen_[s].inertia > 0)
      for (int k = 0; k < spins; ++k) atom->omega[i][D == 2 ? 2 : k] += push[D + k] / seen_[s].inertia;
  }
}

template <int D> mpc::Vector<D> MpcColloids<D>::momentum() const
{
  Vector<D> sum{};
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & group_bit_)
      for (int a = 0; a < D; ++a) sum[a] += mass_of(i) * atom->v[i][a];
  return sum;
}

template <int D> void MpcColloids<D>::add_velocity(const Vector<D> &velocity)
{
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & group_bit_)
      for (int a = 0; a < D; ++a) atom->v[i][a] += velocity[a];
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
      atoms_[s] = atom_at(seen_[s].id, seen_[s].x, edge_);
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
      for (int a = 0; a < D; ++a) atom->f[atoms_[s]][a] += forces_[s].linear[a];
}

template <int D> void MpcColloids<D>::remember_pulls()
{
  pulls.clear();
  for (std::size_t s = 0; s < seen_.size(); ++s)
    if (mpc::square<D>(forces_[s].linear) > 0)
      pulls.push_back(
          {static_cast<double>(comm->me), seen_[s].id, seen_[s].x, forces_[s].linear});
}

template <int D> bool MpcColloids<D>::repeat_pulls() const
{
  std::vector<int> atoms;
  for (const auto &pull : pulls) atoms.push_back(atom_at(pull.id, pull.x, 1e-9 * edge_));
  const bool moved = std::count(atoms.begin(), atoms.end(), -1) > 0;
  double known = static_cast<double>(pulls.size());
  processes_.sum(&known, 1);
  if (processes_.any(moved) || known == 0) return false;
  for (std::size_t k = 0; k < atoms.size(); ++k)
    for (int a = 0; a < D; ++a) atom->f[atoms[k]][a] += pulls[k].force[a];
  return true;
}

// Two for each colloid: force, then torque.
template <int D> void MpcColloids<D>::remember_forces()
{
  pulls.clear();
  for (int i = 0; i < atom->nlocal; ++i) {
    if (!is_colloid(i)) continue;
    Pull<D> pull{static_cast<double>(comm->me), static_cast<double>(atom->tag[i]), {}, {}};
    for (int a = 0; a < D; ++a) pull.force[a] = atom->f[i][a];
    pulls.push_back(pull);
    pull.force = {};
    if (atom->torque_flag)
      for (int a = 0; a < (D == 2 ? 1 : D); ++a) pull.force[a] = atom->torque[i][D == 2 ? 2 : a];
    pulls.push_back(pull);
  }
}

template <int D> void MpcColloids<D>::repeat_forces() const
{
  std::map<double, std::size_t> known;    // where the force of each is
  for (std::size_t k = 0; k + 1 < pulls.size(); k += 2) known[pulls[k].id] = k;
  for (int i = 0; i < atom->nlocal; ++i) {
    const auto found = known.find(static_cast<double>(atom->tag[i]));
    if (!is_colloid(i) || found == known.end()) continue;
    const auto &force = pulls[found->second].force, &torque = pulls[found->second + 1].force;
    for (int a = 0; a < D; ++a) atom->f[i][a] = force[a];
    if (atom->torque_flag)
      for (int a = 0; a < (D == 2 ? 1 : D); ++a) atom->torque[i][D == 2 ? 2 : a] = torque[a];
  }
}

template class LAMMPS_NS::MpcColloids<2>;
template class LAMMPS_NS::MpcColloids<3>;

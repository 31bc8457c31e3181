// The colloids of LAMMPS as the fluid sees them: local and ghost atoms, from one collision to the
// next, and the forces on them.

#pragma once

#include "core/coupling.h"
#include "mpi_processes.h"

#include "pointers.h"

#include <unordered_map>
#include <vector>

namespace LAMMPS_NS {

// What a process's fluid did to a colloid or image at the last collision step.
template <int D> struct Pull {
  double process, id;
  mpc::Vector<D> x, force;
};

template <int D> class MpcColloids : protected Pointers {
 public:
  MpcColloids(LAMMPS *, class Fix *, int group_bit, double temperature, double edge,
              MpiProcesses &);

  // Whom the fluid feels; nullptr: nobody.
  void set_coupling(const mpc::Coupling<D> *coupling) { coupling_ = coupling; }

  // Of all processes, each once: those that the fluid feels, and the mass of the group.
  std::vector<mpc::Colloid<D>> all() const;
  double mass() const;

  // Those that this process sees, as they stand after a collision; an error if the ghosts do not
  // reach as far as the coupling needs in an interval.
  void see(double interval);
  const std::vector<mpc::Colloid<D>> &seen() const { return seen_; }

  // The same at the end of the interval, with the velocities of ghosts, which LAMMPS does not keep,
  // and means over the interval.
  void see_velocities(double interval);

  // None becomes faster before the next collision.
  double speed() const { return speed_; }

  // Bring what was seen to where it is now.
  void follow();

  // Forces on what was seen, and their way to LAMMPS.
  std::vector<mpc::Push<D>> &forces() { return forces_; }
  void apply_forces() const;

  // Change the velocities and spins of those seen by what a collision gave to all their images.
  void apply_impulses(const std::vector<mpc::Push<D>> &);

  // Take so much from the velocity of the whole group; its momentum, of this process.
  void add_velocity(const mpc::Vector<D> &);
  mpc::Vector<D> momentum() const;

  // Sums over the images of each colloid seen, and the parts of it that LAMMPS carries.
  void sum_images(std::vector<double> &values, int width);
  int pack(int count, const int *atoms, double *buffer) const;
  int pack(int count, int first, double *buffer) const;
  void add(int count, const int *atoms, const double *buffer);
  void set(int count, int first, const double *buffer);
  static constexpr int MOST_CARRIED = 16;    // values for each

  // Forces decide the last bits, so a continued run takes over those of the run before.
  void remember_pulls();
  bool repeat_pulls() const;    // if all colloids are where they were

  // So do all forces and torques on colloids that the fluid meets at collisions only: friction
  // between them needs velocities of the half step, which a continued run does not know.
  void remember_forces();
  void repeat_forces() const;
  std::vector<Pull<D>> pulls;

 private:
  bool is_colloid(int atom) const;
  double mass_of(int atom) const;
  mpc::Colloid<D> colloid(int atom) const;    // the velocity of a ghost only with comm_modify vel yes
  void read();
  void remember_places();
  mpc::Vector<D> mean_velocity(const mpc::Colloid<D> &, double interval) const;
  int atom_at(double id, const mpc::Vector<D> &, double distance) const;

  class Fix *fix_;
  int group_bit_;
  double temperature_, edge_;
  MpiProcesses &processes_;
  const mpc::Coupling<D> *coupling_ = nullptr;
  std::vector<mpc::Colloid<D>> seen_;    // colloids and images, in the order of the last collision
  std::vector<int> atoms_;               // index of the atom of each; -1 when it left the ghosts
  std::vector<mpc::Push<D>> forces_;
  std::unordered_map<double, mpc::Vector<D>> began_;    // where all were after the last collision
  double speed_ = 0;
  std::vector<double> carried_;    // of each atom
  int width_ = 0;
};

}    // namespace LAMMPS_NS

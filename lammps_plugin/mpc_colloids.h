// The colloids of LAMMPS as the fluid sees them: local and ghost atoms, from one collision to the
// next, and the forces on them.

#pragma once

#include "core/coupling.h"
#include "mpc_arguments.h"
#include "mpi_processes.h"

#include "pointers.h"

#include <vector>

namespace LAMMPS_NS {

// What a process's fluid did to a colloid or image at the last collision step.
template <int D> struct Pull {
  double process, id;
  mpc::Vector<D> x, force;
};

template <int D> class MpcColloids : protected Pointers {
 public:
  MpcColloids(LAMMPS *, const MpcArguments<D> &, MpiProcesses &);

  // Of all processes, each once.
  std::vector<mpc::Colloid<D>> all() const;

  // Those that this process sees, as they stand after a collision; an error if the ghosts do not
  // reach as far as the coupling needs in an interval.
  void see(const mpc::Coupling<D> &, double interval);
  const std::vector<mpc::Colloid<D>> &seen() const { return seen_; }

  // None becomes faster before the next collision.
  double speed() const { return speed_; }

  // Bring what was seen to where it is now.
  void follow();

  // Forces on what was seen, and their way to LAMMPS.
  std::vector<mpc::Vector<D>> &forces() { return forces_; }
  void apply_forces() const;

  // Forces decide the last bits, so a continued run takes over those of the run before.
  void remember_pulls();
  bool repeat_pulls() const;    // if all colloids are where they were
  std::vector<Pull<D>> pulls;

 private:
  bool is_colloid(int atom) const;
  mpc::Colloid<D> colloid(int atom) const;    // the velocity of a ghost only with comm_modify vel yes
  void read();
  int atom_at(double id, const mpc::Vector<D> &, double distance) const;

  const MpcArguments<D> &given_;
  MpiProcesses &processes_;
  std::vector<mpc::Colloid<D>> seen_;    // colloids and images, in the order of the last collision
  std::vector<int> atoms_;               // index of the atom of each; -1 when it left the ghosts
  std::vector<mpc::Vector<D>> forces_;
  double speed_ = 0;
};

}    // namespace LAMMPS_NS

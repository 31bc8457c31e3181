// The fluid of this process: which cells it has, the particles that it makes around the colloids, and
// how particles come to the process that has their cells (docs/fix_mpc.md).

#pragma once

#include "core/colloid_cells.h"
#include "core/solver.h"
#include "mpc_arguments.h"
#include "mpi_processes.h"

#include "pointers.h"

#include <functional>
#include <vector>

namespace LAMMPS_NS {

template <int D> class MpcState : protected Pointers {
 public:
  static constexpr int CHUNK = 1 << 16;    // particles made, read or written at a time

  MpcState(LAMMPS *, const MpcArguments<D> &, mpc::AnySolver<D> &, MpiProcesses &);

  // The cells of this process's sub-domain: lower <= cell < upper.
  std::array<int, D> lower() const;
  std::array<int, D> upper() const;

  void create(const std::vector<mpc::Colloid<D>> &, const mpc::Coupling<D> *);

  // The first of so many particles that a process makes or reads.
  std::int64_t share(std::int64_t particles, int process) const;

  // Each process makes or reads its share, from a place on, and hands it to those that have the
  // cells: whatever the number of processes, each has its own in the order of all.
  using Fill = std::function<void(std::int64_t place, std::vector<mpc::Particle<D>> &)>;
  void distribute(std::int64_t particles, const Fill &);

 private:
  std::array<int, D> bound(const double *corner) const;
  mpc::ColloidCells<D> rooms(const std::vector<mpc::Colloid<D>> &,
                             const mpc::Coupling<D> *) const;

  const MpcArguments<D> &given_;
  mpc::AnySolver<D> &solver_;
  MpiProcesses &processes_;
};

}    // namespace LAMMPS_NS

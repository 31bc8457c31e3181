// Where the fluid comes from and where it rests: created around the colloids, in files of its own,
// and in the restart files of LAMMPS (docs/fix_mpc.md).

#pragma once

#include "core/colloid_cells.h"
#include "core/fluid_file.h"
#include "core/solver.h"
#include "mpc_arguments.h"
#include "mpc_colloids.h"
#include "mpi_processes.h"

#include "pointers.h"

#include <cstdio>
#include <string>
#include <vector>

namespace LAMMPS_NS {

template <int D> class MpcState : protected Pointers {
 public:
  MpcState(LAMMPS *, const MpcArguments<D> &, mpc::AnySolver<D> &, MpiProcesses &);

  // The cells of this process's sub-domain: lower <= cell < upper.
  std::array<int, D> lower() const;
  std::array<int, D> upper() const;

  // How many particles a file has.
  static double particles_in(LAMMPS *, const std::string &file);

  void create(const std::vector<mpc::Colloid<D>> &, const mpc::Coupling<D> *);
  void load(const std::string &file);
  void save(const std::string &file);

  // Beside the fluid: the last pulls on colloids, and an average under way. A fluid of more than a
  // few particles is in a file of its own.
  void write_restart(FILE *, const std::vector<Pull<D>> &of_all,
                     const std::vector<double> &average);
  struct Restored {
    std::vector<Pull<D>> pulls;    // of all, if they were as many processes
    std::vector<double> average;
  };
  Restored restart(const char *);

 private:
  std::array<int, D> bound(const double *corner) const;
  mpc::FluidHeader fluid_header(const char (&magic)[8]) const;
  void check(const mpc::Particle<D> &, std::int64_t particles, const std::string &file) const;
  void check_each_once(std::vector<double> numbers, std::int64_t particles,
                       const std::string &file);
  mpc::ColloidCells<D> rooms(const std::vector<mpc::Colloid<D>> &,
                             const mpc::Coupling<D> *) const;
  std::int64_t share(std::int64_t particles, int process) const;
  template <class Fill> void distribute(std::int64_t particles, const Fill &);
  std::uint64_t write(const std::string &file, const char *why, const char (&magic)[8],
                      const double *origin);
  template <class Visit> void gather(const Visit &);
  void name_beside(FILE *restart, char (&name)[sizeof mpc::Apart::file]) const;
  void read_apart(const mpc::FluidHeader &, const mpc::Apart &);

  const MpcArguments<D> &given_;
  mpc::AnySolver<D> &solver_;
  MpiProcesses &processes_;
};

}    // namespace LAMMPS_NS

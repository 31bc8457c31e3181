// Where the fluid comes from and where it rests: created around the colloids, in files of its own,
// and in the restart files of LAMMPS (docs/fix_mpc.md).

#pragma once

#include "core/solver.h"
#include "mpc_arguments.h"
#include "mpc_colloids.h"

#include "pointers.h"

#include <cstdio>
#include <string>
#include <vector>

namespace LAMMPS_NS {

template <int D> class MpcState : protected Pointers {
 public:
  MpcState(LAMMPS *, const MpcArguments<D> &, mpc::AnySolver<D> &);

  // The cells of this process's sub-domain: lower <= cell < upper.
  std::array<int, D> lower() const;
  std::array<int, D> upper() const;

  // How many particles a file has.
  static double particles_in(class Error &, const std::string &file);

  void create(const std::vector<mpc::Colloid<D>> &, const mpc::Coupling<D> *);
  void load(const std::string &file);
  void save(const std::string &file);

  // Beside the fluid: the last pulls on colloids, and an average under way.
  void write_restart(FILE *, const std::vector<Pull<D>> &of_all,
                     const std::vector<double> &average);
  struct Restored {
    std::vector<Pull<D>> pulls;    // of all, if they were as many processes
    std::vector<double> average;
  };
  Restored restart(const char *);

 private:
  std::array<int, D> bound(const double *corner) const;
  mpc::FluidHeader fluid_header() const;
  void check(const mpc::Particle<D> &, std::vector<bool> &known, const std::string &file) const;
  template <class Visit> void gather(const Visit &);

  const MpcArguments<D> &given_;
  mpc::AnySolver<D> &solver_;
};

}    // namespace LAMMPS_NS

// The fluid in the restart files of LAMMPS (docs/fix_mpc.md).

#pragma once

#include "mpc_arguments.h"
#include "mpc_colloids.h"
#include "mpc_fluid_file.h"

#include <cstdio>
#include <vector>

namespace LAMMPS_NS {

template <int D> class MpcRestart : protected Pointers {
 public:
  MpcRestart(LAMMPS *, const MpcArguments<D> &, mpc::AnySolver<D> &, MpcState<D> &,
             MpiProcesses &);

  // Beside the fluid: the last pulls on colloids, and an average under way. A fluid of more than a
  // few particles is in a file of its own.
  void write(FILE *, const std::vector<Pull<D>> &of_all, const std::vector<double> &average);
  struct Restored {
    std::vector<Pull<D>> pulls;    // of all, if they were as many processes
    std::vector<double> average;
  };
  Restored read(const char *);

 private:
  template <class Visit> void gather(const Visit &);
  void name_beside(FILE *restart, char (&name)[sizeof mpc::Apart::file]) const;
  void read_apart(const mpc::FluidHeader &, const mpc::Apart &);

  const MpcArguments<D> &given_;
  mpc::AnySolver<D> &solver_;
  MpcState<D> &state_;
  MpiProcesses &processes_;
  MpcFluidFile<D> files_;
};

}    // namespace LAMMPS_NS

// Some of the fluid's particles as frames of a LAMMPS dump file, for OVITO and MDAnalysis.

#pragma once

#include "core/solver.h"

#include "pointers.h"

#include <cstdio>
#include <string>
#include <vector>

namespace LAMMPS_NS {

struct DumpArguments {
  int every = 0;         // steps; 0: no dump is wanted
  bigint one_in = 1;     // particles whose number is a multiple of it
  bool append = false;
  std::string file;
};

template <int D> class MpcDump : protected Pointers {
 public:
  // Opens the file on the first process.
  MpcDump(LAMMPS *, const DumpArguments &);
  ~MpcDump() override;

  // A frame of the fluid as it is now, in the order of the particles' numbers.
  void write(const mpc::AnySolver<D> &);

 private:
  std::vector<mpc::Particle<D>> chosen(const mpc::AnySolver<D> &) const;

  const DumpArguments &given_;
  FILE *file_ = nullptr;
};

}    // namespace LAMMPS_NS

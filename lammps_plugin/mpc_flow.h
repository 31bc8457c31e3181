// The flow of the fluid on a grid, as a file of fix ave/chunk with chunks of bin/2d or bin/3d.

#pragma once

#include "core/solver.h"

#include "pointers.h"

#include <cstdio>
#include <string>
#include <vector>

namespace LAMMPS_NS {

template <int D> struct FlowArguments {
  int every = 0, frequency = 0;    // steps; 0: no flow is wanted
  std::array<int, D> bins{};
  tagint around = 0;    // an atom, or 0: the laboratory
  bool append = false;
  std::string file;
};

template <int D> class MpcFlow : protected Pointers {
 public:
  // Opens the file on the first process.
  MpcFlow(LAMMPS *, const FlowArguments<D> &, mpc::Processes &, const char *fix);
  ~MpcFlow() override;

  // Add the fluid as it is now.
  void look(mpc::AnySolver<D> &);

  // The mean of the looks since the last time, all particles counted.
  void write(double particles);

  // An average under way, as a restart keeps it; of the first process.
  std::vector<double> state();
  bool restore(const std::vector<double> &);

 private:
  mpc::Vector<D> origin(const mpc::Grid<D> &) const;

  const FlowArguments<D> &given_;
  mpc::Processes &processes_;
  mpc::FlowSums<D> sums_;
  FILE *file_ = nullptr;
};

}    // namespace LAMMPS_NS

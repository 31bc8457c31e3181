// The arguments of fix mpc (docs/fix_mpc.md), checked: an error names the argument in one line.

#pragma once

#include "core/collision.h"

#include <cstdint>
#include <map>
#include <string>

namespace LAMMPS_NS {

template <int D> struct MpcArguments {
  MpcArguments(class LAMMPS *, int, char **);

  struct Interaction {
    double epsilon, sigma;
  };

  int every;
  int colloid_bit = 0;
  double temperature, edge;
  std::uint64_t seed;
  double particles = 0;      // to create, or
  std::string load_file;
  double density = 0;
  double angle = 90;
  mpc::Axes axes = mpc::Axes::Coordinate;
  bool shifted = true;
  std::string tstat = "none", hydro = "on";
  mpc::Vector<D> field{};
  std::map<int, Interaction> interactions;    // by atom type
  int bins = 0;
  int profile_every = 0, profile_frequency = 0;
  std::string profile_file;
  bool profile_append = false;
};

}    // namespace LAMMPS_NS

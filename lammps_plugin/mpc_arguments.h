// The arguments of fix mpc (docs/fix_mpc.md), checked: an error names the argument in one line.

#pragma once

#include "core/force_coupling.h"
#include "core/no_slip_walls.h"
#include "core/reflection_coupling.h"
#include "mpc_dump.h"
#include "mpc_flow.h"

#include <cstdint>
#include <string>

namespace LAMMPS_NS {

template <int D> struct MpcArguments {
  MpcArguments(class LAMMPS *, int, char **);

  bool walls = false;    // whether there are any
  int every;
  int colloid_bit = 0;
  double temperature, edge;
  std::uint64_t seed;
  bool single = false;       // precision of the fluid's state
  double particles = 0;      // to create, or
  std::string load_file;
  double density = 0;
  double angle = 90;
  mpc::Axes axes = mpc::Axes::Coordinate;
  bool shifted = true;
  std::string tstat = "none", hydro = "on";
  mpc::Vector<D> field{};
  mpc::FaceVectors<D> wall_velocities{};
  bool virtual_particles = true;

  // how the colloids are coupled, by atom type; one of three
  typename mpc::ForceCoupling<D>::Interactions interactions;
  typename mpc::ReflectionCoupling<D>::Radii radii;
  mpc::Placement placement = mpc::Placement::Entry;
  bool in_collision = false;

  mpc::Vector<D> compensated{};    // acceleration of the colloids that the fluid balances
  int momentum_every = 0;          // collisions between removals of the total momentum; 0: never
  int bins = 0;
  int profile_every = 0, profile_frequency = 0;
  std::string profile_file;
  bool profile_append = false;
  FlowArguments<D> flow;
  DumpArguments dump;
};

}    // namespace LAMMPS_NS

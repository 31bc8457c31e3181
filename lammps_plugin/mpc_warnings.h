// What a deck with fix mpc most likely does not mean: told in a line each, then done.

#pragma once

#include "core/coupling.h"

#include <vector>

namespace LAMMPS_NS {

// A restart that holds the fluid of a fix mpc, when the fix of this ID is made: under another ID it
// is left unread.
void warn_of_unread_fluid(class LAMMPS *, const char *id);

// Without atoms there are no ghosts and nothing to sort: no need to warn of it.
void expect_no_atoms(class LAMMPS *, double edge);

// Walls fill cells to the density given; here it is not that of the fluid.
template <int D>
void warn_of_density(class LAMMPS *, double given, double particles, double edge,
                     const std::vector<mpc::Colloid<D>> &, const mpc::Coupling<D> *);

// Atoms of the group that the fluid does not feel, by type.
template <int D>
void warn_of_unfelt(class LAMMPS *, int group_bit, const mpc::Coupling<D> *, class MpiProcesses &);

}    // namespace LAMMPS_NS

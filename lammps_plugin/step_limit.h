// Stops a run whose time step is too long, before its pairs are missed.

#pragma once

#include "atom.h"
#include "error.h"
#include "neighbor.h"
#include "update.h"

#include <cmath>

namespace LAMMPS_NS {

// Half the skin: further, and an atom meets others that its neighbour list does not hold.
inline double longest_move(const Neighbor &neighbor)
{
  return neighbor.skin > 0 ? neighbor.skin / 2 : HUGE_VAL;
}

[[noreturn]] inline void stop_at_move(Error &error, const char *style, const Update &update,
                                      tagint atom, double distance, double longest,
                                      const char *cause)
{
  error.one(FLERR,
            "fix {}: step {}: atom {} would move by {:.3g} in one step, more than half the neighbor "
            "skin, {:.3g}{}: the timestep {} is too long for this field, use a shorter one",
            style, update.ntimestep, atom, distance, longest, cause, update.dt);
}

}    // namespace LAMMPS_NS

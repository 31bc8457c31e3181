// The streaming velocity of a box that fix deform shears, u = rate (y - origin) along x.

#pragma once

#include "domain.h"
#include "error.h"

namespace LAMMPS_NS {

struct ShearFlow {
  double rate = 0, origin = 0;

  // Of the box as fix deform will change it; fix deform knows after its init().
  static ShearFlow of(const Domain &domain, Error &error, const char *style)
  {
    if (!domain.triclinic || !domain.deform_vremap)
      error.all(FLERR, "fix {}: needs a triclinic box and fix deform N xy erate RATE remap v", style);
    for (int a = 0; a < 5; ++a)
      if (domain.h_rate[a] != 0)
        error.all(FLERR, "fix {}: fix deform: may change xy only", style);
    return {domain.h_rate[5] / domain.yprd, domain.boxlo[1]};
  }
};

}    // namespace LAMMPS_NS

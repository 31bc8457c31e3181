// What a temperature of configurations needs beyond forces, collected in the pass that computes them.

#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace LAMMPS_NS {

using Triple = std::array<double, 3>;

// Atoms within their cutoff: their separation r, and their Hessian, slope 1 + bend r r.
struct Contact {
  int i, j;    // j may be a ghost
  Triple r;
  double slope, bend;
};

// Sums over the pairs of this process; arrays include ghosts, as forces do.
struct Curvature {
  double laplacian = 0;            // sum over atoms of the Laplacian of the potential energy
  std::vector<Triple> gradient;    // of that sum, by the positions
  std::vector<Contact> contacts;

  void clear(std::size_t atoms)
  {
    laplacian = 0;
    gradient.assign(atoms, Triple{});
    contacts.clear();
  }
};

}    // namespace LAMMPS_NS

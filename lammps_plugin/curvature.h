// What a temperature of configurations needs beyond forces, collected in the pass that computes them.

#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace LAMMPS_NS {

using Triple = std::array<double, 3>;

// Atoms i and j, which may be a ghost, within their cutoff, and the Hessian of the pair:
// slope 1 + bend r r, r from j to i.
struct Contact {
  int i, j;
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

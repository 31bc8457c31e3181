// Virtual wall particles: what fills the cells that a wall cuts (tabatabaei-2009, 3.2.5).

#pragma once

#include "collision.h"

namespace mpc {

// Whether a row of cells reaches beyond y = 0 or y = width.
template <int D> bool cut_by_wall(const Grid<D> &grid, int row)
{
  if (grid.periodic[1]) return false;
  const double start = row - grid.shift[1];
  return start < 0 || start + 1 > grid.box[1] / grid.edge;
}

// Mean velocity of a cut cell with n < density particles, filled up with density - n more at rest
// on average; the sum of their velocities has the variance (density - n) T (3.14).
template <int D>
Vector<D> mean_with_virtual_particles(const CellSum<D> &sum, double density, double temperature,
                                      const CounterRandom &random, std::uint64_t cell)
{
  const auto z = normals<D>(random.words(Stream::Wall, cell));
  const double width = std::sqrt((density - sum.count()) * temperature);
  Vector<D> mean;
  for (int a = 0; a < D; ++a) mean[a] = (sum.momentum[a] + width * z[a]) / density;
  return mean;
}

}    // namespace mpc

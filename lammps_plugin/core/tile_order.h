// The order of the particles in memory.

#pragma once

#include "fluid.h"

namespace mpc {

// Particles that share cells come to lie near each other, so that the cost of a collision does not
// depend on the size of the fluid; within a tile their order stays mixed, which keeps sums into one
// cell from waiting for each other.
template <int D, class Real = double> class TileOrder {
 public:
  void sort(Fluid<D, Real> &fluid, const Grid<D> &grid)
  {
    std::array<int, D> tiles;
    int count = 1;
    for (int a = 0; a < D; ++a) {
      tiles[a] = (grid.extent(a) + TILE - 1) / TILE;
      count *= tiles[a];
    }
    if (count == 1) return;
    const auto tile_of = [&](int cell) {
      int tile = 0;
      const auto rows = grid.rows(cell);
      for (int a = D - 1; a >= 0; --a)
        tile = tile * tiles[a] + (rows[a] - grid.lower[a]) / TILE;
      return tile;
    };
    std::vector<int> tile(grid.cells());
    for (int cell = 0; cell < grid.cells(); ++cell) tile[cell] = tile_of(cell);
    std::vector<int> next(count + 1);
    for (int cell : fluid.cell) ++next[tile[cell] + 1];
    for (int t = 0; t < count; ++t) next[t + 1] += next[t];
    order_.resize(fluid.size());
    for (int i = 0; i < fluid.size(); ++i) order_[i] = next[tile[fluid.cell[i]]]++;
    for (int a = 0; a < D; ++a) {
      reorder(fluid.x[a], sorted_);
      if constexpr (Fluid<D, Real>::single)
        reorder(fluid.v[a], sorted_single_);
      else
        reorder(fluid.v[a], sorted_);
    }
    Array<std::uint32_t> ids;
    reorder(fluid.id, ids);
    Array<std::uint16_t> high;
    if (!fluid.id_high.empty()) reorder(fluid.id_high, high);
    Array<std::int32_t> cells;
    reorder(fluid.cell, cells);
  }

  double bytes() const
  {
    return order_.capacity() * 1.0 * sizeof(int) +
        sorted_.capacity() * 1.0 * sizeof(Coordinate) +
        sorted_single_.capacity() * 1.0 * sizeof(float);
  }

 private:
  using Coordinate = typename Fluid<D, Real>::Coordinate;

  static constexpr int TILE = D == 2 ? 8 : 4;    // cells along each edge; they share a cache

  template <class T> void reorder(Array<T> &values, Array<T> &sorted)
  {
    sorted.resize(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) sorted[order_[i]] = values[i];
    std::swap(values, sorted);
  }

  std::vector<int> order_;
  Array<Coordinate> sorted_;
  Array<float> sorted_single_;
};

}    // namespace mpc

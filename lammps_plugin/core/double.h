// The passes over a fluid in double precision; single.h has those of single.

#pragma once

#include "collision.h"
#include "streaming.h"

namespace mpc {

constexpr int AHEAD = 32;    // particles

// Ask for what the particle a few further on needs of its cell: caches do not foresee it. Inlined
// always, as GCC drops calls that do nothing else.
template <class Value>
__attribute__((always_inline)) inline void prefetch(const Array<Value> &of_cells,
                                                    const Array<std::int32_t> &cell, int i)
{
  const int next = cell[std::min(i + AHEAD, static_cast<int>(cell.size()) - 1)];
  const auto *value = reinterpret_cast<const char *>(of_cells.data() + next);
  for (std::size_t line = 0; line < sizeof(Value); line += CACHE_LINE)
    __builtin_prefetch(value + line, 1);
}

// Velocities after the turns of their cells.
template <int D> void turn(Fluid<D> &fluid, const Array<Turn<D>> &of_cells, int begin, int end)
{
  const Turn<D> *turns = of_cells.data();
  const std::int32_t *cell = fluid.cell.data();
  double *__restrict vx = fluid.v[0].data();
  double *__restrict vy = fluid.v[1].data();
  if constexpr (D == 2) {
    for (int i = begin; i < end; ++i) {
      const auto v = turns[cell[i]].apply(vx[i], vy[i]);
      vx[i] = v[0];
      vy[i] = v[1];
    }
  } else {
    double *__restrict vz = fluid.v[2].data();
    for (int i = begin; i < end; ++i) {
      prefetch(of_cells, fluid.cell, i);
      const auto v = turns[cell[i]].apply(vx[i], vy[i], vz[i]);
      vx[i] = v[0];
      vy[i] = v[1];
      vz[i] = v[2];
    }
  }
}

// Move particles begin ... end - 1 to the end of the interval.
template <int D>
void fly(Fluid<D> &fluid, const Vector<D> &field, double time, const Walls<D> *walls, int begin,
         int end)
{
  std::array<double *, D> x, v;
  for (int a = 0; a < D; ++a) {
    x[a] = fluid.x[a].data();
    v[a] = fluid.v[a].data();
  }
  stream<D>(x, v, Field<D>{field}, time, walls, begin, end);
}

// Wrap and find the cells. Whoever is in none of this process's cells, has flown further than the
// box, or is nowhere, becomes a stray.
template <int D>
void find_cells(Fluid<D> &fluid, const Grid<D> &grid, int begin, int end, std::int32_t stray)
{
  std::int32_t *__restrict cell = fluid.cell.data();
  std::int32_t stride = 1;
  for (int a = 0; a < D; ++a) {
    double *__restrict x = fluid.x[a].data();
    const double size = grid.box[a], shift = grid.shift[a], per_edge = 1 / grid.edge;
    const std::int32_t rows = grid.shape[a], lower = grid.lower[a], extent = grid.extent(a);
    const bool periodic = grid.periodic[a];
    for (int i = begin; i < end; ++i) {
      double at = x[i];
      if (periodic) {
        at = at < 0 ? at + size : at;
        at = at >= size ? at - size : at;
        x[i] = at;
      }
      const bool inside = (at >= 0) & (at <= size);
      std::int32_t row = static_cast<std::int32_t>(inside ? at * per_edge + shift : 0.0);
      row = row < rows ? row : (periodic ? row - rows : rows - 1);
      row -= lower;
      const bool mine = inside & (row >= 0) & (row < extent);
      const std::int32_t before = a == 0 ? 0 : cell[i];
      cell[i] = mine & (before >= 0) ? before + stride * row : stray;
    }
    stride *= extent;
  }
}

}    // namespace mpc

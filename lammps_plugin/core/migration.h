// Particles that leave the cells of a process, on their way to the process that has theirs.

#pragma once

#include "fluid.h"
#include "processes.h"

namespace mpc {

// Whether the shorter way to a row is through the lower neighbour.
template <int D> bool is_below(const Grid<D> &grid, int axis, int row)
{
  if (!grid.periodic[axis]) return row < grid.lower[axis];
  const int rows = grid.shape[axis];
  const int down = (grid.lower[axis] - row + rows) % rows;
  const int up = (row - grid.upper[axis] + 1 + rows) % rows;
  return down < up;
}

// Exchange particles, or records that begin with one, axis by axis, neighbour to neighbour, until
// each process has its own. All processes call it, and each waits for all.
template <int D, class Record>
void bring_home(std::vector<Record> &travelling, const Grid<D> &grid, Processes &processes)
{
  constexpr int record = sizeof(Record) / sizeof(double);
  for (int a = 0; a < D; ++a) {
    bool more = processes.along(a) > 1;
    while (more) {
      std::vector<double> down, up;
      std::vector<Record> staying;
      for (const auto &particle : travelling) {
        const int row = grid.row(a, particle.x[a]);
        if (grid.owns(a, row)) {
          staying.push_back(particle);
          continue;
        }
        auto &side = is_below<D>(grid, a, row) ? down : up;
        const auto *values = reinterpret_cast<const double *>(&particle);
        side.insert(side.end(), values, values + record);
      }
      travelling = std::move(staying);
      const auto arrived = processes.trade(a, down, up);
      bool homeless = false;
      for (std::size_t k = 0; k < arrived.size(); k += record) {
        travelling.push_back(*reinterpret_cast<const Record *>(&arrived[k]));
        homeless |= !grid.owns(a, grid.row(a, travelling.back().x[a]));
      }
      more = processes.along(a) > 2 && processes.any(homeless);
    }
  }
}

}    // namespace mpc

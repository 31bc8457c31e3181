// Which colloids are near each cell of this process.

#pragma once

#include "grid.h"

#include <vector>

namespace mpc {

template <int D> class ColloidCells {
 public:
  struct Entry {
    int colloid, next;
  };

  void begin(const Grid<D> &grid)
  {
    grid_ = grid;
    head_.assign(grid.cells(), -1);
    entries_.clear();
  }

  // Enter a colloid at all cells that come closer to a place than a radius.
  void enter(int colloid, const Vector<D> &x, double radius)
  {
    enter(colloid, x, radius, [](int, double) {});
  }

  // The same, visiting each cell with its square distance from the place.
  template <class Visit>
  void enter(int colloid, const Vector<D> &x, double radius, const Visit &visit)
  {
    std::array<int, D> first, last;
    for (int a = 0; a < D; ++a) {
      const auto row = [&](double at) {
        return static_cast<int>(std::floor(at / grid_.edge + grid_.shift[a]));
      };
      first[a] = std::max(row(x[a] - radius), grid_.lower[a]);
      last[a] = std::min(row(x[a] + radius), grid_.upper[a] - 1);
      if (first[a] > last[a]) return;
    }
    auto rows = first;
    for (;;) {
      double distance = 0;    // of the place to the cell, squared
      int cell = 0;
      for (int a = D - 1; a >= 0; --a) {
        const double beyond =
            std::abs(x[a] - grid_.centre(a, rows[a])) - 0.5 * grid_.edge * (1 + 1e-9);
        if (beyond > 0) distance += beyond * beyond;
        cell = cell * grid_.extent(a) + rows[a] - grid_.lower[a];
      }
      if (distance < radius * radius) {
        entries_.push_back({colloid, head_[cell]});
        head_[cell] = static_cast<int>(entries_.size()) - 1;
        visit(cell, distance);
      }
      int a = 0;
      while (a < D && ++rows[a] > last[a]) {
        rows[a] = first[a];
        ++a;
      }
      if (a == D) return;
    }
  }

  bool any(int cell) const { return head_[cell] >= 0; }

  template <class Visit> void each(int cell, const Visit &visit) const
  {
    for (int e = head_[cell]; e >= 0; e = entries_[e].next) visit(entries_[e].colloid);
  }

  const Grid<D> &grid() const { return grid_; }    // as it was

 private:
  Grid<D> grid_{{}, {}, 1.0};
  std::vector<int> head_;    // of each cell, its list of entries; -1 for none
  std::vector<Entry> entries_;
};

}    // namespace mpc

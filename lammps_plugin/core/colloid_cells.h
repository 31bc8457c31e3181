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
    only_.assign(grid.cells(), NOBODY);
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
    std::array<int, D> first;
    for (int a = 0; a < D; ++a) {
      const auto row = [&](double at) {
        return static_cast<int>(std::floor(at / grid_.edge + grid_.shift[a]));
      };
      first[a] = std::max(row(x[a] - radius), grid_.lower[a]);
      const int last = std::min(row(x[a] + radius), grid_.upper[a] - 1);
      if (first[a] > last) return;
      squares_[a].clear();
      for (int r = first[a]; r <= last; ++r) {
        const double beyond = std::abs(x[a] - grid_.centre(a, r)) - 0.5 * grid_.edge * (1 + 1e-9);
        squares_[a].push_back(beyond > 0 ? beyond * beyond : 0.0);
      }
    }
    const double most = radius * radius;
    const auto &along = squares_[0];
    const int length = static_cast<int>(along.size());
    std::array<int, D> rows{};    // beyond the first, along all axes but the first
    for (;;) {
      double across = 0;
      int cell = 0;
      for (int a = D - 1; a > 0; --a) {
        across += squares_[a][rows[a]];
        cell = (cell + first[a] + rows[a] - grid_.lower[a]) * grid_.extent(a - 1);
      }
      cell += first[0] - grid_.lower[0];
      for (int r = 0; r < length; ++r) {
        const double distance = across + along[r];
        if (!(distance < most)) continue;
        only_[cell + r] = head_[cell + r] < 0 ? colloid : SEVERAL;
        entries_.push_back({colloid, head_[cell + r]});
        head_[cell + r] = static_cast<int>(entries_.size()) - 1;
        visit(cell + r, distance);
      }
      int a = 1;
      while (a < D && ++rows[a] == static_cast<int>(squares_[a].size())) {
        rows[a] = 0;
        ++a;
      }
      if (a == D) return;
    }
  }

  bool any(int cell) const { return head_[cell] >= 0; }

  // The colloid of a cell that has just one, else one of these.
  static constexpr int NOBODY = -1, SEVERAL = -2;
  int only(int cell) const { return only_[cell]; }

  template <class Visit> void each(int cell, const Visit &visit) const
  {
    for (int e = head_[cell]; e >= 0; e = entries_[e].next) visit(entries_[e].colloid);
  }

  const Grid<D> &grid() const { return grid_; }    // as it was

 private:
  Grid<D> grid_{{}, {}, 1.0};
  std::vector<int> head_;    // of each cell, its list of entries; -1 for none
  std::vector<int> only_;
  std::vector<Entry> entries_;
  std::array<std::vector<double>, D> squares_;    // of distances along each axis, by row
};

}    // namespace mpc

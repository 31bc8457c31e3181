// Which colloids are near each cell of this process.

#pragma once

#include "grid.h"
#include "memory.h"

#include <algorithm>
#include <limits>

namespace mpc {

template <int D> class ColloidCells {
 public:
  struct Entry {
    int colloid;
    float square;    // distance of its place from the cell, squared; not more
  };

  void begin(const Grid<D> &grid)
  {
    grid_ = grid;
    start_.assign(grid.cells() + 1, 0);
    nearest_.assign(grid.cells(), std::numeric_limits<float>::infinity());
    only_.assign(grid.cells(), NOBODY);
    stretches_.clear();
    along_.clear();
  }

  // Enter a colloid at all cells that come closer to a place than a radius.
  void enter(int colloid, const Vector<D> &x, double radius)
  {
    std::array<int, D> first, last;
    for (int a = 0; a < D; ++a) {
      const auto row = [&](double at) {
        return static_cast<int>(std::floor(at / grid_.edge + grid_.shift[a]));
      };
      first[a] = std::max(row(x[a] - radius), grid_.lower[a]);
      last[a] = std::min(row(x[a] + radius), grid_.upper[a] - 1);
      if (first[a] > last[a]) return;
      auto &squares = squares_[a];
      squares.clear();
      for (int r = first[a]; r <= last[a]; ++r) {
        const double beyond = std::abs(x[a] - grid_.centre(a, r)) - 0.5 * grid_.edge * (1 + ROUNDING);
        squares.push_back(static_cast<float>(beyond > 0 ? beyond * beyond * (1 - ROUNDING) : 0.0));
      }
    }
    const float most = static_cast<float>(radius * radius * (1 + ROUNDING));
    const auto &along = squares_[0];
    const int length = static_cast<int>(along.size()), kept = static_cast<int>(along_.size());
    along_.insert(along_.end(), along.begin(), along.end());
    std::array<int, D> rows{};    // beyond the first, along all axes but the first
    for (;;) {
      float across = 0;
      int cell = 0;
      for (int a = D - 1; a > 0; --a) {
        across += squares_[a][rows[a]];
        cell = (cell + first[a] + rows[a] - grid_.lower[a]) * grid_.extent(a - 1);
      }
      cell += first[0] - grid_.lower[0];
      int low = 0, high = length;
      while (low < high && !(across + along[low] < most)) ++low;
      while (low < high && !(across + along[high - 1] < most)) --high;
      if (low < high) {
        stretches_.push_back({colloid, cell + low, high - low, kept + low, across});
        for (int r = low; r < high; ++r)
          only_[cell + r] = ++start_[cell + r] == 1 ? colloid : SEVERAL;
        for (int r = low; r < high; ++r)
          nearest_[cell + r] = std::min(nearest_[cell + r], across + along[r]);
      }
      int a = 1;
      while (a < D && ++rows[a] == static_cast<int>(squares_[a].size())) {
        rows[a] = 0;
        ++a;
      }
      if (a == D) return;
    }
  }

  // When all are entered. The lists of all cells, one after the other.
  void finish()
  {
    int total = 0;
    for (int &start : start_) start = total += start;
    entries_.resize(total);
    for (auto stretch = stretches_.rbegin(); stretch != stretches_.rend(); ++stretch)
      for (int r = 0; r < stretch->length; ++r)
        entries_[--start_[stretch->cell + r]] = {stretch->colloid,
                                                 stretch->across + along_[stretch->along + r]};
    looks_.resize(start_.size());
    for (int cell = 0; cell < static_cast<int>(nearest_.size()); ++cell)
      looks_[cell] = {start_[cell], nearest_[cell]};
    looks_.back() = {total, 0};
  }

  bool any(int cell) const { return only_[cell] != NOBODY; }

  // Ask for what the next and begin() look at.
  void prefetch_look(int cell) const { __builtin_prefetch(looks_.data() + cell); }

  // The colloid of a cell that has just one, else one of these.
  static constexpr int NOBODY = -1, SEVERAL = -2;
  int only(int cell) const { return only_[cell]; }

  // Square distance from a cell to the nearest place.
  float nearest(int cell) const { return looks_[cell].nearest; }

  // Ask for the list of a cell, which is far from those of others.
  void prefetch(int cell) const { __builtin_prefetch(begin(cell)); }

  // The list of a cell.
  const Entry *begin(int cell) const { return entries_.data() + looks_[cell].start; }
  const Entry *end(int cell) const { return begin(cell + 1); }

  // Colloids whose places come closer to a cell than a distance.
  template <class Visit> void each(int cell, double distance, const Visit &visit) const
  {
    const double most = distance * distance;
    for (const auto *entry = begin(cell); entry < end(cell); ++entry)
      if (entry->square < most) visit(entry->colloid);
  }

  template <class Visit> void each(int cell, const Visit &visit) const
  {
    for (const auto *entry = begin(cell); entry < end(cell); ++entry) visit(entry->colloid);
  }

  const Grid<D> &grid() const { return grid_; }    // as it was

 private:
  static constexpr double ROUNDING = 1e-6;    // more than that of a float

  // Cells side by side along the first axis that a colloid is entered at.
  struct Stretch {
    int colloid, cell, length, along;
    float across;
  };

  // Of a cell, what is looked at for each particle: one line of the caches.
  struct Look {
    int start;    // in the entries
    float nearest;
  };

  Grid<D> grid_{{}, {}, 1.0};
  Array<Look> looks_;    // and the end of the entries
  Array<int> start_;
  Array<float> nearest_;
  Array<int> only_;
  Array<Entry> entries_;
  std::vector<Stretch> stretches_;
  std::vector<float> along_;                     // square distances along the first axis
  std::array<std::vector<float>, D> squares_;    // along each axis, by row
};

}    // namespace mpc

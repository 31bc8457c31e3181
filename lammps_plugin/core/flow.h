// Sums over a grid of bins: the flow of the fluid, where it is or about a moving centre.

#pragma once

#include "fluid.h"
#include "processes.h"

#include <algorithm>

namespace mpc {

template <int D> class FlowSums {
 public:
  static constexpr int WIDTH = D + 2;    // momentum, squares of the velocity, count

  explicit FlowSums(const std::array<int, D> &bins) : bins_(bins)
  {
    std::size_t total = 1;
    for (int a = 0; a < D; ++a) total *= bins[a];
    sums_.assign(total * WIDTH, 0);
  }

  // Add this process's particles, seen from an origin in the box.
  template <class Real>
  void look(const Fluid<D, Real> &fluid, const Grid<D> &grid, const Vector<D> &origin)
  {
    for (int i = 0; i < fluid.size(); ++i) {
      std::size_t bin = 0;
      for (int a = 0; a < D; ++a) {
        double at = fluid.position(a, i) - origin[a];
        if (at < 0) at += grid.box[a];    // of a periodic axis: others have the origin 0
        const int row = static_cast<int>(at * bins_[a] / grid.box[a]);
        bin = bin * bins_[a] + std::min(row, bins_[a] - 1);
      }
      double *sum = &sums_[bin * WIDTH];
      for (int a = 0; a < D; ++a) {
        const double v = fluid.v[a][i];
        sum[a] += v;
        sum[D] += v * v;
      }
      sum[D + 1] += 1;
    }
    ++looks_;
  }

  // Bring the sums of all processes to the first.
  void fold(Processes &processes, bool first)
  {
    processes.sum(sums_.data(), static_cast<int>(sums_.size()));
    if (!first) std::fill(sums_.begin(), sums_.end(), 0.0);
  }

  void clear()
  {
    std::fill(sums_.begin(), sums_.end(), 0.0);
    looks_ = 0;
  }

  const std::array<int, D> &bins() const { return bins_; }
  double looks() const { return looks_; }
  const std::vector<double> &sums() const { return sums_; }

  // As a restart keeps them: looks, then sums. False for those of another grid.
  std::vector<double> state() const
  {
    std::vector<double> state{looks_};
    state.insert(state.end(), sums_.begin(), sums_.end());
    return state;
  }

  bool restore(const std::vector<double> &state, bool first)
  {
    if (state.size() != sums_.size() + 1) return false;
    looks_ = state[0];
    if (first) std::copy(state.begin() + 1, state.end(), sums_.begin());
    return true;
  }

 private:
  std::array<int, D> bins_;
  double looks_ = 0;
  std::vector<double> sums_;    // of this process, the last axis fastest
};

}    // namespace mpc

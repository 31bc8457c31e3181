// How the velocities of the fluid are distributed.

#pragma once

#include "fluid.h"
#include "lanes.h"
#include "processes.h"

#include <algorithm>
#include <cmath>

namespace mpc {

// Of the components along each axis, about their mean; 0 for a normal distribution.
template <int D> struct Moments {
  Vector<D> skewness{}, excess_kurtosis{};
};

// Of all processes; 0 where all velocities are the same.
template <int D, class Real> Moments<D> moments(const Fluid<D, Real> &fluid, Processes &processes)
{
  std::array<double, 4 * D + 1> sums{};    // of the powers 1 to 4 of each component; particles
  for (int a = 0; a < D; ++a) {
    const auto *velocities = fluid.v[a].data();
    const auto powers = sum_in_lanes<4>(fluid.size(), [=](int i) {
      const double v = velocities[i], square = v * v;
      return std::array<double, 4>{v, square, square * v, square * square};
    });
    std::copy(powers.begin(), powers.end(), &sums[4 * a]);
  }
  sums[4 * D] = fluid.size();
  processes.sum(sums.data(), 4 * D + 1);

  Moments<D> moments;
  for (int a = 0; a < D && sums[4 * D] > 0; ++a) {
    double mean_power[4];
    for (int p = 0; p < 4; ++p) mean_power[p] = sums[4 * a + p] / sums[4 * D];
    const auto [mean, second, third, fourth] = mean_power;
    const double variance = second - mean * mean;
    if (!(variance > 0)) continue;
    const double cubed = third - 3 * mean * second + 2 * mean * mean * mean;
    const double squared =
        fourth - 4 * mean * third + 6 * mean * mean * second - 3 * mean * mean * mean * mean;
    moments.skewness[a] = cubed / std::pow(variance, 1.5);
    moments.excess_kurtosis[a] = squared / (variance * variance) - 3;
  }
  return moments;
}

}    // namespace mpc

// How the velocities of the fluid are distributed.

#pragma once

#include "fluid.h"
#include "processes.h"

#include <cmath>

namespace mpc {

// Of the components along each axis, about their mean; 0 for a normal distribution.
template <int D> struct Moments {
  Vector<D> skewness{}, excess_kurtosis{};
};

// Of all processes; 0 where all velocities are the same.
template <int D> Moments<D> moments(const Fluid<D> &fluid, Processes &processes)
{
  std::array<double, D + 1> sums{};    // of the velocities, and the number of particles
  for (int a = 0; a < D; ++a)
    for (double v : fluid.v[a]) sums[a] += v;
  sums[D] = fluid.size();
  processes.sum(sums.data(), D + 1);

  std::array<double, 3 * D> powers{};
  for (int a = 0; a < D && sums[D] > 0; ++a) {
    const double mean = sums[a] / sums[D];
    double second = 0, third = 0, fourth = 0;
    for (double v : fluid.v[a]) {
      const double deviation = v - mean, square = deviation * deviation;
      second += square;
      third += square * deviation;
      fourth += square * square;
    }
    powers[3 * a] = second;
    powers[3 * a + 1] = third;
    powers[3 * a + 2] = fourth;
  }
  processes.sum(powers.data(), 3 * D);

  Moments<D> moments;
  for (int a = 0; a < D; ++a) {
    const double variance = powers[3 * a] / sums[D];
    if (!(variance > 0)) continue;
    moments.skewness[a] = powers[3 * a + 1] / sums[D] / std::pow(variance, 1.5);
    moments.excess_kurtosis[a] = powers[3 * a + 2] / sums[D] / (variance * variance) - 3;
  }
  return moments;
}

}    // namespace mpc

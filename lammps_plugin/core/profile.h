// The fluid by layers of equal depth across y.

#pragma once

#include "fluid.h"
#include "processes.h"

namespace mpc {

struct Layer {
  double count = 0, momentum_x = 0, squares = 0;
  double deviation = 0;    // squares less those of the mean velocity, 2 x thermal energy
};

// Of all processes.
template <int D, class Real>
std::vector<Layer> layers(const Fluid<D, Real> &fluid, const Grid<D> &grid, int bins,
                          Processes &processes)
{
  constexpr int width = D + 2;    // momentum, squares, count
  std::vector<double> sums(bins * width);
  const double per_depth = bins / grid.box[1];
  for (int i = 0; i < fluid.size(); ++i) {
    const int bin = std::min(static_cast<int>(fluid.position(1, i) * per_depth), bins - 1);
    double *sum = &sums[bin * width];
    double squares = 0;
    for (int a = 0; a < D; ++a) {
      const double v = fluid.v[a][i];
      sum[a] += v;
      squares += v * v;
    }
    sum[D] += squares;
    sum[D + 1] += 1;
  }
  processes.sum(sums.data(), bins * width);

  std::vector<Layer> layers(bins);
  for (int bin = 0; bin < bins; ++bin) {
    const double *sum = &sums[bin * width];
    layers[bin] = {sum[D + 1], sum[0], sum[D], sum[D]};
    for (int a = 0; a < D && sum[D + 1] > 0; ++a)
      layers[bin].deviation -= sum[a] * sum[a] / sum[D + 1];
  }
  return layers;
}

// Temperature about the mean velocities of the layers.
inline double temperature(const std::vector<Layer> &layers, int dimensions)
{
  double deviation = 0, free = 0;
  for (const auto &layer : layers) {
    deviation += layer.deviation;
    free += std::max(layer.count - 1, 0.0);
  }
  return free > 0 ? deviation / (dimensions * free) : 0.0;
}

}    // namespace mpc

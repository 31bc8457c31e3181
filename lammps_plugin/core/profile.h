// The fluid by layers of equal depth across y.

#pragma once

#include "collision.h"
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
  constexpr int copies = 4;       // of a sum: particles of a layer often follow each other
  std::vector<std::array<double, width>> of(copies * bins);
  const double per_depth = bins / grid.box[1];
  for (int i = 0; i < fluid.size(); ++i) {
    const int bin = std::min(static_cast<int>(fluid.position(1, i) * per_depth), bins - 1);
    auto &sum = of[copies * bin + i % copies];
    for (int a = 0; a < D; ++a) {
      const double v = fluid.v[a][i];
      sum[a] += v;
      sum[D] += v * v;
    }
    sum[D + 1] += 1;
  }
  std::vector<double> sums(bins * width);
  for (int k = 0; k < copies * bins; ++k)
    for (int n = 0; n < width; ++n) sums[k / copies * width + n] += of[k][n];
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

// No-slip walls at rest: bounce-back of the fluid (tabatabaei-2009, 3.13), and virtual particles in
// the cells that a wall cuts (3.2.5).

#pragma once

#include "walls.h"

namespace mpc {

template <int D> class NoSlipWalls : public Walls<D> {
 public:
  NoSlipWalls(double width, double density, double temperature)
    : Walls<D>(width), density_(density), temperature_(temperature)
  {
  }

  void contact(Face, Vector<D> &velocity) const override
  {
    for (double &component : velocity) component = -component;
  }

  // A cell with n < density particles is filled up with density - n more, at rest on average; the
  // sum of their velocities has the variance (density - n) T (3.14).
  Vector<D> mean_of_cut(Face, const CellSum<D> &sum, const CounterRandom &random,
                        std::uint64_t cell) const override
  {
    if (sum.count() >= density_) return sum.mean();
    const auto z = normals<D>(random.words(Stream::Wall, cell));
    const double width = std::sqrt((density_ - sum.count()) * temperature_);
    Vector<D> mean;
    for (int a = 0; a < D; ++a) mean[a] = (sum.momentum[a] + width * z[a]) / density_;
    return mean;
  }

 private:
  double density_, temperature_;
};

}    // namespace mpc

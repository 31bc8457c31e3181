// No-slip walls, at rest or moving along themselves: bounce-back of the fluid in the frame of the
// wall (tabatabaei-2009, 3.13; hecht-2005, VIII C), and virtual particles in the cells that a wall
// cuts (3.2.5).

#pragma once

#include "walls.h"

namespace mpc {

template <int D> class NoSlipWalls : public Walls<D> {
 public:
  // Cells are filled up to the density; 0: they are left as they are.
  NoSlipWalls(const Grid<D> &grid, double density, double temperature,
              const FaceVectors<D> &velocities = {})
    : Walls<D>(grid), density_(density), temperature_(temperature), velocities_(velocities)
  {
    for (const auto &velocity : velocities_)
      gain_ = std::max(gain_, 2 * std::sqrt(square<D>(velocity)));
  }

  void reflect(Face face, Vector<D> &velocity) const override
  {
    const auto &of_wall = velocities_[face.number()];
    for (int a = 0; a < D; ++a) velocity[a] = 2 * of_wall[a] - velocity[a];
  }

  double gain() const override { return gain_; }

  // A cell with n < density fluid particles is filled up with density - n more, on average as fast
  // as the wall; the sum of their velocities has the variance (density - n) T (3.14). In a corner
  // they are as fast as its walls on the mean.
  Vector<D> mean_of_cut(const Cut<D> &cut, const CellSums<D> &sums, int cell,
                        const CounterRandom &random, std::uint64_t number) const override
  {
    const double missing = density_ - sums.of[cell].count();
    if (missing <= 0) return sums.mean(cell);
    const double mass = density_ + (sums.guests.empty() ? 0 : sums.guests[cell].mass);
    const auto z = normals<D>(random.words(Stream::Wall, number));
    const double width = std::sqrt(missing * temperature_);
    Vector<D> of_walls{};
    for (int b = 0; b < D; ++b)
      if (cut.sides[b])
        for (int a = 0; a < D; ++a)
          of_walls[a] += velocities_[Face{b, cut.sides[b] > 0}.number()][a] / cut.count;
    Vector<D> mean;
    for (int a = 0; a < D; ++a)
      mean[a] = (sums.of[cell].momentum[a] + missing * of_walls[a] + width * z[a]) / mass;
    return mean;
  }

 private:
  double density_, temperature_, gain_ = 0;
  FaceVectors<D> velocities_;
};

}    // namespace mpc

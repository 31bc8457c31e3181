// What solid walls are to the fluid: flat, at both ends of each axis that is not periodic.
//
// Streaming finds who meets a wall, and when; the walls say with which velocity it leaves. At the
// collision they say how the cells move that they cut. They count the momentum that they take up.

#pragma once

#include "collision.h"

#include <algorithm>

namespace mpc {

struct Face {
  int axis;
  bool upper;

  int number() const { return 2 * axis + upper; }
};

template <int D> using FaceVectors = std::array<Vector<D>, 2 * D>;    // by number of the face

// By axis, the face beyond which a cell reaches: -1 lower, +1 upper, 0 none.
template <int D> struct Cut {
  std::array<int, D> sides{};
  int count = 0;
};

template <int D> class Walls {
 public:
  explicit Walls(const Grid<D> &grid) : width_(grid.box)
  {
    for (int a = 0; a < D; ++a)
      if (!grid.periodic[a]) axes_.push_back(a);
  }
  virtual ~Walls() = default;

  // The axes that they stand across, and their distance.
  const std::vector<int> &axes() const { return axes_; }
  double width(int axis) const { return width_[axis]; }
  bool across(int axis) const { return std::count(axes_.begin(), axes_.end(), axis) > 0; }

  Cut<D> cutting(const Grid<D> &grid, const std::array<int, D> &rows) const
  {
    Cut<D> cut;
    for (int a : axes_) {
      const double start = rows[a] - grid.shift[a];
      cut.sides[a] = start < 0 ? -1 : start + 1 > width_[a] / grid.edge;
      cut.count += cut.sides[a] != 0;
    }
    return cut;
  }

  // A particle meets a wall.
  void contact(Face face, Vector<D> &velocity) const
  {
    auto &taken = taken_[face.number()];
    for (int a = 0; a < D; ++a) taken[a] += velocity[a];
    reflect(face, velocity);
    for (int a = 0; a < D; ++a) taken[a] -= velocity[a];
  }

  // Of momentum that a cell loses in a collision each of the walls that cut it takes its share.
  void take(const Cut<D> &cut, const Vector<D> &momentum)
  {
    for (int b = 0; b < D; ++b)
      if (cut.sides[b])
        for (int a = 0; a < D; ++a)
          taken_[Face{b, cut.sides[b] > 0}.number()][a] += momentum[a] / cut.count;
  }

  // Momentum by number of the face, on this process, since it was last forgotten.
  const FaceVectors<D> &taken() const { return taken_; }
  void forget() { taken_ = {}; }

  // Make the velocity that meets a wall the one that leaves it, for the inside.
  virtual void reflect(Face, Vector<D> &velocity) const = 0;

  // Most that contacts with one of the walls add to a speed.
  virtual double gain() const { return 0; }

  // Mean velocity of a cell that walls cut, with all that takes part in its collision.
  virtual Vector<D> mean_of_cut(const Cut<D> &, const CellSums<D> &, int cell,
                                const CounterRandom &, std::uint64_t number) const = 0;

 private:
  Vector<D> width_;
  std::vector<int> axes_;
  mutable FaceVectors<D> taken_{};    // by walls that particles meet, who change nothing else of them
};

}    // namespace mpc

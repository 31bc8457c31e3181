// What solid walls are to the fluid: flat, at y = 0 and y = width.
//
// Streaming finds who meets a wall, and when; the walls say with which velocity it leaves. At the
// collision they say how the cells move that they cut.

#pragma once

#include "collision.h"

#include <optional>

namespace mpc {

enum class Face { Lower, Upper };

template <int D> class Walls {
 public:
  explicit Walls(double width) : width_(width) {}
  virtual ~Walls() = default;

  double width() const { return width_; }

  // The wall that a row of cells reaches beyond.
  std::optional<Face> cutting(const Grid<D> &grid, int row) const
  {
    const double start = row - grid.shift[1];
    if (start < 0) return Face::Lower;
    if (start + 1 > width_ / grid.edge) return Face::Upper;
    return std::nullopt;
  }

  // Make the velocity that meets a wall the one that leaves it, for the inside.
  virtual void contact(Face, Vector<D> &velocity) const = 0;

  // Most that contacts with one of the walls add to a speed.
  virtual double gain() const { return 0; }

  // Mean velocity of a cell that a wall cuts, with all that takes part in its collision.
  virtual Vector<D> mean_of_cut(Face, const CellSum<D> &, const CounterRandom &,
                                std::uint64_t cell) const = 0;

 private:
  double width_;
};

}    // namespace mpc

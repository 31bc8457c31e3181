// The collision: relative velocities turned about the mean of their cell (tabatabaei-2009, 3.4 to
// 3.8; the rotations about coordinate axes of hecht-2005, section III).
//
// What a collision does to a particle is one affine map v -> offset + matrix v for its whole cell.
// So a collision is: sum over the particles, make the maps, map the particles.

#pragma once

#include "fluid.h"

#include <array>

namespace mpc {

template <int D> struct CellSum {
  Vector<D> momentum{};
  double squares = 0;    // of the velocities
  double count = 0;

  Vector<D> mean() const
  {
    Vector<D> mean{};
    if (count > 0)
      for (int a = 0; a < D; ++a) mean[a] = momentum[a] / count;
    return mean;
  }

  // Kinetic energy of the motion relative to the mean.
  double relative_energy() const
  {
    return count > 1 ? 0.5 * std::max(squares - square<D>(momentum) / count, 0.0) : 0.0;
  }
};

template <int D> struct Turn;

template <> struct Turn<2> {
  Vector<2> offset{};
  double cosine = 1, sine = 0;

  Vector<2> apply(double x, double y) const
  {
    return {offset[0] + (cosine * x - sine * y), offset[1] + (sine * x + cosine * y)};
  }
  Vector<2> apply(const Vector<2> &v) const { return apply(v[0], v[1]); }

  void scale(double factor)
  {
    for (double &component : offset) component *= factor;
    cosine *= factor;
    sine *= factor;
  }
};

template <> struct Turn<3> {
  Vector<3> offset{};
  std::array<double, 9> matrix{1, 0, 0, 0, 1, 0, 0, 0, 1};

  Vector<3> apply(double x, double y, double z) const
  {
    return {offset[0] + (matrix[0] * x + matrix[1] * y + matrix[2] * z),
            offset[1] + (matrix[3] * x + matrix[4] * y + matrix[5] * z),
            offset[2] + (matrix[6] * x + matrix[7] * y + matrix[8] * z)};
  }
  Vector<3> apply(const Vector<3> &v) const { return apply(v[0], v[1], v[2]); }

  void scale(double factor)
  {
    for (double &component : offset) component *= factor;
    for (double &element : matrix) element *= factor;
  }
};

// Make a map keep a point where it is.
template <int D> void fix_point(Turn<D> &turn, const Vector<D> &point)
{
  turn.offset = {};
  const auto moved = turn.apply(point);
  for (int a = 0; a < D; ++a) turn.offset[a] = point[a] - moved[a];
}

// Scale what a map gives, relative to a point.
template <int D> void scale_about(Turn<D> &turn, const Vector<D> &point, double factor)
{
  turn.scale(factor);
  for (int a = 0; a < D; ++a) turn.offset[a] += (1 - factor) * point[a];
}

enum class Axes { Random, Coordinate };

// The rotation of a cell, drawn from its own random numbers; angle in radians.
class Rotation {
 public:
  Rotation(double angle, Axes axes) : cosine_(std::cos(angle)), sine_(std::sin(angle)), axes_(axes)
  {
  }

  // 2D: counter-clockwise where the first uniform is below 1/2, else clockwise.
  void draw(const CounterRandom &random, std::uint64_t cell, Turn<2> &turn) const
  {
    turn.cosine = cosine_;
    turn.sine = uniform(random.words(Stream::Rotation, cell)[0]) < 0.5 ? sine_ : -sine_;
  }

  // 3D: about an axis uniform on the sphere (3.8), or about one of +-x, +-y, +-z.
  void draw(const CounterRandom &random, std::uint64_t cell, Turn<3> &turn) const
  {
    const auto u = uniforms(random.words(Stream::Rotation, cell));
    Vector<3> n{};
    if (axes_ == Axes::Coordinate) {
      const int choice = static_cast<int>(6 * u[0]);
      n[choice / 2] = choice % 2 ? -1 : 1;
    } else {
      const double height = 2 * u[0] - 1;
      const double equator = std::sqrt(1 - height * height);
      n = {equator * std::cos(2 * M_PI * u[1]), equator * std::sin(2 * M_PI * u[1]), height};
    }
    const double c = cosine_, s = sine_, rest = 1 - cosine_;
    turn.matrix = {c + rest * n[0] * n[0],        rest * n[0] * n[1] - s * n[2],
                   rest * n[0] * n[2] + s * n[1], rest * n[1] * n[0] + s * n[2],
                   c + rest * n[1] * n[1],        rest * n[1] * n[2] - s * n[0],
                   rest * n[2] * n[0] - s * n[1], rest * n[2] * n[1] + s * n[0],
                   c + rest * n[2] * n[2]};
  }

 private:
  double cosine_, sine_;
  Axes axes_;
};

}    // namespace mpc

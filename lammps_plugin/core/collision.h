// The collision: relative velocities turned about the mean of their cell (tabatabaei-2009, 3.4 to
// 3.8; the rotations about coordinate axes of hecht-2005, section III).
//
// What a collision does to a particle is one affine map v -> offset + matrix v for its whole cell.
// So a collision is: sum over the particles, make the maps, map the particles.

#pragma once

#include "fluid.h"

#include <array>
#include <tuple>

namespace mpc {

// The components of a velocity side by side, for the processor to work on at once; in 3D with a
// fourth that stays unused.
template <int D> struct Packing;
template <> struct Packing<2> {
  using Type = double __attribute__((vector_size(16)));
};
template <> struct Packing<3> {
  using Type = double __attribute__((vector_size(32)));
};
template <int D> using Pack = typename Packing<D>::Type;

inline Pack<2> pack(double x, double y)
{
  return Pack<2>{x, y};
}

inline Pack<3> pack(double x, double y, double z)
{
  return Pack<3>{x, y, z, 0};
}

// Of the particles of a cell: number of fluid particles, of mass 1; momentum and squares of all.
template <int D> struct CellSum {
  Pack<D> momentum{};
  Pack<2> squares_and_count{};    // of the velocities, weighted by mass

  double count() const { return squares_and_count[1]; }

  void add(double x, double y)
  {
    momentum += pack(x, y);
    squares_and_count += pack(x * x + y * y, 1);
  }

  void add(double x, double y, double z)
  {
    momentum += pack(x, y, z);
    squares_and_count += pack(x * x + y * y + z * z, 1);
  }
};

// What is in a cell beside fluid.
struct Guests {
  double number = 0, mass = 0;
};

template <int D> struct CellSums {
  Array<CellSum<D>> of;
  Array<Guests> guests;    // of each cell, or empty

  double number(int cell) const
  {
    return guests.empty() ? of[cell].count() : of[cell].count() + guests[cell].number;
  }

  double mass(int cell) const
  {
    return guests.empty() ? of[cell].count() : of[cell].count() + guests[cell].mass;
  }

  Vector<D> mean(int cell) const
  {
    const double mass = this->mass(cell);
    Vector<D> mean{};
    if (mass > 0)
      for (int a = 0; a < D; ++a) mean[a] = of[cell].momentum[a] / mass;
    return mean;
  }

  // Kinetic energy of the motion relative to the mean.
  double relative_energy(int cell) const
  {
    if (number(cell) < 2) return 0;
    double of_mean = 0;
    for (int a = 0; a < D; ++a) of_mean += of[cell].momentum[a] * of[cell].momentum[a];
    return 0.5 * std::max(of[cell].squares_and_count[0] - of_mean / mass(cell), 0.0);
  }

  // Add a guest.
  void add(int cell, const Vector<D> &v, double mass)
  {
    for (int a = 0; a < D; ++a) of[cell].momentum[a] += mass * v[a];
    of[cell].squares_and_count[0] += mass * square<D>(v);
    guests[cell].number += 1;
    guests[cell].mass += mass;
  }
};

template <int D> struct Turn {
  Pack<D> offset{};
  Pack<D> column[D]{};    // of the matrix

  template <class... Component> Pack<D> apply(Component... v) const
  {
    Pack<D> turned{};
    int a = 0;
    ((turned = a == 0 ? column[0] * v : turned + column[a] * v, ++a), ...);
    return offset + turned;
  }

  Vector<D> apply(const Vector<D> &v) const
  {
    const auto turned = std::apply([&](auto... component) { return apply(component...); }, v);
    Vector<D> result;
    for (int a = 0; a < D; ++a) result[a] = turned[a];
    return result;
  }

  void scale(double factor)
  {
    offset *= factor;
    for (auto &each : column) each *= factor;
  }
};

// Make a map keep a point where it is.
template <int D> void fix_point(Turn<D> &turn, const Vector<D> &point)
{
  turn.offset = Pack<D>{};
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

// The rotation of a cell, drawn from its own mixed words; angle in radians.
class Rotation {
 public:
  Rotation(double angle, Axes axes) : cosine_(std::cos(angle)), sine_(std::sin(angle)), axes_(axes)
  {
  }

  // 2D: counter-clockwise where the first uniform is below 1/2, else clockwise.
  void draw(const MixedWords &words, std::uint64_t cell, Turn<2> &turn) const
  {
    const double sine = uniform(words.word(0, cell)) < 0.5 ? sine_ : -sine_;
    turn.column[0] = pack(cosine_, sine);
    turn.column[1] = pack(-sine, cosine_);
  }

  // 3D: about an axis uniform on the sphere (3.8), or about one of +-x, +-y, +-z.
  void draw(const MixedWords &words, std::uint64_t cell, Turn<3> &turn) const
  {
    const double u[2] = {uniform(words.word(0, cell)), uniform(words.word(1, cell))};
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
    turn.column[0] = pack(c + rest * n[0] * n[0], rest * n[1] * n[0] + s * n[2],
                          rest * n[2] * n[0] - s * n[1]);
    turn.column[1] = pack(rest * n[0] * n[1] - s * n[2], c + rest * n[1] * n[1],
                          rest * n[2] * n[1] + s * n[0]);
    turn.column[2] = pack(rest * n[0] * n[2] + s * n[1], rest * n[1] * n[2] - s * n[0],
                          c + rest * n[2] * n[2]);
  }

 private:
  double cosine_, sine_;
  Axes axes_;
};

}    // namespace mpc

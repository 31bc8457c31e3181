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

// Of the particles of a cell: number of fluid particles, of mass 1; momentum of all, and in two
// dimensions squares of their velocities, weighted by mass.
template <int D> struct CellSum {
  Pack<D> momentum{};    // the fourth counts

  double count() const { return momentum[3]; }
  void add(const Vector<D> &v, double) { momentum += Pack<D>{v[0], v[1], v[2], 1}; }
};
template <> struct CellSum<2> {
  Pack<2> momentum{};
  Pack<2> squares_and_count{};

  double count() const { return squares_and_count[1]; }
  void add(const Vector<2> &v, double squares)
  {
    momentum += pack(v[0], v[1]);
    squares_and_count += pack(squares, 1);
  }
};

// What is in a cell beside fluid.
struct Guests {
  double number = 0, mass = 0;
};

template <int D> struct CellSums {
  Array<CellSum<D>> of;
  Array<Guests> guests;       // of each cell, or empty
  Array<double> squares{};    // of the velocities, in three dimensions and if they are wanted

  double bytes() const
  {
    return of.capacity() * 1.0 * sizeof(CellSum<D>) + squares.capacity() * 1.0 * sizeof(double);
  }

  void clear()
  {
    std::fill(of.begin(), of.end(), CellSum<D>{});
    std::fill(squares.begin(), squares.end(), 0.0);
  }

  // Add a fluid particle.
  void add(int cell, const Vector<D> &v)
  {
    const double squares_of_it = square<D>(v);
    of[cell].add(v, squares_of_it);
    if (D == 3 && !squares.empty()) squares[cell] += squares_of_it;
  }

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

  double square_sum(int cell) const
  {
    if constexpr (D == 2)
      return of[cell].squares_and_count[0];
    else
      return squares[cell];
  }

  // Kinetic energy of the motion relative to the mean; in three dimensions squares are needed.
  double relative_energy(int cell) const
  {
    if (number(cell) < 2) return 0;
    double of_mean = 0;
    for (int a = 0; a < D; ++a) of_mean += of[cell].momentum[a] * of[cell].momentum[a];
    return 0.5 * std::max(square_sum(cell) - of_mean / mass(cell), 0.0);
  }

  // Add a guest.
  void add(int cell, const Vector<D> &v, double mass)
  {
    for (int a = 0; a < D; ++a) of[cell].momentum[a] += mass * v[a];
    if constexpr (D == 2)
      of[cell].squares_and_count[0] += mass * square<D>(v);
    else if (!squares.empty())
      squares[cell] += mass * square<D>(v);
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
    for (int choice = 0; choice < 6; ++choice) {
      Vector<3> n{};
      n[choice / 2] = choice % 2 ? -1 : 1;
      about_coordinates_[choice] = about(n);
    }
  }

  // 2D: counter-clockwise where the first uniform is below 1/2, else clockwise. The fourth is left.
  void draw(const MixedWords &words, std::uint64_t cell, Turn<2> &turn) const
  {
    const double sine = uniform(words.word(0, cell)) < 0.5 ? sine_ : -sine_;
    turn.column[0] = pack(cosine_, sine);
    turn.column[1] = pack(-sine, cosine_);
  }

  // 3D: about an axis uniform on the sphere (3.8), or about one of +-x, +-y, +-z.
  void draw(const MixedWords &words, std::uint64_t cell, Turn<3> &turn) const
  {
    if (axes_ == Axes::Coordinate) {
      turn = about_coordinates_[static_cast<int>(6 * uniform(words.word(0, cell)))];
      return;
    }
    const double height = 2 * uniform(words.word(0, cell)) - 1, part = uniform(words.word(1, cell));
    const double equator = std::sqrt(1 - height * height);
    turn = about({equator * std::cos(2 * M_PI * part), equator * std::sin(2 * M_PI * part), height});
  }

 private:
  Turn<3> about(const Vector<3> &n) const
  {
    Turn<3> turn;
    const double c = cosine_, s = sine_, rest = 1 - cosine_;
    turn.column[0] = pack(c + rest * n[0] * n[0], rest * n[1] * n[0] + s * n[2],
                          rest * n[2] * n[0] - s * n[1]);
    turn.column[1] = pack(rest * n[0] * n[1] - s * n[2], c + rest * n[1] * n[1],
                          rest * n[2] * n[1] + s * n[0]);
    turn.column[2] = pack(rest * n[0] * n[2] + s * n[1], rest * n[1] * n[2] - s * n[0],
                          c + rest * n[2] * n[2]);
    return turn;
  }

  double cosine_, sine_;
  Axes axes_;
  std::array<Turn<3>, 6> about_coordinates_;    // x, -x, y, -y, z, -z
};

}    // namespace mpc

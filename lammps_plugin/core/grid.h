// The collision cells: a grid shifted at every collision, and the part of it this process owns.

#pragma once

#include "philox.h"

#include <array>
#include <cmath>

namespace mpc {

template <int D> using Vector = std::array<double, D>;

// Angular velocity or torque: about z in 2D.
template <int D> using Spin = std::array<double, D == 2 ? 1 : 3>;

inline Vector<2> cross(const Spin<2> &spin, const Vector<2> &arm)
{
  return {-spin[0] * arm[1], spin[0] * arm[0]};
}

inline Vector<3> cross(const Spin<3> &spin, const Vector<3> &arm)
{
  return {spin[1] * arm[2] - spin[2] * arm[1], spin[2] * arm[0] - spin[0] * arm[2],
          spin[0] * arm[1] - spin[1] * arm[0]};
}

// Of a force at the end of an arm.
inline Spin<2> torque(const Vector<2> &arm, const Vector<2> &force)
{
  return {arm[0] * force[1] - arm[1] * force[0]};
}

inline Spin<3> torque(const Vector<3> &arm, const Vector<3> &force)
{
  return cross(arm, force);
}

template <int D> double square(const Vector<D> &a)
{
  double sum = 0;
  for (double component : a) sum += component * component;
  return sum;
}

template <int D> struct Grid {
  Vector<D> box;                       // lengths; coordinates count from the lower corner
  std::array<bool, D> periodic;        // an axis that is not has a wall at either end
  double edge;                         // of a cell
  std::array<int, D> shape;            // cells of the whole box
  std::array<int, D> lower, upper;     // cells of this process: lower <= cell < upper
  Vector<D> shift{};                   // of the present grid, in cells, [0, 1)

  Grid(const Vector<D> &box, const std::array<bool, D> &periodic, double edge)
    : box(box), periodic(periodic), edge(edge), lower{}
  {
    for (int a = 0; a < D; ++a)
      shape[a] = periodic[a] ? static_cast<int>(std::lround(box[a] / edge))
                             : static_cast<int>(std::ceil(box[a] / edge)) + 1;
    upper = shape;
  }

  void draw_shift(const CounterRandom &random)
  {
    const auto u = uniforms(random.words(Stream::Shift, 0));
    for (int a = 0; a < D; ++a) shift[a] = u[a];
  }

  int extent(int axis) const { return upper[axis] - lower[axis]; }

  int cells() const
  {
    int count = 1;
    for (int a = 0; a < D; ++a) count *= extent(a);
    return count;
  }

  // The cell of this grid, 0 ... shape - 1, that a coordinate inside the box is in.
  int row(int axis, double coordinate) const
  {
    int row = static_cast<int>(coordinate * (1 / edge) + shift[axis]);
    if (row >= shape[axis]) row = periodic[axis] ? row - shape[axis] : shape[axis] - 1;
    return row;
  }

  bool owns(int axis, int row) const { return lower[axis] <= row && row < upper[axis]; }

  // Index among this process's cells; -1 for another's.
  int local(const Vector<D> &position) const
  {
    int cell = 0;
    for (int a = D - 1; a >= 0; --a) {
      const int r = row(a, position[a]);
      if (!owns(a, r)) return -1;
      cell = cell * extent(a) + r - lower[a];
    }
    return cell;
  }

  // Rows of the whole grid of one of this process's cells.
  std::array<int, D> rows(int cell) const
  {
    std::array<int, D> rows;
    for (int a = 0; a < D; ++a) {
      rows[a] = lower[a] + cell % extent(a);
      cell /= extent(a);
    }
    return rows;
  }

  // Visit this process's cells in order, with their rows in the whole grid.
  template <class Visit> void each_cell(const Visit &visit) const
  {
    auto rows = lower;
    const int count = cells();
    for (int cell = 0; cell < count; ++cell) {
      visit(cell, rows);
      for (int a = 0; a < D && ++rows[a] == upper[a]; ++a) rows[a] = lower[a];
    }
  }

  // Number in the whole grid, which names the cell's random numbers.
  std::uint64_t number(const std::array<int, D> &rows) const
  {
    std::uint64_t number = 0;
    for (int a = D - 1; a >= 0; --a) number = number * shape[a] + rows[a];
    return number;
  }

  double centre(int axis, int row) const { return (row + 0.5 - shift[axis]) * edge; }
};

template <int D> double wrapped(const Grid<D> &grid, int axis, double coordinate)
{
  if (!grid.periodic[axis]) return coordinate;
  const double size = grid.box[axis];
  const double inside = coordinate - size * std::floor(coordinate / size);
  return inside < size ? inside : 0.0;    // a negative rounding error was rounded up to the size
}

}    // namespace mpc

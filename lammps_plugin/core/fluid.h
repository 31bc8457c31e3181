// The fluid particles of this process, structure of arrays; mass 1.

#pragma once

#include "grid.h"
#include "memory.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace mpc {

// A state that no correct simulation reaches; the message names the particle.
struct Fault : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// One particle as it travels between processes and rests in files.
template <int D> struct Particle {
  double id;    // 0 ... N - 1, exact
  Vector<D> x, v;
};

// What precedes the particles in a file.
struct FluidHeader {
  char magic[8];
  std::int64_t dimension, particles, collisions;
};

constexpr double MOST_PARTICLES = 0x1p48;    // whose numbers a fluid can tell apart

// How a state is kept: in 64 bits for each number, or in 32. In single precision a coordinate is a
// whole number of places, 2^20 to a cell, counted from the middle of the process's cells: they are
// as fine in any box, and the same on any number of processes.
template <class Real> struct Kept {
  using Coordinate = double;
};
template <> struct Kept<float> {
  using Coordinate = std::int32_t;
};
constexpr int PLACE_BITS = 20;
constexpr double PLACES = 1 << PLACE_BITS;    // in the edge of a cell

// Where the places are along an axis.
struct Places {
  double middle, length, period;    // of one, and of the box, or 0 between walls
  std::int32_t first, last;         // between walls
};

template <int D, class Real = double> struct Fluid {
  static constexpr bool single = std::is_same_v<Real, float>;
  using Coordinate = typename Kept<Real>::Coordinate;

  std::array<Array<Coordinate>, D> x;    // see position()
  std::array<Array<Real>, D> v;
  Array<std::uint32_t> id;         // the lower bits of the number
  Array<std::uint16_t> id_high;    // the upper ones; empty as long as all are 0
  Array<std::int32_t> cell;    // among this process's cells
  std::array<Places, D> places;    // in single precision

  int size() const { return static_cast<int>(id.size()); }

  std::uint64_t number(int i) const
  {
    return id_high.empty() ? id[i] : std::uint64_t{id_high[i]} << 32 | id[i];
  }

  void numbers(int first, int count, std::uint64_t *of_each) const
  {
    for (int i = 0; i < count; ++i) of_each[i] = id[first + i];
    if (id_high.empty()) return;
    for (int i = 0; i < count; ++i) of_each[i] |= std::uint64_t{id_high[first + i]} << 32;
  }

  double position(int axis, int i) const { return positions(axis)(i); }

  // The same of all, for loops.
  auto positions(int axis) const
  {
    const auto *at = x[axis].data();
    if constexpr (single)
      return [at, of = places[axis]](int i) {
        const double position = of.middle + of.length * at[i];
        return position + (position < 0 ? of.period : 0) - (position >= of.period ? of.period : 0);
      };
    else
      return [at](int i) -> double { return at[i]; };
  }

  Vector<D> velocity(int i) const
  {
    Vector<D> velocity;
    for (int a = 0; a < D; ++a) velocity[a] = v[a][i];
    return velocity;
  }

  void set_position(int axis, int i, double position) { x[axis][i] = kept(axis, position); }

  Particle<D> particle(int i) const
  {
    Particle<D> p{static_cast<double>(number(i)), {}, {}};
    for (int a = 0; a < D; ++a) {
      p.x[a] = position(a, i);
      p.v[a] = v[a][i];
    }
    return p;
  }

  void append(const Particle<D> &p, int in_cell)
  {
    if (id.size() == id.capacity()) grow();
    for (int a = 0; a < D; ++a) {
      x[a].push_back(kept(a, p.x[a]));
      v[a].push_back(static_cast<Real>(p.v[a]));
    }
    const auto number = static_cast<std::uint64_t>(p.id);
    if (number >> 32 && id_high.empty()) {
      id_high.reserve(id.capacity());
      id_high.resize(id.size());
    }
    if (number >> 32 || !id_high.empty()) id_high.push_back(number >> 32);
    id.push_back(static_cast<std::uint32_t>(number));
    cell.push_back(in_cell);
  }

  // The last particle takes the place of the removed one.
  void remove(int i)
  {
    for (int a = 0; a < D; ++a) {
      take_last(x[a], i);
      take_last(v[a], i);
    }
    if (!id_high.empty()) take_last(id_high, i);
    take_last(id, i);
    take_last(cell, i);
  }

  void clear()
  {
    for (int a = 0; a < D; ++a) {
      x[a].clear();
      v[a].clear();
    }
    id_high.clear();
    id.clear();
    cell.clear();
  }

  double bytes() const
  {
    constexpr auto each = D * (sizeof(Coordinate) + sizeof(Real)) + sizeof id[0] + sizeof cell[0];
    return id.capacity() * 1.0 * each + id_high.capacity() * 2.0;
  }

 private:
  Coordinate kept(int axis, double position) const
  {
    if constexpr (single) {
      const auto &of = places[axis];
      position -= of.middle;
      if (of.period > 0) position -= of.period * std::rint(position / of.period);
      const double place = std::rint(position / of.length);    // the nearest
      return static_cast<Coordinate>(std::clamp<double>(place, of.first, of.last));
    } else {
      return position;
    }
  }

  // By little: the doubling of a vector would waste up to half of the memory.
  void grow()
  {
    const auto capacity = id.size() + id.size() / 16 + 1024;
    for (int a = 0; a < D; ++a) {
      x[a].reserve(capacity);
      v[a].reserve(capacity);
    }
    if (!id_high.empty()) id_high.reserve(capacity);
    id.reserve(capacity);
    cell.reserve(capacity);
  }

  template <class T> static void take_last(Array<T> &values, int i)
  {
    values[i] = values.back();
    values.pop_back();
  }
};

}    // namespace mpc

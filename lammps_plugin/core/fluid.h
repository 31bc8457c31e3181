// The fluid particles of this process, structure of arrays; mass 1.

#pragma once

#include "grid.h"
#include "memory.h"

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

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

template <int D> struct Fluid {
  std::array<Array<double>, D> x, v;
  Array<std::uint32_t> id;         // the lower bits of the number
  Array<std::uint16_t> id_high;    // the upper ones; empty as long as all are 0
  Array<std::int32_t> cell;    // among this process's cells

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

  Particle<D> particle(int i) const
  {
    Particle<D> p{static_cast<double>(number(i)), {}, {}};
    for (int a = 0; a < D; ++a) {
      p.x[a] = x[a][i];
      p.v[a] = v[a][i];
    }
    return p;
  }

  void append(const Particle<D> &p, int in_cell)
  {
    if (id.size() == id.capacity()) grow();
    for (int a = 0; a < D; ++a) {
      x[a].push_back(p.x[a]);
      v[a].push_back(p.v[a]);
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
    return id.capacity() * (2.0 * D * sizeof(double) + 8) + id_high.capacity() * 2.0;
  }

 private:
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

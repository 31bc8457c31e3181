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

template <int D> struct Fluid {
  std::array<Array<double>, D> x, v;
  Array<std::uint32_t> id;
  Array<std::int32_t> cell;    // among this process's cells

  int size() const { return static_cast<int>(id.size()); }

  Particle<D> particle(int i) const
  {
    Particle<D> p{static_cast<double>(id[i]), {}, {}};
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
    id.push_back(static_cast<std::uint32_t>(p.id));
    cell.push_back(in_cell);
  }

  // The last particle takes the place of the removed one.
  void remove(int i)
  {
    for (int a = 0; a < D; ++a) {
      take_last(x[a], i);
      take_last(v[a], i);
    }
    take_last(id, i);
    take_last(cell, i);
  }

  void clear()
  {
    for (int a = 0; a < D; ++a) {
      x[a].clear();
      v[a].clear();
    }
    id.clear();
    cell.clear();
  }

  double bytes() const { return id.capacity() * (2.0 * D * sizeof(double) + 8); }

 private:
  // By little: the doubling of a vector would waste up to half of the memory.
  void grow()
  {
    const auto capacity = id.size() + id.size() / 16 + 1024;
    for (int a = 0; a < D; ++a) {
      x[a].reserve(capacity);
      v[a].reserve(capacity);
    }
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

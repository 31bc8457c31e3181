// Streaming: free flight in a constant field, and the exact time of contact with walls.
// Equations of tabatabaei-2009, 3.2.1, 3.2.5 and 3.4.3.

#pragma once

#include "fluid.h"
#include "walls.h"

#include <algorithm>

namespace mpc {

// In one step. Thermal particles need one, but where two walls meet, hundreds: to and fro along a
// chord of the corner, which may be as short as chance will have it.
constexpr int MOST_BOUNCES = 1000000;

// First t with v t + a t^2 / 2 = distance (3.44 corrected), for a wall that is reached; of the two
// forms of the root the one that subtracts nothing.
inline double contact_time(double distance, double velocity, double acceleration)
{
  const double speed = std::sqrt(std::max(velocity * velocity + 2 * acceleration * distance, 0.0));
  return velocity > 0 ? 2 * distance / (velocity + speed) : (speed - velocity) / acceleration;
}

// Position and velocity after a time, with all contacts on the way (3.11, 3.13 corrected). False
// when there are too many.
template <int D>
bool fly_between(const Walls<D> &walls, Vector<D> &x, Vector<D> &v, const Vector<D> &acceleration,
                 double time)
{
  const auto fly = [&](double t) {
    for (int a = 0; a < D; ++a) {
      x[a] += t * (v[a] + 0.5 * t * acceleration[a]);
      v[a] += t * acceleration[a];
    }
  };
  for (int bounce = 0; bounce < MOST_BOUNCES; ++bounce) {
    Face face{-1, false};
    double first = time;
    for (int a : walls.axes()) {
      const double end = x[a] + time * (v[a] + 0.5 * time * acceleration[a]);
      if (!(end < 0 || end > walls.width(a))) continue;
      const double outwards = end < 0 ? -1 : 1;
      const double wall = end < 0 ? 0 : walls.width(a);
      const double contact = std::min(
          contact_time(outwards * (wall - x[a]), outwards * v[a], outwards * acceleration[a]), time);
      if (face.axis >= 0 && contact >= first) continue;
      face = {a, end > 0};
      first = contact;
    }
    fly(first);
    if (face.axis < 0) return true;
    x[face.axis] = face.upper ? walls.width(face.axis) : 0;
    walls.contact(face, v);
    time -= first;
  }
  return false;
}

// An acceleration that all particles share.
template <int D> struct Field {
  Vector<D> field;
  double operator()(int axis, int) const { return field[axis]; }
};

// One for each.
template <int D> struct PerParticle {
  std::array<const double *, D> values;
  double operator()(int axis, int i) const { return values[axis][i]; }
};

// Thrown for a particle that meets the walls more than MOST_BOUNCES times.
struct TooManyBounces {
  int index;

  static Fault fault(std::uint64_t id)
  {
    return Fault("fluid particle " + std::to_string(id) + " meets the walls more than " +
                 std::to_string(MOST_BOUNCES) +
                 " times in one step: it is too fast, or pressed against a wall");
  }
};

// Of the particles first ... last - 1 the states of those that meet walls in the time, at its end.
template <int D, class Acceleration>
void bounce(const std::array<double *, D> &positions, const std::array<double *, D> &velocities,
            const Acceleration &acceleration, double time, const Walls<D> &walls, int first, int last,
            std::vector<std::pair<int, std::array<Vector<D>, 2>>> &bounced)
{
  int crossing = 0;
  for (int axis : walls.axes()) {
    const double width = walls.width(axis);
    const double *__restrict y = positions[axis];
    const double *__restrict vy = velocities[axis];
    for (int i = first; i < last; ++i) {
      const double target = y[i] + time * (vy[i] + 0.5 * time * acceleration(axis, i));
      crossing += (target < 0) | (target > width);
    }
  }
  for (int i = first; crossing > 0; ++i) {
    int faces = 0;
    for (int axis : walls.axes()) {
      const double target = positions[axis][i] +
          time * (velocities[axis][i] + 0.5 * time * acceleration(axis, i));
      faces += (target < 0) | (target > walls.width(axis));
    }
    if (faces == 0) continue;
    crossing -= faces;
    Vector<D> x, v, a;
    for (int d = 0; d < D; ++d) {
      x[d] = positions[d][i];
      v[d] = velocities[d][i];
      a[d] = acceleration(d, i);
    }
    if (!fly_between<D>(walls, x, v, a, time)) throw TooManyBounces{i};
    bounced.push_back({i, {x, v}});
  }
}

// Move particles begin ... end - 1 for a time, between walls if there are any (3.3, 3.51).
template <int D, class Acceleration>
void stream(const std::array<double *, D> &positions, const std::array<double *, D> &velocities,
            const Acceleration &acceleration, double time, const Walls<D> *walls, int begin,
            int end)
{
  constexpr int FEW = 64;    // particles, to look among for the one that meets a wall
  static thread_local std::vector<std::pair<int, std::array<Vector<D>, 2>>> bounced;
  bounced.clear();
  if (walls)
    for (int first = begin; first < end; first += FEW)
      bounce<D>(positions, velocities, acceleration, time, *walls, first,
                std::min(first + FEW, end), bounced);
  for (int d = 0; d < D; ++d) {
    double *__restrict x = positions[d];
    double *__restrict v = velocities[d];
    for (int i = begin; i < end; ++i) {
      const double a = acceleration(d, i);
      x[i] += time * (v[i] + 0.5 * time * a);
      v[i] += time * a;
    }
  }
  for (const auto &[i, state] : bounced)
    for (int d = 0; d < D; ++d) {
      positions[d][i] = state[0][d];
      velocities[d][i] = state[1][d];
    }
}

}    // namespace mpc

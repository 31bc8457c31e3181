// What a coupling of colloids and fluid is to the solver.
//
// An interval is the time between two collisions. At its beginning the coupling takes the particles
// that it will move itself, at every MD step; all others fly free through the whole interval at
// once. At its end it gives them back. Colloids may take part in the collision themselves; what they
// gain there is a force on them in the MD step after it.

#pragma once

#include "collision.h"

namespace mpc {

// A colloid, or an image of one, that this process sees.
template <int D> struct Colloid {
  double id;
  Vector<D> x, v;
  double mass;
  double epsilon, sigma;    // of its interaction with the fluid
};

template <int D> class Coupling {
 public:
  virtual ~Coupling() = default;

  // Farthest that a colloid is felt: how far around its own cells a process must see colloids.
  virtual double reach(double largest_sigma) const = 0;

  // Colloids as they stand; none becomes faster than the speed given before the interval ends.
  virtual void begin(const Grid<D> &, const std::vector<Colloid<D>> &, double speed) = 0;

  // Take from the particles begin ... end - 1; their indices join taken().
  virtual void take(const Fluid<D> &, int begin, int end) = 0;
  virtual const std::vector<int> &taken() const = 0;
  virtual void ready() = 0;

  // Velocity Verlet of what was taken: positions; then forces, also on the colloids; then
  // velocities.
  virtual void drift(double time) = 0;
  virtual void forces(const std::vector<Colloid<D>> &, std::vector<Vector<D>> &on_colloids) = 0;
  virtual void kick(double time) = 0;

  virtual void give_back(Fluid<D> &) = 0;

  // The collision, in this process's cells: join their sums, then do as their turns say.
  virtual void join(const Grid<D> &, const std::vector<Colloid<D>> &, Array<CellSum<D>> &) {}
  virtual void turn(const Array<Turn<D>> &) {}
};

}    // namespace mpc

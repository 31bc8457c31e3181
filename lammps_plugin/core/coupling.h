// What a coupling of colloids and fluid is to the solver and its host.
//
// An interval is the time between two collisions. A coupling acts in one or more of its phases:
//
//   at every MD step    at the interval's beginning it takes the particles that it will move itself;
//                       all others fly free through the whole interval at once. At its end it gives
//                       them back (force_coupling.h)
//   after the flight    particles that have met a colloid on their way are taken from where they met
//                       it on another way (reflection_coupling.h)
//   in the collision    colloids are particles of their cells (cell_coupling.h)
//
// What it does to colloids is forces and torques in the first, impulses of both in the others.

#pragma once

#include "collision.h"
#include "processes.h"

namespace mpc {

// A colloid, or an image of one, that this process sees.
template <int D> struct Colloid {
  double id;
  int type;
  Vector<D> x, v;
  Spin<D> spin;
  double mass, inertia;
  Vector<D> mean{};    // velocity over the interval, where it is after the flight
};

// A force and a torque, or their impulses.
template <int D> struct Push {
  Vector<D> linear{};
  Spin<D> angular{};
};

// A particle on its way through an interval.
template <int D> struct Flight : Particle<D> {
  double flown;       // time since it was last at rest on a surface, or the interval
  double contacts;    // with colloids
};

template <int D> class Coupling {
 public:
  using Colloids = std::vector<Colloid<D>>;

  virtual ~Coupling() = default;

  // Whether the fluid feels colloids of this type, and how far around them none is created.
  virtual bool feels(int type) const = 0;
  virtual double room(int /*type*/) const { return 0; }

  // Whether a process must see images of colloids, and how far around its own cells.
  virtual bool sees_images() const { return true; }
  virtual double reach() const { return 0; }

  // Colloids as they stand; none becomes faster than the speed given before the interval ends.
  virtual void begin(const Grid<D> &, const Colloids &, double /*speed*/) {}

  // At every MD step. Take from the particles begin ... end - 1; their indices join taken(). The
  // fluid is in double or in single precision, if that can be.
  virtual bool every_step() const { return false; }
  virtual void take(const Fluid<D> &, int /*begin*/, int /*end*/) {}
  virtual void take(const Fluid<D, float> &, int /*begin*/, int /*end*/) {}
  const std::vector<int> &taken() const { return taken_; }
  virtual void ready() {}

  // Forces on what was taken, and on the colloids; and a step of velocity Verlet of what was taken,
  // once the colloids have come to where it ends.
  virtual void forces(const Colloids &, std::vector<Push<D>> & /*on_colloids*/) {}
  virtual void step(double /*time*/, const Colloids &, std::vector<Push<D>> & /*on_colloids*/) {}
  virtual void give_back(Fluid<D> &) {}
  virtual void give_back(Fluid<D, float> &) {}

  // After the flight, which then is at the interval's end. Colloids as they are now, and the grid of
  // the next collision; then which of the particles begin ... end - 1 have met a colloid, and
  // whether one that has come from another process has: each is remembered. Then, in rounds: when
  // all processes know of all contacts, what each did to its particle, in this order; and whether
  // that meets a colloid again. False for a particle that met none.
  virtual bool after_flight() const { return false; }
  virtual void meet(const Grid<D> &, const Colloids &, const CounterRandom &) {}
  virtual void watch(const Fluid<D> &, int /*begin*/, int /*end*/, std::vector<int> & /*met*/) {}
  virtual void announce(const Flight<D> &, int /*cell*/) {}
  virtual void decide(Processes &) {}
  virtual bool reflect_next(Flight<D> &) { return false; }

  // In the collision, in this process's cells: join their sums, then do as their turns say.
  virtual bool in_collision() const { return false; }
  virtual void join(const Grid<D> &, const Colloids &, CellSums<D> &, Processes &) {}
  virtual void turn(const Array<Turn<D>> &, Processes &) {}

  // On each of the colloids of the last meet or join; an image's is its own part of the whole.
  const std::vector<Push<D>> &impulses() const { return impulses_; }

 protected:
  std::vector<int> taken_;
  std::vector<Push<D>> impulses_;
};

}    // namespace mpc

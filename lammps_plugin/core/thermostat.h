// Thermostats of the fluid, applied once after the rotation (tabatabaei-2009, 3.3.8 and 3.4.6).

#pragma once

#include "collision.h"
#include "processes.h"

namespace mpc {

// All that one collision has; sums and turns are by this process's cells.
template <int D> struct Collision {
  const Grid<D> &grid;
  const CounterRandom &random;
  const CellSums<D> &sums;
  Array<Turn<D>> &turns;
  Processes &processes;

  // Mean velocity of a cell's particles after its turn.
  Vector<D> mean_after(int cell) const { return turns[cell].apply(sums.mean(cell)); }
};

template <int D> class Thermostat {
 public:
  virtual ~Thermostat() = default;

  // Change what the turns do.
  virtual void scale(Collision<D> &) {}

  // Whether redraw is to be called, with the velocities after the collision.
  virtual bool redraws() const { return false; }
  virtual void redraw(Fluid<D> &, const CounterRandom &) {}
  virtual void redraw(Fluid<D, float> &, const CounterRandom &) {}
};

// Each layer of cells across an axis, parallel to the walls, is rescaled to T (3.53, 3.54).
template <int D> class LayerThermostat : public Thermostat<D> {
 public:
  explicit LayerThermostat(double temperature, int axis = 1)
    : temperature_(temperature), axis_(axis)
  {
  }

  void scale(Collision<D> &collision) override
  {
    const auto &grid = collision.grid;
    const int layers = grid.shape[axis_];
    std::vector<double> totals(2 * layers);    // energies, then particles less occupied cells
    grid.each_cell([&](int cell, const std::array<int, D> &rows) {
      totals[rows[axis_]] += collision.sums.relative_energy(cell);
      totals[layers + rows[axis_]] += std::max(collision.sums.number(cell) - 1, 0.0);
    });
    collision.processes.sum(totals.data(), 2 * layers);
    std::vector<double> factors(layers, 1.0);
    for (int layer = 0; layer < layers; ++layer)
      if (totals[layer] > 0)
        factors[layer] =
            std::sqrt(temperature_ * 0.5 * D * totals[layers + layer] / totals[layer]);
    grid.each_cell([&](int cell, const std::array<int, D> &rows) {
      scale_about<D>(collision.turns[cell], collision.mean_after(cell), factors[rows[axis_]]);
    });
  }

 private:
  double temperature_;
  int axis_;
};

// Each cell is scaled by a Monte Carlo trial (3.55 to 3.57, 3.56 corrected for the dimension;
// hecht-2005, 33, where velocities are weighted by mass).
template <int D> class MonteCarloThermostat : public Thermostat<D> {
 public:
  explicit MonteCarloThermostat(double temperature) : temperature_(temperature) {}

  void scale(Collision<D> &collision) override
  {
    collision.grid.each_cell([&](int cell, const std::array<int, D> &rows) {
      const double particles = collision.sums.number(cell);
      if (particles < 2) return;
      const auto number = collision.grid.number(rows);
      const auto u = uniforms(collision.random.words(Stream::Thermostat, number));
      double factor = 1 + STRENGTH * u[0];
      if (u[1] >= 0.5) factor = 1 / factor;
      const double freedom = D * (particles - 1);
      const double energy = collision.sums.relative_energy(cell) / temperature_;
      if (u[2] < std::exp(freedom * std::log(factor) - (factor * factor - 1) * energy))
        scale_about<D>(collision.turns[cell], collision.mean_after(cell), factor);
    });
  }

 private:
  static constexpr double STRENGTH = 0.1;    // the largest epsilon of (3.55)
  double temperature_;
};

// Each cell is scaled to an energy drawn from its canonical distribution (Huang et al., J. Comput.
// Phys. 229, 168, 2010).
template <int D> class MaxwellBoltzmannThermostat : public Thermostat<D> {
 public:
  explicit MaxwellBoltzmannThermostat(double temperature) : temperature_(temperature) {}

  void scale(Collision<D> &collision) override
  {
    collision.grid.each_cell([&](int cell, const std::array<int, D> &rows) {
      const double particles = collision.sums.number(cell);
      const double energy = collision.sums.relative_energy(cell);
      if (particles < 2 || energy <= 0) return;
      const int freedom = D * (static_cast<int>(particles) - 1);
      const double drawn = draw(collision.random, collision.grid.number(rows), freedom);
      scale_about<D>(collision.turns[cell], collision.mean_after(cell),
                     std::sqrt(temperature_ * drawn / energy));
    });
  }

 private:
  // Energy over temperature of so many degrees of freedom: half of them exponentials, and half the
  // square of a normal for one left over.
  static double draw(const CounterRandom &random, std::uint64_t cell, int freedom)
  {
    const int exponentials = freedom / 2;
    double energy = 0;
    int block = 0;
    for (int k = 0; k < exponentials; k += 4, ++block) {
      const auto u = uniforms(random.words(Stream::Thermostat, cell, block));
      for (int j = 0; j < std::min(4, exponentials - k); ++j) energy -= std::log1p(-u[j]);
    }
    if (freedom % 2) {
      const double z = normals<1>(random.words(Stream::Thermostat, cell, block))[0];
      energy += 0.5 * z * z;
    }
    return energy;
  }

  double temperature_;
};

// All velocities are rescaled to a kinetic energy of D N T / 2 (3.39, 3.40).
template <int D> class RescalingThermostat : public Thermostat<D> {
 public:
  explicit RescalingThermostat(double temperature) : temperature_(temperature) {}

  void scale(Collision<D> &collision) override
  {
    double totals[2] = {0, 0};    // energy, particles
    for (int cell = 0; cell < collision.grid.cells(); ++cell) {
      totals[0] += collision.sums.relative_energy(cell) +
          0.5 * collision.sums.mass(cell) * square<D>(collision.mean_after(cell));
      totals[1] += collision.sums.number(cell);
    }
    collision.processes.sum(totals, 2);
    if (totals[0] > 0) {
      const double factor = std::sqrt(0.5 * D * totals[1] * temperature_ / totals[0]);
      for (auto &turn : collision.turns) turn.scale(factor);
    }
  }

 private:
  double temperature_;
};

// Each velocity is redrawn from the Maxwell distribution with a probability (3.3.8).
template <int D> class AndersenThermostat : public Thermostat<D> {
 public:
  AndersenThermostat(double temperature, double collision_time)
    : speed_(std::sqrt(temperature)), probability_(FREQUENCY * collision_time)
  {
  }

  bool redraws() const override { return true; }

  void redraw(Fluid<D> &fluid, const CounterRandom &random) override { draw(fluid, random); }
  void redraw(Fluid<D, float> &fluid, const CounterRandom &random) override
  {
    draw(fluid, random);
  }

 private:
  template <class Real> void draw(Fluid<D, Real> &fluid, const CounterRandom &random) const
  {
    for (int i = 0; i < fluid.size(); ++i) {
      const auto number = fluid.number(i);
      if (uniform(random.words(Stream::Thermostat, number)[0]) >= probability_) continue;
      const auto z = normals<D>(random.words(Stream::Thermostat, number, 1));
      for (int a = 0; a < D; ++a) fluid.v[a][i] = static_cast<Real>(speed_ * z[a]);
    }
  }

  static constexpr double FREQUENCY = 0.1;    // redrawings of a particle in a time unit
  double speed_, probability_;
};

}    // namespace mpc

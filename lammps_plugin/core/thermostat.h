// Thermostats of the fluid, applied once after the rotation (tabatabaei-2009, 3.3.8 and 3.4.6).

#pragma once

#include "collision.h"
#include "processes.h"

namespace mpc {

// All that one collision has; sums and turns are by this process's cells.
template <int D> struct Collision {
  const Grid<D> &grid;
  const CounterRandom &random;
  const Array<CellSum<D>> &sums;
  Array<Turn<D>> &turns;
  Processes &processes;
  double particles;    // of all processes

  // Mean velocity of a cell's fluid after its turn.
  Vector<D> mean_after(int cell) const { return turns[cell].apply(sums[cell].mean()); }
};

template <int D> class Thermostat {
 public:
  virtual ~Thermostat() = default;

  // Change what the turns do.
  virtual void scale(Collision<D> &) {}

  // Whether redraw is to be called, with the velocities after the collision.
  virtual bool redraws() const { return false; }
  virtual void redraw(Fluid<D> &, const CounterRandom &) {}
};

// Each layer of cells parallel to the walls is rescaled to T (3.53, 3.54).
template <int D> class LayerThermostat : public Thermostat<D> {
 public:
  explicit LayerThermostat(double temperature) : temperature_(temperature) {}

  void scale(Collision<D> &collision) override
  {
    const auto &grid = collision.grid;
    const int layers = grid.shape[1];
    std::vector<double> totals(2 * layers);    // energies, then particles less occupied cells
    grid.each_cell([&](int cell, const std::array<int, D> &rows) {
      totals[rows[1]] += collision.sums[cell].relative_energy();
      totals[layers + rows[1]] += std::max(collision.sums[cell].count() - 1, 0.0);
    });
    collision.processes.sum(totals.data(), 2 * layers);
    std::vector<double> factors(layers, 1.0);
    for (int layer = 0; layer < layers; ++layer)
      if (totals[layer] > 0)
        factors[layer] =
            std::sqrt(temperature_ * 0.5 * D * totals[layers + layer] / totals[layer]);
    grid.each_cell([&](int cell, const std::array<int, D> &rows) {
      scale_about<D>(collision.turns[cell], collision.mean_after(cell), factors[rows[1]]);
    });
  }

 private:
  double temperature_;
};

// Each cell is scaled by a Monte Carlo trial (3.55 to 3.57, 3.56 corrected for the dimension).
template <int D> class MonteCarloThermostat : public Thermostat<D> {
 public:
  explicit MonteCarloThermostat(double temperature) : temperature_(temperature) {}

  void scale(Collision<D> &collision) override
  {
    collision.grid.each_cell([&](int cell, const std::array<int, D> &rows) {
      const auto &sum = collision.sums[cell];
      if (sum.count() < 2) return;
      const auto number = collision.grid.number(rows);
      const auto u = uniforms(collision.random.words(Stream::Thermostat, number));
      double factor = 1 + STRENGTH * u[0];
      if (u[1] >= 0.5) factor = 1 / factor;
      const double freedom = D * (sum.count() - 1);
      const double energy = sum.relative_energy() / temperature_;
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
      const auto &sum = collision.sums[cell];
      const double energy = sum.relative_energy();
      if (sum.count() < 2 || energy <= 0) return;
      const int freedom = D * (static_cast<int>(sum.count()) - 1);
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
    double energy = 0;
    for (int cell = 0; cell < collision.grid.cells(); ++cell)
      energy += collision.sums[cell].relative_energy() +
          0.5 * collision.sums[cell].count() * square<D>(collision.mean_after(cell));
    collision.processes.sum(&energy, 1);
    if (energy > 0) {
      const double factor = std::sqrt(0.5 * D * collision.particles * temperature_ / energy);
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

  void redraw(Fluid<D> &fluid, const CounterRandom &random) override
  {
    for (int i = 0; i < fluid.size(); ++i) {
      if (uniform(random.words(Stream::Thermostat, fluid.id[i])[0]) >= probability_) continue;
      const auto z = normals<D>(random.words(Stream::Thermostat, fluid.id[i], 1));
      for (int a = 0; a < D; ++a) fluid.v[a][i] = speed_ * z[a];
    }
  }

 private:
  static constexpr double FREQUENCY = 0.1;    // redrawings of a particle in a time unit
  double speed_, probability_;
};

}    // namespace mpc

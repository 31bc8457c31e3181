// The MPC fluid of one process, from one collision to the next.
//
//   begin_interval   turn the velocities as the last collision said, give the coupling what is near
//                    colloids, move all others to the end of the interval, sort into new cells
//   end_interval     take the near ones back, reflect what has met colloids, exchange with other
//                    processes, collide
//
// The first is one pass over memory, in blocks that stay in the first-level cache. Where colloids
// reflect the fluid it waits for their last places, and begins the second. A collision only makes
// the maps of the cells; turn() applies them at once when somebody wants to see velocities.

#pragma once

#include "coupling.h"
#include "migration.h"
#include "profile.h"
#include "flow.h"
#include "random_solvent.h"
#include "single.h"
#include "streaming.h"
#include "thermostat.h"
#include "tile_order.h"

#include <memory>

namespace mpc {

template <int D> struct Method {
  std::uint64_t seed;
  double interval;       // tau_c
  Vector<D> field;       // acceleration of the fluid
  Rotation rotation;
  bool shifted;          // whether the grid is shifted at each collision
  std::unique_ptr<Walls<D>> walls;                   // or none
  std::unique_ptr<Thermostat<D>> thermostat;         // or none
  std::unique_ptr<RandomSolvent<D>> random_solvent;  // or none
  std::unique_ptr<Coupling<D>> coupling;             // or none
  double thermal_speed = 1;
};

// A solver as its host sees it, in either precision.
template <int D> class AnySolver {
 public:
  virtual ~AnySolver() = default;

  virtual const Grid<D> &grid() const = 0;
  virtual Coupling<D> *coupling() const = 0;
  virtual std::uint64_t collisions() const = 0;
  virtual double particles() const = 0;    // of all processes

  virtual int size() const = 0;            // of this process's fluid
  virtual Particle<D> particle(int) const = 0;

  virtual void reset(std::uint64_t collisions, const std::array<int, D> &lower,
                     const std::array<int, D> &upper) = 0;
  virtual void add(Particle<D>) = 0;
  virtual void count() = 0;
  virtual void redistribute(const std::array<int, D> &lower, const std::array<int, D> &upper) = 0;

  virtual void turn() = 0;
  virtual void zero_momentum() = 0;
  virtual void add_velocity(const Vector<D> &) = 0;
  virtual Vector<D> momentum() = 0;
  virtual std::vector<Layer> layers(int bins) = 0;
  virtual void look(FlowSums<D> &, const Vector<D> &origin) = 0;

  virtual void find_near(const std::vector<Colloid<D>> &, double colloid_speed) = 0;
  virtual void begin_interval(const std::vector<Colloid<D>> &, double colloid_speed) = 0;
  virtual void end_interval(const std::vector<Colloid<D>> & = {}) = 0;

  virtual double memory() const = 0;
};

template <int D, class Real = double> class Solver : public AnySolver<D> {
 public:
  Solver(Grid<D> grid, Method<D> method, Processes &processes)
    : grid_(grid), method_(std::move(method)), processes_(processes)
  {
  }

  const Grid<D> &grid() const override { return grid_; }
  const Fluid<D, Real> &fluid() const { return fluid_; }
  Coupling<D> *coupling() const override { return method_.coupling.get(); }
  std::uint64_t collisions() const override { return collisions_; }
  double particles() const override { return particles_; }
  int size() const override { return fluid_.size(); }
  Particle<D> particle(int i) const override { return fluid_.particle(i); }

  // Make room for the fluid as it was after so many collisions; then add all particles, in
  // whichever order, and count them: each process keeps its own.
  void reset(std::uint64_t collisions, const std::array<int, D> &lower,
             const std::array<int, D> &upper) override
  {
    fluid_.clear();
    turning_ = false;
    collisions_ = collisions;
    set_cells(lower, upper);
    grid_.shift = {};
    if (collisions > 0) draw_shift(collisions - 1);
  }

  void add(Particle<D> particle) override
  {
    for (int a = 0; a < D; ++a) particle.x[a] = wrapped<D>(grid_, a, particle.x[a]);
    const int cell = grid_.local(particle.x);
    if (cell >= 0) fluid_.append(particle, cell);
  }

  void count() override
  {
    particles_ = fluid_.size();
    processes_.sum(&particles_, 1);
  }

  // Take over other cells, between intervals.
  void redistribute(const std::array<int, D> &lower, const std::array<int, D> &upper) override
  {
    if (!processes_.any(lower != grid_.lower || upper != grid_.upper)) return;
    for (int a = 0; a < D; ++a)
      if (processes_.any(upper[a] <= lower[a]))
        throw Fault(std::string("too many processes along ") + "xyz"[a] + ": one has no cells");
    turn();
    for (int i = 0; i < fluid_.size(); ++i) travelling_.push_back(fluid_.particle(i));
    fluid_.clear();
    set_cells(lower, upper);
    migrate();
  }

  // Velocities as they are after the last collision.
  void turn() override
  {
    if (turning_) turn(0, fluid_.size());
    turning_ = false;
  }

  void zero_momentum() override
  {
    Vector<D> mean = momentum();
    for (int a = 0; a < D; ++a)
      for (auto &component : fluid_.v[a])
        component = static_cast<Real>(component - mean[a] / particles_);
  }

  void add_velocity(const Vector<D> &change) override
  {
    turn();
    for (int a = 0; a < D; ++a)
      for (auto &component : fluid_.v[a])
        component = static_cast<Real>(component + change[a]);
  }

  // Of all processes.
  Vector<D> momentum() override
  {
    turn();
    Vector<D> total{};
    for (int a = 0; a < D; ++a)
      for (double component : fluid_.v[a]) total[a] += component;
    processes_.sum(total.data(), D);
    return total;
  }

  std::vector<Layer> layers(int bins) override
  {
    turn();
    return mpc::layers(fluid_, grid_, bins, processes_);
  }

  void look(FlowSums<D> &sums, const Vector<D> &origin) override
  {
    turn();
    sums.look(fluid_, grid_, origin);
  }

  // Let the coupling know the forces between intervals; nothing moves.
  void find_near(const std::vector<Colloid<D>> &colloids, double colloid_speed) override
  {
    turn();
    method_.coupling->begin(grid_, colloids, colloid_speed);
    method_.coupling->take(fluid_, 0, fluid_.size());
    method_.coupling->ready();
  }

  void begin_interval(const std::vector<Colloid<D>> &colloids, double colloid_speed) override
  {
    if (collisions_ % SORT_INTERVAL == 0) tiles_.sort(fluid_, grid_);
    auto *coupling = method_.coupling.get();
    if (coupling) coupling->begin(grid_, colloids, colloid_speed);
    draw_shift(collisions_);
    if (!reflecting()) move();
    if (coupling) coupling->ready();
  }

  void end_interval(const std::vector<Colloid<D>> &colloids = {}) override
  {
    if (reflecting()) {
      method_.coupling->meet(grid_, colloids, {method_.seed, collisions_});
      move();
      reflect();
    } else if (auto *coupling = method_.coupling.get()) {
      coupling->give_back(fluid_);
      for (int i : coupling->taken()) {
        sort(i, i + 1);
        sum(i, i + 1);
      }
    }
    std::sort(strays_.rbegin(), strays_.rend());    // removal moves the last one: begin there
    for (int i : strays_) {
      if (!reflecting()) travelling_.push_back(fluid_.particle(i));
      fluid_.remove(i);
    }
    migrate();
    collide(colloids);
  }

  // In bytes, on this process.
  double memory() const override
  {
    return fluid_.bytes() + sums_.of.capacity() * (1.0 * sizeof(CellSum<D>) + sizeof(Turn<D>)) +
        tiles_.bytes();
  }

 private:
  static constexpr bool single = Fluid<D, Real>::single;
  using KeptTurn = std::conditional_t<single, SingleTurn<D>, Turn<D>>;

  static constexpr int BLOCK = 512;           // particles; their state fits the first-level cache
  static constexpr int AHEAD = 32;            // particles
  static constexpr int SORT_INTERVAL = 64;    // collisions, in which a particle moves a few cells
  static constexpr int STRAY = -1, TAKEN = -2;    // instead of a cell

  // Whether a thermostat needs the squares of the velocities.
  bool scales() const { return method_.thermostat && !method_.thermostat->redraws(); }

  bool reflecting() const { return method_.coupling && method_.coupling->after_flight(); }

  // All that the coupling does not take, to the end of the interval and into the sums of the cells.
  void move()
  {
    auto *coupling = method_.coupling.get();
    sums_.clear();
    strays_.clear();
    held_.clear();
    for (int begin = 0; begin < fluid_.size(); begin += BLOCK) {
      const int end = std::min(begin + BLOCK, fluid_.size());
      if (turning_) turn(begin, end);
      const auto before = coupling ? coupling->taken().size() : 0;
      if (coupling) coupling->take(fluid_, begin, end);
      fly(begin, end);
      sort(begin, end);
      if (coupling)
        for (auto k = before; k < coupling->taken().size(); ++k)
          fluid_.cell[coupling->taken()[k]] = TAKEN;
      if (reflecting()) hold(begin, end);
      sum(begin, end);
    }
    turning_ = false;
  }

  void set_cells(const std::array<int, D> &lower, const std::array<int, D> &upper)
  {
    grid_.lower = lower;
    grid_.upper = upper;
    sums_.of.assign(grid_.cells(), {});
    if (D == 3 && scales()) sums_.squares.assign(grid_.cells(), 0);
    sums_.guests.clear();
    turns_.assign(grid_.cells(), {});
    if constexpr (single) fluid_.places = places_of(grid_);
  }

  void draw_shift(std::uint64_t collision)
  {
    if (!method_.shifted) return;
    grid_.draw_shift({method_.seed, collision});
    if constexpr (single) round_shift(grid_);
  }

  // Ask for what the particle a few further on needs of its cell: caches do not foresee it. Inlined
  // always, as GCC drops calls that do nothing else.
  template <class Value>
  __attribute__((always_inline)) inline void prefetch(const Array<Value> &of_cells, int i) const
  {
    const int cell = fluid_.cell[std::min(i + AHEAD, fluid_.size() - 1)];
    const auto *value = reinterpret_cast<const char *>(of_cells.data() + cell);
    for (std::size_t line = 0; line < sizeof(Value); line += CACHE_LINE)
      __builtin_prefetch(value + line, 1);
  }

  __attribute__((always_inline)) inline void prefetch_state(int i) const
  {
    i = std::min(i, fluid_.size() - 1);
    for (int a = 0; a < D; ++a) {
      __builtin_prefetch(fluid_.x[a].data() + i, 1);
      __builtin_prefetch(fluid_.v[a].data() + i, 1);
    }
    __builtin_prefetch(fluid_.cell.data() + i, 1);
  }

  void turn(int begin, int end)
  {
    if constexpr (single)
      mpc::turn<D>(fluid_, turns_, begin, end);
    else
      turn_in_double(begin, end);
  }

  void turn_in_double(int begin, int end)
  {
    const Turn<D> *turns = turns_.data();
    const std::int32_t *cell = fluid_.cell.data();
    double *__restrict vx = fluid_.v[0].data();
    double *__restrict vy = fluid_.v[1].data();
    if constexpr (D == 2) {
      for (int i = begin; i < end; ++i) {
        const auto v = turns[cell[i]].apply(vx[i], vy[i]);
        vx[i] = v[0];
        vy[i] = v[1];
      }
    } else {
      double *__restrict vz = fluid_.v[2].data();
      for (int i = begin; i < end; ++i) {
        prefetch(turns_, i);
        const auto v = turns[cell[i]].apply(vx[i], vy[i], vz[i]);
        vx[i] = v[0];
        vy[i] = v[1];
        vz[i] = v[2];
      }
    }
  }

  void fly(int begin, int end)
  {
    try {
      if constexpr (single) {
        Vector<D> kick;
        for (int a = 0; a < D; ++a)
          kick[a] = dithered(method_.interval * method_.field[a], method_.thermal_speed, collisions_);
        mpc::fly<D>(fluid_, grid_, method_.field, kick, method_.interval, method_.walls.get(), begin,
                    end);
      } else {
        std::array<double *, D> x, v;
        for (int a = 0; a < D; ++a) {
          x[a] = fluid_.x[a].data();
          v[a] = fluid_.v[a].data();
        }
        stream<D>(x, v, Field<D>{method_.field}, method_.interval, method_.walls.get(), begin, end);
      }
    } catch (const TooManyBounces &bounces) {
      throw bounces.fault(fluid_.id[bounces.index]);
    }
  }

  // Wrap and find the cells. Whoever is in none of this process's cells, has flown further than the
  // box, or is nowhere, becomes a stray; sum() looks closer.
  void sort(int begin, int end)
  {
    if constexpr (single)
      find_cells(fluid_, grid_, method_.interval, begin, end, STRAY);
    else
      sort_in_double(begin, end);
  }

  void sort_in_double(int begin, int end)
  {
    std::int32_t *__restrict cell = fluid_.cell.data();
    std::int32_t stride = 1;
    for (int a = 0; a < D; ++a) {
      double *__restrict x = fluid_.x[a].data();
      const double size = grid_.box[a], shift = grid_.shift[a], per_edge = 1 / grid_.edge;
      const std::int32_t rows = grid_.shape[a], lower = grid_.lower[a], extent = grid_.extent(a);
      const bool periodic = grid_.periodic[a];
      for (int i = begin; i < end; ++i) {
        double at = x[i];
        if (periodic) {
          at = at < 0 ? at + size : at;
          at = at >= size ? at - size : at;
          x[i] = at;
        }
        const bool inside = (at >= 0) & (at <= size);
        std::int32_t row = static_cast<std::int32_t>(inside ? at * per_edge + shift : 0.0);
        row = row < rows ? row : (periodic ? row - rows : rows - 1);
        row -= lower;
        const bool mine = inside & (row >= 0) & (row < extent);
        const std::int32_t before = a == 0 ? 0 : cell[i];
        cell[i] = mine & (before >= 0) ? before + stride * row : STRAY;
      }
      stride *= extent;
    }
  }

  void sum(int begin, int end)
  {
    constexpr int line = CACHE_LINE / sizeof(Real);
    if constexpr (single) {
      const auto *cell = fluid_.cell.data();
      const auto add_four = AddFour<D>(fluid_, sums_);
      for (int i = begin; i < end; i += 4) {
        if (i % line == 0) prefetch_state(i + BLOCK);    // of the next block
        if (i + 4 <= end && (cell[i] | cell[i + 1] | cell[i + 2] | cell[i + 3]) >= 0)
          add_four(i);
        else
          for (int k = i; k < std::min(i + 4, end); ++k) sum_closely(k);
      }
    } else {
      for (int i = begin; i < end; ++i) {
        if (i % line == 0) prefetch_state(i + BLOCK);
        if constexpr (D == 3) prefetch(sums_.of, i);
        sum_closely(i);
      }
    }
  }

  __attribute__((always_inline)) inline void sum_closely(int i)
  {
    int cell = fluid_.cell[i];
    if (cell < 0) {
      if (cell == TAKEN) return;
      cell = fluid_.cell[i] = find(i);
      if (cell < 0) {
        strays_.push_back(i);
        return;
      }
    }
    sums_.add(cell, fluid_.velocity(i));
  }

  // Keep back what has met colloids.
  void hold(int begin, int end)
  {
    for (int i = begin; i < end; ++i)
      if (fluid_.cell[i] == STRAY) fluid_.cell[i] = find(i);
    const auto before = held_.size();
    if constexpr (!single) method_.coupling->watch(fluid_, begin, end, held_);
    for (auto k = before; k < held_.size(); ++k) fluid_.cell[held_[k]] = TAKEN;
  }

  // Reflect what was held, and bring it into the sums; what has come to the cells of other processes
  // goes there, and may be reflected there.
  void reflect()
  {
    auto &coupling = *method_.coupling;
    std::vector<Flight<D>> leaving;
    for (int i : strays_) leaving.push_back({fluid_.particle(i), method_.interval, 0});
    auto arrived = std::move(leaving);
    bring_home<D>(arrived, grid_, processes_);
    for (auto &flight : arrived) coupling.announce(flight, locate(flight));
    coupling.decide(processes_);

    leaving.clear();
    for (int i : held_) {
      Flight<D> flight{fluid_.particle(i), method_.interval, 0};
      coupling.reflect_next(flight);
      const int cell = fluid_.cell[i] = bounce(flight);
      for (int a = 0; a < D; ++a) {
        fluid_.set_position(a, i, flight.x[a]);
        fluid_.v[a][i] = static_cast<Real>(flight.v[a]);
      }
      if (cell < 0) {
        strays_.push_back(i);
        leaving.push_back(flight);
      } else {
        sums_.add(cell, fluid_.velocity(i));
      }
    }
    for (auto &flight : arrived) coupling.reflect_next(flight);
    for (;;) {
      for (auto &flight : arrived)
        (bounce(flight) < 0 ? leaving : landed_).push_back(flight);
      if (!processes_.any(!leaving.empty())) break;
      arrived = std::move(leaving);
      leaving.clear();
      bring_home<D>(arrived, grid_, processes_);
    }
    travelling_.assign(landed_.begin(), landed_.end());
    landed_.clear();
  }

  // Reflect a particle until it meets no colloid; its cell, or -1 for another process's.
  int bounce(Flight<D> &flight)
  {
    int cell = locate(flight);
    while (cell >= 0 && method_.coupling->reflect(flight, cell)) cell = locate(flight);
    return cell;
  }

  int locate(Flight<D> &flight) const
  {
    for (int a = 0; a < D; ++a) flight.x[a] = wrapped<D>(grid_, a, flight.x[a]);
    return grid_.local(flight.x);
  }

  // The cell of a stray, if it is this process's after all.
  int find(int i)
  {
    Vector<D> x;
    for (int a = 0; a < D; ++a) {
      x[a] = wrapped<D>(grid_, a, fluid_.position(a, i));
      fluid_.set_position(a, i, x[a]);
      const bool inside = x[a] >= 0 && x[a] <= grid_.box[a];
      if (!inside || !std::isfinite(fluid_.v[a][i]))
        throw Fault("fluid particle " + std::to_string(fluid_.id[i]) + " has " + "xyz"[a] + " = " +
                    std::to_string(x[a]) + " and v" + "xyz"[a] + " = " +
                    std::to_string(fluid_.v[a][i]) +
                    ": not a number, or beyond a wall; the time step is too long");
      if (single && std::abs(fluid_.v[a][i]) * method_.interval >= LONGEST_FLIGHT * grid_.edge)
        throw Fault("precision single: fluid particle " + std::to_string(fluid_.id[i]) + " has v" +
                    "xyz"[a] + " = " + std::to_string(fluid_.v[a][i]) + ": it flies further than " +
                    std::to_string(static_cast<int>(LONGEST_FLIGHT)) + " cells");
    }
    return grid_.local(x);
  }

  void migrate()
  {
    bring_home<D>(travelling_, grid_, processes_);
    for (const auto &particle : travelling_) {
      fluid_.append(particle, grid_.local(particle.x));
      sums_.add(fluid_.cell.back(), fluid_.velocity(fluid_.size() - 1));
    }
    travelling_.clear();
  }

  void collide(const std::vector<Colloid<D>> &colloids)
  {
    const CounterRandom random{method_.seed, collisions_};
    auto *coupling = method_.coupling.get();
    auto *solvent = method_.random_solvent.get();
    auto *thermostat = method_.thermostat.get();
    // where colloids join, it is by the collision that they meet even a fluid to be redrawn
    const bool joining = coupling && coupling->in_collision();
    if (joining || !solvent || !solvent->replaces_collision()) {
      if (joining) coupling->join(grid_, colloids, sums_, processes_);
      make_turns(random);
      turning_ = true;
      if (thermostat) {
        if constexpr (!single) {
          Collision<D> collision{grid_, random, sums_, turns_, processes_};
          thermostat->scale(collision);
        }
        if (thermostat->redraws()) {
          turn();
          thermostat->redraw(fluid_, random);
        }
      }
      if constexpr (!single)
        if (joining) coupling->turn(turns_, processes_);
    }
    if constexpr (!single)
      if (solvent) {
        turn();
        solvent->redraw(fluid_, random, processes_, particles_);
      }
    ++collisions_;
  }

  void make_turns(const CounterRandom &random)
  {
    if constexpr (single)
      make_single_turns(random);
    else
      make_double_turns(random);
  }

  void make_single_turns(const CounterRandom &random)
  {
    const auto *walls = method_.walls.get();
    auto *thermostat = method_.thermostat.get();
    const auto fix = [&](int cell, const std::array<int, D> &rows, Turn<D> &turn) {
      fix_point<D>(turn, sums_.mean(cell));
      if (!walls) return;
      if (const auto cut = walls->cutting(grid_, rows); cut.count > 0)
        fix_point<D>(turn, walls->mean_of_cut(cut, sums_, cell, random, grid_.number(rows)));
    };
    if (!scales()) {
      const DitheredRotation dithered(method_.rotation);
      grid_.each_cell([&](int cell, const std::array<int, D> &rows) {
        Turn<D> turn;
        if constexpr (D == 2) {
          const double uniform = method_.rotation.draw(random, grid_.number(rows), turn);
          fix(cell, rows, turn);
          turns_[cell] = SingleTurn<D>(turn);
          dithered.set(turns_[cell], uniform);
        } else {
          method_.rotation.draw(random, grid_.number(rows), turn);
          fix(cell, rows, turn);
          turns_[cell] = SingleTurn<D>(turn);
        }
      });
      return;
    }
    wide_turns_.resize(grid_.cells());
    grid_.each_cell([&](int cell, const std::array<int, D> &rows) {
      method_.rotation.draw(random, grid_.number(rows), wide_turns_[cell]);
      fix(cell, rows, wide_turns_[cell]);
    });
    Collision<D> collision{grid_, random, sums_, wide_turns_, processes_};
    thermostat->scale(collision);
    for (int cell = 0; cell < grid_.cells(); ++cell)
      turns_[cell] = SingleTurn<D>(wide_turns_[cell]);
  }

  void make_double_turns(const CounterRandom &random)
  {
    grid_.each_cell([&](int cell, const std::array<int, D> &rows) {
      method_.rotation.draw(random, grid_.number(rows), turns_[cell]);
      fix_point<D>(turns_[cell], sums_.mean(cell));
    });
    if (!method_.walls) return;
    const auto &walls = *method_.walls;
    grid_.each_cell([&](int cell, const std::array<int, D> &rows) {
      if (const auto cut = walls.cutting(grid_, rows); cut.count > 0)
        fix_point<D>(turns_[cell],
                     walls.mean_of_cut(cut, sums_, cell, random, grid_.number(rows)));
    });
  }

  Grid<D> grid_;
  Method<D> method_;
  Processes &processes_;
  Fluid<D, Real> fluid_;
  double particles_ = 0;             // of all processes
  std::uint64_t collisions_ = 0;
  CellSums<D> sums_;
  Array<KeptTurn> turns_;      // of the last collision
  Array<Turn<D>> wide_turns_;  // in single precision, before they are rounded for a thermostat
  bool turning_ = false;             // whether they are still to be applied
  std::vector<int> strays_;          // indices of particles in no cell of this process
  std::vector<int> held_;            // particles that have met colloids
  std::vector<Particle<D>> travelling_;
  std::vector<Flight<D>> landed_;
  TileOrder<D, Real> tiles_;
};

}    // namespace mpc

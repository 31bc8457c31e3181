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
#include "double.h"
#include "flow.h"
#include "lanes.h"
#include "migration.h"
#include "moments.h"
#include "profile.h"
#include "random_solvent.h"
#include "single.h"
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

  // Make room for the fluid as it was after so many collisions; then add all particles, in
  // whichever order, and count them: each process keeps its own.
  virtual void reset(std::uint64_t collisions, const std::array<int, D> &lower,
                     const std::array<int, D> &upper) = 0;
  virtual void add(Particle<D>) = 0;
  virtual void count() = 0;

  // Take over other cells, between intervals.
  virtual void redistribute(const std::array<int, D> &lower, const std::array<int, D> &upper) = 0;

  virtual void begin_interval(const std::vector<Colloid<D>> &, double colloid_speed) = 0;
  virtual void end_interval(const std::vector<Colloid<D>> & = {}) = 0;

  // Let the coupling know the forces between intervals; nothing moves.
  virtual void find_near(const std::vector<Colloid<D>> &, double colloid_speed) = 0;

  // Velocities as they are after the last collision. Then this process's particles may be seen.
  virtual void turn() = 0;
  virtual int size() const = 0;
  virtual std::uint64_t number(int) const = 0;
  virtual Particle<D> particle(int) const = 0;

  // Of all processes.
  virtual Vector<D> momentum() = 0;
  virtual std::vector<Layer> layers(int bins) = 0;
  virtual Moments<D> moments() = 0;

  // That the walls have taken up in the last interval and its collision, of all processes.
  virtual FaceVectors<D> momentum_of_walls() = 0;

  virtual void look(FlowSums<D> &, const Vector<D> &origin) = 0;
  virtual void zero_momentum() = 0;
  virtual void add_velocity(const Vector<D> &) = 0;

  virtual double memory() const = 0;    // in bytes, on this process
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
  std::uint64_t number(int i) const override { return fluid_.number(i); }
  Particle<D> particle(int i) const override { return fluid_.particle(i); }

  void reset(std::uint64_t collisions, const std::array<int, D> &lower,
             const std::array<int, D> &upper) override
  {
    fluid_.clear();
    turning_ = redrawing_ = false;
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

  void turn() override
  {
    renew(0, fluid_.size());
    turning_ = redrawing_ = false;
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
      for (auto &component : fluid_.v[a]) component = static_cast<Real>(component + change[a]);
  }

  Vector<D> momentum() override
  {
    turn();
    Vector<D> total{};
    for (int a = 0; a < D; ++a) {
      const auto *v = fluid_.v[a].data();
      const auto term = [=](int i) { return std::array<double, 1>{v[i]}; };
      total[a] = sum_in_lanes<1>(fluid_.size(), term)[0];
    }
    processes_.sum(total.data(), D);
    return total;
  }

  std::vector<Layer> layers(int bins) override
  {
    turn();
    return mpc::layers(fluid_, grid_, bins, processes_);
  }

  Moments<D> moments() override
  {
    turn();
    return mpc::moments(fluid_, processes_);
  }

  void look(FlowSums<D> &sums, const Vector<D> &origin) override
  {
    turn();
    sums.look(fluid_, grid_, origin);
  }

  FaceVectors<D> momentum_of_walls() override
  {
    FaceVectors<D> total{};
    if (method_.walls) total = method_.walls->taken();
    processes_.sum(total[0].data(), 2 * D * D);
    return total;
  }

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
    if (method_.walls) method_.walls->forget();
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

  double memory() const override
  {
    return fluid_.bytes() + sums_.bytes() + turns_.capacity() * 1.0 * sizeof(KeptTurn) +
        exact_turns_.capacity() * 1.0 * sizeof(Turn<D>) + tiles_.bytes() +
        (method_.random_solvent ? method_.random_solvent->bytes() : 0);
  }

 private:
  static constexpr bool single = Fluid<D, Real>::single;
  using KeptTurn = std::conditional_t<single, SingleTurn<D>, Turn<D>>;

  static constexpr int BLOCK = 512;           // particles; their state fits the first-level cache
  static constexpr int SORT_INTERVAL = 64;    // collisions, in which a particle moves a few cells
  static constexpr int STRAY = -1, TAKEN = -2;    // instead of a cell

  bool reflecting() const { return method_.coupling && method_.coupling->after_flight(); }

  // Where colloids join, it is by the collision that they meet even a fluid to be redrawn.
  bool joining() const { return method_.coupling && method_.coupling->in_collision(); }

  bool collides() const
  {
    return joining() || !method_.random_solvent || !method_.random_solvent->replaces_collision();
  }

  // Whether a thermostat changes what turns do, and needs the squares of the velocities.
  bool scales() const { return method_.thermostat && !method_.thermostat->redraws(); }

  // All that the coupling does not take, to the end of the interval and into the sums of the cells.
  void move()
  {
    auto *coupling = method_.coupling.get();
    if (collides()) sums_.clear();
    strays_.clear();
    held_.clear();
    for (int begin = 0; begin < fluid_.size(); begin += BLOCK) {
      const int end = std::min(begin + BLOCK, fluid_.size());
      renew(begin, end);
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
    turning_ = redrawing_ = false;
  }

  void set_cells(const std::array<int, D> &lower, const std::array<int, D> &upper)
  {
    grid_.lower = lower;
    grid_.upper = upper;
    sums_.of.assign(grid_.cells(), {});
    if (D == 3 && scales()) sums_.squares.assign(grid_.cells(), 0);
    sums_.guests.clear();
    turns_.assign(grid_.cells(), {});
    if constexpr (single) {
      fluid_.places = places_of(grid_);
      if (scales()) exact_turns_.assign(grid_.cells(), {});
    }
  }

  void draw_shift(std::uint64_t collision)
  {
    if (!method_.shifted) return;
    grid_.draw_shift({method_.seed, collision});
    if constexpr (single) round_shift(grid_);
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

  void renew(int begin, int end)
  {
    if (turning_) turn(begin, end);
    if constexpr (!single)
      if (redrawing_) method_.random_solvent->redraw(fluid_, begin, end);
  }

  void turn(int begin, int end) { mpc::turn<D>(fluid_, turns_, begin, end); }

  void fly(int begin, int end)
  {
    const auto *walls = method_.walls.get();
    try {
      if constexpr (single)
        mpc::fly<D>(fluid_, grid_, method_.field, kick(), method_.interval, walls, begin, end);
      else
        mpc::fly<D>(fluid_, method_.field, method_.interval, walls, begin, end);
    } catch (const TooManyBounces &bounces) {
      throw bounces.fault(fluid_.number(bounces.index));
    }
  }

  // What the field adds to velocities in this interval.
  Vector<D> kick() const
  {
    Vector<D> kick;
    for (int a = 0; a < D; ++a)
      kick[a] = dithered(method_.interval * method_.field[a], digit_, collisions_);
    return kick;
  }

  // Strays may be in a cell of this process after all: sum() looks closer.
  void sort(int begin, int end)
  {
    if constexpr (single)
      find_cells<D>(fluid_, grid_, method_.interval, begin, end, STRAY);
    else
      find_cells<D>(fluid_, grid_, begin, end, STRAY);
  }

  void sum(int begin, int end)
  {
    const auto *cell = fluid_.cell.data();
    if (!collides()) {
      for (int i = begin; i < end; ++i)
        if (cell[i] < 0) settle(i);
      return;
    }
    constexpr int line = CACHE_LINE / sizeof(Real);
    if constexpr (single) {
      const AddFour<D> add_four(fluid_, sums_);
      for (int i = begin; i < end; i += 4) {
        if (i % line == 0) prefetch_state(i + BLOCK);    // of the next block
        if (i + 4 <= end && (cell[i] | cell[i + 1] | cell[i + 2] | cell[i + 3]) >= 0)
          add_four(i);
        else
          for (int k = i; k < std::min(i + 4, end); ++k)
            if (cell[k] >= 0 || settle(k)) add(k);
      }
    } else {
      for (int i = begin; i < end; ++i) {
        if (i % line == 0) prefetch_state(i + BLOCK);
        if constexpr (D == 3) prefetch(sums_.of, fluid_.cell, i);
        if (cell[i] >= 0 || settle(i)) add(i);
      }
    }
  }

  // To the sums of its cell.
  void add(int i) { sums_.add(fluid_.cell[i], fluid_.velocity(i)); }

  // Whether a stray is in a cell of this process after all.
  bool settle(int i)
  {
    if (fluid_.cell[i] == TAKEN) return false;
    fluid_.cell[i] = find(i);
    if (fluid_.cell[i] < 0) strays_.push_back(i);
    return fluid_.cell[i] >= 0;
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
  // goes there, and may be reflected there. A round has the next contact of every particle.
  void reflect()
  {
    auto &coupling = *method_.coupling;
    std::vector<std::pair<int, Flight<D>>> flying;    // with their index
    std::vector<Flight<D>> visiting, leaving;
    for (int i : held_) flying.push_back({i, {fluid_.particle(i), method_.interval, 0}});
    for (int i : strays_) visiting.push_back({fluid_.particle(i), method_.interval, 0});
    bring_home<D>(visiting, grid_, processes_);
    for (auto &flight : visiting) coupling.announce(flight, locate(flight));

    while (processes_.any(!flying.empty() || !visiting.empty())) {
      coupling.decide(processes_);
      std::size_t left = 0;
      for (auto &[i, flight] : flying) {
        const bool reflected = coupling.reflect_next(flight);
        const int cell = locate(flight);
        if (cell < 0) {
          strays_.push_back(i);
          leaving.push_back(flight);
        } else if (reflected) {
          flying[left++] = {i, flight};
        } else {
          land(flight, i, cell);
        }
      }
      flying.resize(left);
      for (auto &flight : visiting) {
        const bool reflected = coupling.reflect_next(flight);
        locate(flight);
        (reflected ? leaving : landed_).push_back(flight);
      }
      visiting = std::move(leaving);
      leaving.clear();
      bring_home<D>(visiting, grid_, processes_);
      for (auto &[i, flight] : flying) coupling.announce(flight, locate(flight));
      for (auto &flight : visiting) coupling.announce(flight, locate(flight));
    }
    travelling_.assign(landed_.begin(), landed_.end());
    landed_.clear();
  }

  // At the end of its way, in a cell of this process.
  void land(const Flight<D> &flight, int i, int cell)
  {
    for (int a = 0; a < D; ++a) {
      fluid_.set_position(a, i, flight.x[a]);
      fluid_.v[a][i] = static_cast<Real>(flight.v[a]);
    }
    fluid_.cell[i] = cell;
    add(i);
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
        throw Fault("fluid particle " + std::to_string(fluid_.number(i)) + " has " + "xyz"[a] + " = " +
                    std::to_string(x[a]) + " and v" + "xyz"[a] + " = " +
                    std::to_string(fluid_.v[a][i]) +
                    ": not a number, or beyond a wall; the time step is too long");
      if (single && std::abs(fluid_.v[a][i]) * method_.interval >= LONGEST_FLIGHT * grid_.edge)
        throw Fault("precision single: fluid particle " + std::to_string(fluid_.number(i)) +
                    " has v" + "xyz"[a] + " = " + std::to_string(fluid_.v[a][i]) +
                    ": it flies further than " +
                    std::to_string(static_cast<int>(LONGEST_FLIGHT)) + " cells");
    }
    return grid_.local(x);
  }

  void migrate()
  {
    bring_home<D>(travelling_, grid_, processes_);
    for (const auto &particle : travelling_) {
      fluid_.append(particle, grid_.local(particle.x));
      add(fluid_.size() - 1);
    }
    travelling_.clear();
  }

  void collide(const std::vector<Colloid<D>> &colloids)
  {
    const CounterRandom random{method_.seed, collisions_};
    auto *coupling = method_.coupling.get();
    auto *thermostat = method_.thermostat.get();
    if (collides()) {
      if (joining()) coupling->join(grid_, colloids, sums_, processes_);
      make_turns(random);
      if (scales()) scale_turns(random);
      turning_ = true;
      if (thermostat && thermostat->redraws()) {
        turn();
        thermostat->redraw(fluid_, random);
      }
      for (const auto &[cell, cut] : cut_) method_.walls->take(cut, lost(cell));
      if constexpr (!single)
        if (joining()) coupling->turn(turns_, processes_);
    }
    if constexpr (!single)
      if (method_.random_solvent) begin_redrawing(random);
    ++collisions_;
  }

  // Of each cell; in single precision rounded at once where no thermostat is to scale them.
  void make_turns(const CounterRandom &random)
  {
    cut_.clear();
    const auto words = random.mixed(Stream::Rotation);
    const auto *walls = method_.walls.get();
    const bool alike = walls && !walls->across(0);    // all cells side by side along the first axis
    Cut<D> cut;
    const auto make = [&](int cell, const std::array<int, D> &rows, Turn<D> &turn) {
      const auto number = grid_.number(rows);
      method_.rotation.draw(words, number, turn);
      fix_point<D>(turn, sums_.mean(cell));
      if (!walls) return;
      if (!alike || rows[0] == grid_.lower[0]) cut = walls->cutting(grid_, rows);
      if (cut.count == 0) return;
      fix_point<D>(turn, walls->mean_of_cut(cut, sums_, cell, random, number));
      cut_.push_back({cell, cut});
    };
    grid_.each_cell([&](int cell, const std::array<int, D> &rows) {
      if constexpr (!single) {
        make(cell, rows, turns_[cell]);
      } else if (scales()) {
        make(cell, rows, exact_turns_[cell]);
      } else {
        Turn<D> turn;
        make(cell, rows, turn);
        turns_[cell] = {turn, words.word(3, grid_.number(rows)) & FINER};
      }
    });
  }

  void scale_turns(const CounterRandom &random)
  {
    const auto scale = [&](Array<Turn<D>> &turns) {
      Collision<D> collision{grid_, random, sums_, turns, processes_};
      method_.thermostat->scale(collision);
    };
    if constexpr (single) {
      scale(exact_turns_);
      for (int cell = 0; cell < grid_.cells(); ++cell)
        turns_[cell] = {exact_turns_[cell], NEAREST};
    } else {
      scale(turns_);
    }
  }

  void begin_redrawing(const CounterRandom &random)
  {
    auto &solvent = *method_.random_solvent;
    solvent.begin(fluid_, random, particles_);
    if (!solvent.replaces_collision())
      for (int begin = 0; begin < fluid_.size(); begin += BLOCK) {
        const int end = std::min(begin + BLOCK, fluid_.size());
        if (turning_) turn(begin, end);
        solvent.collect(fluid_, begin, end);
      }
    solvent.share(processes_);
    turning_ = false;
    redrawing_ = true;
  }

  // Momentum that what is in a cell loses in its turn.
  Vector<D> lost(int cell) const
  {
    const auto mean = sums_.mean(cell), after = turns_[cell].apply(mean);
    Vector<D> lost;
    for (int a = 0; a < D; ++a) lost[a] = sums_.mass(cell) * (mean[a] - after[a]);
    return lost;
  }

  Grid<D> grid_;
  Method<D> method_;
  Processes &processes_;
  Fluid<D, Real> fluid_;
  double particles_ = 0;             // of all processes
  std::uint64_t collisions_ = 0;
  CellSums<D> sums_;
  Array<KeptTurn> turns_;            // of the last collision
  Array<Turn<D>> exact_turns_;       // before a thermostat's are rounded to single
  std::vector<std::pair<int, Cut<D>>> cut_;    // cells that walls cut
  bool turning_ = false;             // whether they are still to be applied
  bool redrawing_ = false;           // and whether the random solvent is to redraw after them
  std::vector<int> strays_;          // indices of particles in no cell of this process
  std::vector<int> held_;            // particles that have met colloids
  std::vector<Particle<D>> travelling_;
  std::vector<Flight<D>> landed_;
  TileOrder<D, Real> tiles_;
  const double digit_ = last_digit(method_.thermal_speed);
};

}    // namespace mpc

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
#include "lanes.h"
#include "migration.h"
#include "random_solvent.h"
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
};

template <int D> class Solver {
 public:
  Solver(Grid<D> grid, Method<D> method, Processes &processes)
    : grid_(grid), method_(std::move(method)), processes_(processes)
  {
  }

  const Grid<D> &grid() const { return grid_; }
  const Fluid<D> &fluid() const { return fluid_; }
  Coupling<D> *coupling() const { return method_.coupling.get(); }
  std::uint64_t collisions() const { return collisions_; }
  double particles() const { return particles_; }

  // Make room for the fluid as it was after so many collisions; then add all particles, in
  // whichever order, and count them: each process keeps its own.
  void reset(std::uint64_t collisions, const std::array<int, D> &lower,
             const std::array<int, D> &upper)
  {
    fluid_.clear();
    turning_ = redrawing_ = false;
    collisions_ = collisions;
    set_cells(lower, upper);
    grid_.shift = {};
    if (collisions > 0) draw_shift(collisions - 1);
  }

  void add(Particle<D> particle)
  {
    for (int a = 0; a < D; ++a) particle.x[a] = wrapped<D>(grid_, a, particle.x[a]);
    const int cell = grid_.local(particle.x);
    if (cell >= 0) fluid_.append(particle, cell);
  }

  void count()
  {
    particles_ = fluid_.size();
    processes_.sum(&particles_, 1);
  }

  // Take over other cells, between intervals.
  void redistribute(const std::array<int, D> &lower, const std::array<int, D> &upper)
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
  void turn()
  {
    renew(0, fluid_.size());
    turning_ = redrawing_ = false;
  }

  void zero_momentum()
  {
    Vector<D> mean = momentum();
    for (int a = 0; a < D; ++a)
      for (double &component : fluid_.v[a]) component -= mean[a] / particles_;
  }

  void add_velocity(const Vector<D> &change)
  {
    turn();
    for (int a = 0; a < D; ++a)
      for (double &component : fluid_.v[a]) component += change[a];
  }

  // Of all processes.
  Vector<D> momentum()
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

  // That the walls have taken up in the last interval and its collision, of all processes.
  FaceVectors<D> momentum_of_walls()
  {
    FaceVectors<D> total{};
    if (method_.walls) total = method_.walls->taken();
    processes_.sum(total[0].data(), 2 * D * D);
    return total;
  }

  // Let the coupling know the forces between intervals; nothing moves.
  void find_near(const std::vector<Colloid<D>> &colloids, double colloid_speed)
  {
    turn();
    method_.coupling->begin(grid_, colloids, colloid_speed);
    method_.coupling->take(fluid_, 0, fluid_.size());
    method_.coupling->ready();
  }

  void begin_interval(const std::vector<Colloid<D>> &colloids, double colloid_speed)
  {
    if (collisions_ % SORT_INTERVAL == 0) tiles_.sort(fluid_, grid_);
    if (method_.walls) method_.walls->forget();
    auto *coupling = method_.coupling.get();
    if (coupling) coupling->begin(grid_, colloids, colloid_speed);
    draw_shift(collisions_);
    if (!reflecting()) move();
    if (coupling) coupling->ready();
  }

  void end_interval(const std::vector<Colloid<D>> &colloids = {})
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
  double memory() const
  {
    return fluid_.bytes() + sums_.of.capacity() * (1.0 * sizeof(CellSum<D>) + sizeof(Turn<D>)) +
        tiles_.bytes() + (method_.random_solvent ? method_.random_solvent->bytes() : 0);
  }

 private:
  static constexpr int BLOCK = 512;           // particles; their state fits the first-level cache
  static constexpr int AHEAD = 32;            // particles
  static constexpr int SORT_INTERVAL = 64;    // collisions, in which a particle moves a few cells
  static constexpr int STRAY = -1, TAKEN = -2;    // instead of a cell

  bool reflecting() const { return method_.coupling && method_.coupling->after_flight(); }

  // Where colloids join, it is by the collision that they meet even a fluid to be redrawn.
  bool joining() const { return method_.coupling && method_.coupling->in_collision(); }

  bool collides() const
  {
    return joining() || !method_.random_solvent || !method_.random_solvent->replaces_collision();
  }

  // All that the coupling does not take, to the end of the interval and into the sums of the cells.
  void move()
  {
    auto *coupling = method_.coupling.get();
    if (collides()) std::fill(sums_.of.begin(), sums_.of.end(), CellSum<D>{});
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
    sums_.guests.clear();
    turns_.assign(grid_.cells(), {});
  }

  void draw_shift(std::uint64_t collision)
  {
    if (method_.shifted) grid_.draw_shift({method_.seed, collision});
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

  void renew(int begin, int end)
  {
    if (turning_) turn(begin, end);
    if (redrawing_) method_.random_solvent->redraw(fluid_, begin, end);
  }

  void turn(int begin, int end)
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
    std::array<double *, D> x, v;
    for (int a = 0; a < D; ++a) {
      x[a] = fluid_.x[a].data();
      v[a] = fluid_.v[a].data();
    }
    try {
      stream<D>(x, v, Field<D>{method_.field}, method_.interval, method_.walls.get(), begin,
                end);
    } catch (const TooManyBounces &bounces) {
      throw bounces.fault(fluid_.number(bounces.index));
    }
  }

  // Wrap and find the cells. Whoever is in none of this process's cells, has flown further than the
  // box, or is nowhere, becomes a stray; sum() looks closer.
  void sort(int begin, int end)
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
    if (!collides()) {
      for (int i = begin; i < end; ++i)
        if (fluid_.cell[i] < 0) settle(i);
      return;
    }
    constexpr int line = CACHE_LINE / sizeof(double);
    for (int i = begin; i < end; ++i) {
      if (i % line == 0) prefetch_state(i + BLOCK);    // of the next block
      if constexpr (D == 3) prefetch(sums_.of, i);
      if (fluid_.cell[i] >= 0 || settle(i)) add_to(sums_.of[fluid_.cell[i]], i);
    }
  }

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
    method_.coupling->watch(fluid_, begin, end, held_);
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
      fluid_.x[a][i] = flight.x[a];
      fluid_.v[a][i] = flight.v[a];
    }
    fluid_.cell[i] = cell;
    add_to(sums_.of[cell], i);
  }

  int locate(Flight<D> &flight) const
  {
    for (int a = 0; a < D; ++a) flight.x[a] = wrapped<D>(grid_, a, flight.x[a]);
    return grid_.local(flight.x);
  }

  void add_to(CellSum<D> &sum, int i)
  {
    if constexpr (D == 2)
      sum.add(fluid_.v[0][i], fluid_.v[1][i]);
    else
      sum.add(fluid_.v[0][i], fluid_.v[1][i], fluid_.v[2][i]);
  }

  // The cell of a stray, if it is this process's after all.
  int find(int i)
  {
    Vector<D> x;
    for (int a = 0; a < D; ++a) {
      x[a] = fluid_.x[a][i] = wrapped<D>(grid_, a, fluid_.x[a][i]);
      const bool inside = x[a] >= 0 && x[a] <= grid_.box[a];
      if (!inside || !std::isfinite(fluid_.v[a][i]))
        throw Fault("fluid particle " + std::to_string(fluid_.number(i)) + " has " + "xyz"[a] + " = " +
                    std::to_string(x[a]) + " and v" + "xyz"[a] + " = " +
                    std::to_string(fluid_.v[a][i]) +
                    ": not a number, or beyond a wall; the time step is too long");
    }
    return grid_.local(x);
  }

  void migrate()
  {
    bring_home<D>(travelling_, grid_, processes_);
    for (const auto &particle : travelling_) {
      fluid_.append(particle, grid_.local(particle.x));
      add_to(sums_.of[fluid_.cell.back()], fluid_.size() - 1);
    }
    travelling_.clear();
  }

  void collide(const std::vector<Colloid<D>> &colloids)
  {
    const CounterRandom random{method_.seed, collisions_};
    auto *coupling = method_.coupling.get();
    auto *solvent = method_.random_solvent.get();
    auto *thermostat = method_.thermostat.get();
    if (collides()) {
      if (joining()) coupling->join(grid_, colloids, sums_, processes_);
      make_turns(random);
      turning_ = true;
      if (thermostat) {
        Collision<D> collision{grid_, random, sums_, turns_, processes_};
        thermostat->scale(collision);
        if (thermostat->redraws()) {
          turn();
          thermostat->redraw(fluid_, random);
        }
      }
      for (const auto &[cell, cut] : cut_) method_.walls->take(cut, lost(cell));
      if (joining()) coupling->turn(turns_, processes_);
    }
    if (solvent) {
      solvent->begin(fluid_, random, particles_);
      if (!solvent->replaces_collision())
        for (int begin = 0; begin < fluid_.size(); begin += BLOCK) {
          const int end = std::min(begin + BLOCK, fluid_.size());
          if (turning_) turn(begin, end);
          solvent->collect(fluid_, begin, end);
        }
      solvent->share(processes_);
      turning_ = false;
      redrawing_ = true;
    }
    ++collisions_;
  }

  void make_turns(const CounterRandom &random)
  {
    const auto words = random.mixed(Stream::Rotation);
    grid_.each_cell([&](int cell, const std::array<int, D> &rows) {
      method_.rotation.draw(words, grid_.number(rows), turns_[cell]);
      fix_point<D>(turns_[cell], sums_.mean(cell));
    });
    cut_.clear();
    if (!method_.walls) return;
    const auto &walls = *method_.walls;
    const bool alike = !walls.across(0);    // all cells side by side along the first axis
    Cut<D> cut;
    grid_.each_cell([&](int cell, const std::array<int, D> &rows) {
      if (!alike || rows[0] == grid_.lower[0]) cut = walls.cutting(grid_, rows);
      if (cut.count == 0) return;
      fix_point<D>(turns_[cell], walls.mean_of_cut(cut, sums_, cell, random, grid_.number(rows)));
      cut_.push_back({cell, cut});
    });
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
  Fluid<D> fluid_;
  double particles_ = 0;             // of all processes
  std::uint64_t collisions_ = 0;
  CellSums<D> sums_;
  Array<Turn<D>> turns_;       // of the last collision
  std::vector<std::pair<int, Cut<D>>> cut_;    // cells that walls cut
  bool turning_ = false;             // whether they are still to be applied
  bool redrawing_ = false;           // and whether the random solvent is to redraw after them
  std::vector<int> strays_;          // indices of particles in no cell of this process
  std::vector<int> held_;            // particles that have met colloids
  std::vector<Particle<D>> travelling_;
  std::vector<Flight<D>> landed_;
  TileOrder<D> tiles_;
};

}    // namespace mpc

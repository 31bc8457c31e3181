// Colloids that repel the fluid by a 12-6 potential, cut at its minimum, at every MD step
// (tabatabaei-2009, 3.42, 3.45, 3.46, 3.50 to 3.52).
//
// Who must be taken, exactly: a particle outside the cutoff feels no force, so until it comes
// within it flies at constant speed (and gains field * time, and what a moving wall adds). A
// particle that cannot come within the cutoff of any colloid at that speed before the interval
// ends, while no colloid moves further than its allowance, flies free all the way. The allowance is
// checked at every force evaluation.
//
// A taken particle may become faster. It is paired with every colloid it could reach at PAIR_SPEED;
// from when it is faster than CHECKED_SPEED, with all.

#pragma once

#include "coupling.h"
#include "streaming.h"

#include <cstdio>

namespace mpc {

template <int D> class ForceCoupling : public Coupling<D> {
 public:
  ForceCoupling(double interval, double temperature, const Vector<D> &field,
                const Walls<D> *walls)
    : interval_(interval), thermal_speed_(std::sqrt(temperature)),
      usual_(square_of(CHECKED_SPEED * thermal_speed_)), field_(field),
      gain_(std::sqrt(square<D>(field)) * interval + (walls ? walls->gain() : 0)), walls_(walls)
  {
  }

  static double cutoff(double sigma) { return 1.122462048309373 * sigma; }    // 2^(1/6)

  double reach(double largest_sigma) const override
  {
    return cutoff(largest_sigma) + interval_ * (flight_speed(PAIR_SPEED * thermal_speed_));
  }

  void begin(const Grid<D> &grid, const std::vector<Colloid<D>> &colloids, double speed) override
  {
    grid_ = grid;
    colloids_ = colloids;
    allowance_ = interval_ * speed;
    taken_.clear();
    candidates_.clear();
    seconds_.clear();

    ranges_.clear();
    for (const auto &colloid : colloids)
      ranges_.push_back({cutoff(colloid.sigma), square_of(pair_reach(colloid))});
    for (int a = 0; a < D; ++a) turns_per_length_[a] = grid.periodic[a] ? 1 / grid.box[a] : 0.0;

    head_.assign(grid.cells(), -1);
    entries_.clear();
    for (int c = 0; c < static_cast<int>(colloids.size()); ++c) list_cells(c);
  }

  void take(const Fluid<D> &fluid, int begin, int end) override
  {
    listed_.resize(end - begin);
    int listed = 0;    // a list without branches: who is in it follows no pattern
    for (int i = begin; i < end; ++i) {
      double speed = 0;
      for (int a = 0; a < D; ++a) speed += fluid.v[a][i] * fluid.v[a][i];
      listed_[listed] = i;
      listed += (head_[fluid.cell[i]] >= 0) | (speed > usual_);
    }
    for (int k = 0; k < listed; ++k) consider(fluid, listed_[k]);
  }

  const std::vector<int> &taken() const override { return taken_; }

  // Sort what was taken by colloid, and find the forces on it.
  void ready() override
  {
    const int colloids = static_cast<int>(colloids_.size());
    start_.assign(colloids + 1, 0);
    for (const auto &candidate : candidates_) ++start_[candidate.colloid + 1];
    for (int c = 0; c < colloids; ++c) start_[c + 1] += start_[c];

    const int count = static_cast<int>(candidates_.size());
    taken_.resize(count);
    ids_.resize(count);
    with_all_.assign(count, false);
    for (int a = 0; a < D; ++a)
      for (auto *values : {&x_[a], &v_[a], &old_[a], &new_[a], &pull_[a]}) values->resize(count);
    auto next = start_;
    place_.resize(count);
    for (int k = 0; k < count; ++k) {
      const auto &candidate = candidates_[k];
      const int at = place_[k] = next[candidate.colloid]++;
      taken_[at] = candidate.index;
      ids_[at] = candidate.particle.id;
      for (int a = 0; a < D; ++a) {
        x_[a][at] = candidate.particle.x[a];
        v_[a][at] = candidate.particle.v[a];
      }
    }
    for (auto &pair : seconds_) pair.particle = place_[pair.particle];

    std::vector<Vector<D>> unused(colloids);
    forces(colloids_, unused);
    std::swap(old_, new_);
    pair_fast();
  }

  void drift(double time) override
  {
    std::array<double *, D> x, v;
    PerParticle<D> acceleration;
    for (int a = 0; a < D; ++a) {
      x[a] = x_[a].data();
      v[a] = v_[a].data();
      acceleration.values[a] = old_[a].data();
    }
    try {
      stream<D>(x, v, acceleration, time, walls_, 0, static_cast<int>(taken_.size()));
    } catch (const TooManyBounces &bounces) {
      throw Fault(bounce_message(ids_[bounces.index]));
    }
  }

  void forces(const std::vector<Colloid<D>> &colloids, std::vector<Vector<D>> &on_colloids) override
  {
    for (int c = 0; c < static_cast<int>(colloids.size()); ++c) {
      check_allowance(colloids[c], colloids_[c]);
      on_colloids[c] = force_of(colloids[c], start_[c], start_[c + 1]);
    }
    for (const auto &pair : seconds_) {
      const auto &colloid = colloids[pair.colloid];
      Vector<D> separation;
      for (int a = 0; a < D; ++a) separation[a] = x_[a][pair.particle] - colloid.x[a];
      const double r2 = square<D>(separation);
      if (!(r2 > square_of(CORE * colloid.sigma))) fault_in_core(pair.particle, colloid, r2);
      const double strength = force_over_distance(colloid, r2);
      for (int a = 0; a < D; ++a) {
        new_[a][pair.particle] += strength * separation[a];
        on_colloids[pair.colloid][a] -= strength * separation[a];
      }
    }
  }

  // Streaming, bounces included, has added the whole of the old acceleration.
  void kick(double time) override
  {
    const int count = static_cast<int>(taken_.size());
    for (int a = 0; a < D; ++a) {
      double *__restrict v = v_[a].data();
      const double *before = old_[a].data(), *after = new_[a].data();
      for (int k = 0; k < count; ++k) v[k] += 0.5 * time * (after[k] - before[k]);
    }
    std::swap(old_, new_);
    pair_fast();
  }

  void give_back(Fluid<D> &fluid) override
  {
    for (int k = 0; k < static_cast<int>(taken_.size()); ++k)
      for (int a = 0; a < D; ++a) {
        fluid.x[a][taken_[k]] = x_[a][k];
        fluid.v[a][taken_[k]] = v_[a][k];
      }
  }

  static std::string bounce_message(double id)
  {
    return "fluid particle " + std::to_string(static_cast<long>(id)) +
        " meets the walls more than " + std::to_string(MOST_BOUNCES) +
        " times in one step: it is too fast, or pressed against a wall";
  }

 private:
  static constexpr double CORE = 0.5;             // of sigma: an energy of 16000 epsilon
  static constexpr double CHECKED_SPEED = 6.0;    // thermal speeds; e^-18 are faster
  static constexpr double PAIR_SPEED = 7.0;       // room for what one step adds to the checked
  static constexpr int LANES = 8;

  struct Candidate {
    int index, colloid;
    Particle<D> particle;
  };
  struct Pair {
    int particle, colloid;
  };
  struct Entry {
    int colloid, next;
  };
  struct Range {
    double cutoff, square_reach;    // of the force, and of pairing squared
  };

  static double square_of(double a) { return a * a; }

  double flight_speed(double speed) const
  {
    return speed + gain_;
  }

  static double force_over_distance(const Colloid<D> &colloid, double r2)
  {
    const double inverse = 1 / r2;
    const double ratio = colloid.sigma * colloid.sigma * inverse;
    const double u = ratio * ratio * ratio;
    const double strength = 24 * colloid.epsilon * (2 * u * u - u) * inverse;
    return r2 < square_of(cutoff(colloid.sigma)) ? strength : 0.0;
  }

  double pair_reach(const Colloid<D> &colloid) const
  {
    return reach(colloid.sigma) + allowance_;
  }

  // Enter a colloid at all cells from which a particle could be paired with it.
  void list_cells(int c)
  {
    const auto &x = colloids_[c].x;
    const double radius = pair_reach(colloids_[c]);
    std::array<int, D> first, last;
    for (int a = 0; a < D; ++a) {
      const auto row = [&](double at) {
        return static_cast<int>(std::floor(at / grid_.edge + grid_.shift[a]));
      };
      first[a] = std::max(row(x[a] - radius), grid_.lower[a]);
      last[a] = std::min(row(x[a] + radius), grid_.upper[a] - 1);
      if (first[a] > last[a]) return;
    }
    auto rows = first;
    for (;;) {
      double distance = 0;    // of the colloid to the cell, squared
      int cell = 0;
      for (int a = D - 1; a >= 0; --a) {
        const double beyond =
            std::abs(x[a] - grid_.centre(a, rows[a])) - 0.5 * grid_.edge * (1 + 1e-9);
        if (beyond > 0) distance += beyond * beyond;
        cell = cell * grid_.extent(a) + rows[a] - grid_.lower[a];
      }
      if (distance < radius * radius) {
        entries_.push_back({c, head_[cell]});
        head_[cell] = static_cast<int>(entries_.size()) - 1;
      }
      int a = 0;
      while (a < D && ++rows[a] > last[a]) {
        rows[a] = first[a];
        ++a;
      }
      if (a == D) return;
    }
  }

  // Take a particle if it could come within a cutoff, and pair it. Its cell lists the images of
  // colloids that are near; a fast one meets all images, and so must itself be the one in its cell.
  void consider(const Fluid<D> &fluid, int i)
  {
    auto particle = fluid.particle(i);
    const double square_speed = square<D>(particle.v);
    const bool fast = square_speed > usual_;
    if (fast) bring_into_cell(particle.x, fluid.cell[i]);
    const auto before = seconds_.size();
    const int number = static_cast<int>(candidates_.size());
    bool within = false;
    int nearest = -1;
    double least = std::numeric_limits<double>::infinity();
    const auto meet = [&](int c) {
      double r2 = 0;
      for (int a = 0; a < D; ++a) {
        const double separation = particle.x[a] - colloids_[c].x[a];
        r2 += square_of(fast ? separation : separation - turns(a, separation) * grid_.box[a]);
      }
      const auto &range = ranges_[c];
      const bool paired = r2 < range.square_reach;
      if (!paired && !fast) return;
      const double travel = allowance_ + interval_ * flight_speed(std::sqrt(square_speed));
      within |= r2 < square_of(range.cutoff + travel);
      if (!paired) return;
      if (nearest >= 0) seconds_.push_back({number, r2 < least ? nearest : c});
      if (r2 < least) {
        nearest = c;
        least = r2;
      }
    };
    if (fast) {
      for (int c = 0; c < static_cast<int>(colloids_.size()); ++c) meet(c);
      if (within && nearest < 0) nearest = 0;    // pair_fast pairs it with the rest
    } else {
      for (int e = head_[fluid.cell[i]]; e >= 0; e = entries_[e].next) meet(entries_[e].colloid);
    }
    if (!within) {
      seconds_.resize(before);
      return;
    }
    if (!fast)
      for (int a = 0; a < D; ++a)
        particle.x[a] -= turns(a, particle.x[a] - colloids_[nearest].x[a]) * grid_.box[a];
    candidates_.push_back({i, nearest, particle});
    taken_.push_back(i);
  }

  // Whole boxes in a separation.
  double turns(int axis, double separation) const
  {
    return std::rint(separation * turns_per_length_[axis]);
  }

  void bring_into_cell(Vector<D> &x, int cell) const
  {
    const auto rows = grid_.rows(cell);
    for (int a = 0; a < D; ++a) x[a] -= turns(a, x[a] - grid_.centre(a, rows[a])) * grid_.box[a];
  }

  // Pair the particles that have become fast with all colloids.
  void pair_fast()
  {
    const int count = static_cast<int>(taken_.size());
    int fast = 0;
    for (int k = 0; k < count; ++k) {
      double speed = 0;
      for (int a = 0; a < D; ++a) speed += v_[a][k] * v_[a][k];
      fast += speed > usual_;
    }
    for (int k = 0; fast > 0 && k < count; ++k) {
      double speed = 0;
      for (int a = 0; a < D; ++a) speed += v_[a][k] * v_[a][k];
      if (speed <= usual_) continue;
      --fast;
      if (with_all_[k]) continue;
      with_all_[k] = true;
      std::vector<bool> has(colloids_.size());
      for (const auto &pair : seconds_)
        if (pair.particle == k) has[pair.colloid] = true;
      for (int c = 0; c < static_cast<int>(colloids_.size()); ++c)
        if (!has[c] && !(start_[c] <= k && k < start_[c + 1])) seconds_.push_back({k, c});
    }
  }

  // Forces between a colloid and its own particles first ... last - 1; that on the colloid.
  Vector<D> force_of(const Colloid<D> &colloid, int first, int last)
  {
    const auto of = colloid;    // copies: for all the compiler knows, the loop could write there
    const auto field = field_;
    const double core = square_of(CORE * of.sigma);
    int deep = 0;
    std::array<double *, D> pull, after;
    std::array<const double *, D> x;
    for (int a = 0; a < D; ++a) {
      pull[a] = pull_[a].data();
      after[a] = new_[a].data();
      x[a] = x_[a].data();
    }
#pragma GCC ivdep
    for (int k = first; k < last; ++k) {
      Vector<D> separation;
      double r2 = 0;
      for (int a = 0; a < D; ++a) {
        separation[a] = x[a][k] - of.x[a];
        r2 += separation[a] * separation[a];
      }
      const double strength = force_over_distance(of, r2);
      deep += !(r2 > core);    // true for NaN
      for (int a = 0; a < D; ++a) {
        pull[a][k] = strength * separation[a];
        after[a][k] = strength * separation[a] + field[a];
      }
    }
    if (deep > 0) find_in_core(colloid, first, last);

    Vector<D> total;
    for (int a = 0; a < D; ++a) {
      double lane[LANES] = {};    // independent sums, for the processor's sake
      int k = first;
      for (; k + LANES <= last; k += LANES)
        for (int l = 0; l < LANES; ++l) lane[l] += pull[a][k + l];
      for (; k < last; ++k) lane[0] += pull[a][k];
      total[a] = 0;
      for (double sum : lane) total[a] -= sum;
    }
    return total;
  }

  void check_allowance(const Colloid<D> &now, const Colloid<D> &then) const
  {
    double moved = 0;
    for (int a = 0; a < D; ++a) moved += square_of(now.x[a] - then.x[a]);
    if (moved <= square_of(allowance_)) return;
    char text[200];
    std::snprintf(text, sizeof text,
                  "colloid %.0f moved by %.4g since the last collision, further than the %.4g that "
                  "the choice of near fluid allows: the time step is too long, or a force too strong",
                  now.id, std::sqrt(moved), allowance_);
    throw Fault(text);
  }

  void find_in_core(const Colloid<D> &colloid, int first, int last) const
  {
    for (int k = first; k < last; ++k) {
      double r2 = 0;
      for (int a = 0; a < D; ++a) r2 += square_of(x_[a][k] - colloid.x[a]);
      if (!(r2 > square_of(CORE * colloid.sigma))) fault_in_core(k, colloid, r2);
    }
  }

  [[noreturn]] void fault_in_core(int k, const Colloid<D> &colloid, double r2) const
  {
    char text[200];
    std::snprintf(text, sizeof text,
                  "fluid particle %.0f is %.4g from the centre of colloid %.0f, inside its core: "
                  "the time step is too long",
                  ids_[k], std::sqrt(r2), colloid.id);
    throw Fault(text);
  }

  double interval_, thermal_speed_;
  double usual_;    // square of the checked speed
  Vector<D> field_;
  double gain_;     // of speed in an interval, from the field and the walls
  const Walls<D> *walls_;

  Grid<D> grid_{{}, {}, 1.0};             // as it was when the interval began
  std::vector<Colloid<D>> colloids_;      // as they were
  std::vector<Range> ranges_;             // of each colloid
  Vector<D> turns_per_length_;            // 0 across walls
  double allowance_ = 0;
  std::vector<int> head_;                 // of each cell, its list of entries; -1 for none
  std::vector<Entry> entries_;
  std::vector<Candidate> candidates_;
  std::vector<int> listed_;

  // taken particles, those of one colloid behind each other: colloid c has start_[c] ...
  std::vector<int> taken_, start_, place_;
  std::vector<double> ids_;
  std::array<std::vector<double>, D> x_, v_, old_, new_, pull_;
  std::vector<bool> with_all_;
  std::vector<Pair> seconds_;             // pairs beside those of the order above
};

}    // namespace mpc

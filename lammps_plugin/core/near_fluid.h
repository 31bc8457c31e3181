// Which of the fluid a coupling by forces must move at every MD step, and with which colloids it
// pairs it.
//
// Exactly: a particle outside the cutoff feels no force, so until it comes within it flies at
// constant speed (and gains field * time, and what a moving wall adds). A particle that cannot come
// within the cutoff of any colloid at that speed before the interval ends, while no colloid moves
// further than its allowance, flies free all the way.
//
// A particle that is near may become faster. It is paired with every colloid it could reach at
// PAIR_SPEED; from when it is faster than CHECKED_SPEED, with all: that is up to the coupling.

#pragma once

#include "coupling.h"
#include "walls.h"

#include <limits>

namespace mpc {

template <int D> class NearFluid {
 public:
  struct Candidate {
    int index, colloid;
    Particle<D> particle;
  };
  struct Pair {
    int particle, colloid;
  };

  NearFluid(double interval, double temperature, const Vector<D> &field, const Walls<D> *walls)
    : interval_(interval), thermal_speed_(std::sqrt(temperature)),
      usual_(square_of(CHECKED_SPEED * thermal_speed_)),
      gain_(std::sqrt(square<D>(field)) * interval + (walls ? walls->gain() : 0))
  {
  }

  static double cutoff(double sigma) { return 1.122462048309373 * sigma; }    // 2^(1/6)

  double reach(double largest_sigma) const
  {
    return cutoff(largest_sigma) + interval_ * flight_speed(PAIR_SPEED * thermal_speed_);
  }

  // Whether a particle is to be paired with all colloids.
  bool is_fast(double square_speed) const { return square_speed > usual_; }

  // Farthest that a colloid may move before the interval ends.
  double allowance() const { return allowance_; }

  void begin(const Grid<D> &grid, const std::vector<Colloid<D>> &colloids, double speed)
  {
    grid_ = grid;
    colloids_ = colloids;
    allowance_ = interval_ * speed;
    candidates_.clear();
    others_.clear();

    ranges_.clear();
    for (const auto &colloid : colloids)
      ranges_.push_back({cutoff(colloid.sigma), square_of(pair_reach(colloid))});
    for (int a = 0; a < D; ++a) turns_per_length_[a] = grid.periodic[a] ? 1 / grid.box[a] : 0.0;

    head_.assign(grid.cells(), -1);
    entries_.clear();
    for (int c = 0; c < static_cast<int>(colloids.size()); ++c) list_cells(c);
  }

  void take(const Fluid<D> &fluid, int begin, int end)
  {
    listed_.resize(end - begin);
    int listed = 0;    // a list without branches: who is in it follows no pattern
    for (int i = begin; i < end; ++i) {
      double speed = 0;
      for (int a = 0; a < D; ++a) speed += fluid.v[a][i] * fluid.v[a][i];
      listed_[listed] = i;
      listed += (head_[fluid.cell[i]] >= 0) | is_fast(speed);
    }
    for (int k = 0; k < listed; ++k) consider(fluid, listed_[k]);
  }

  // What was taken, each with the nearest colloid; and all its other pairs, by the number of the
  // candidate.
  const std::vector<Candidate> &candidates() const { return candidates_; }
  const std::vector<Pair> &others() const { return others_; }
  const std::vector<Colloid<D>> &colloids() const { return colloids_; }    // as they were

 private:
  static constexpr double CHECKED_SPEED = 6.0;    // thermal speeds; e^-18 are faster
  static constexpr double PAIR_SPEED = 7.0;       // room for what one step adds to the checked

  struct Entry {
    int colloid, next;
  };
  struct Range {
    double cutoff, square_reach;    // of the force, and of pairing squared
  };

  static double square_of(double a) { return a * a; }

  double flight_speed(double speed) const { return speed + gain_; }

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
    const bool fast = is_fast(square_speed);
    if (fast) bring_into_cell(particle.x, fluid.cell[i]);
    const auto before = others_.size();
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
      if (nearest >= 0) others_.push_back({number, r2 < least ? nearest : c});
      if (r2 < least) {
        nearest = c;
        least = r2;
      }
    };
    if (fast) {
      for (int c = 0; c < static_cast<int>(colloids_.size()); ++c) meet(c);
      if (within && nearest < 0) nearest = 0;    // the coupling pairs it with the rest
    } else {
      for (int e = head_[fluid.cell[i]]; e >= 0; e = entries_[e].next) meet(entries_[e].colloid);
    }
    if (!within) {
      others_.resize(before);
      return;
    }
    if (!fast)
      for (int a = 0; a < D; ++a)
        particle.x[a] -= turns(a, particle.x[a] - colloids_[nearest].x[a]) * grid_.box[a];
    candidates_.push_back({i, nearest, particle});
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

  double interval_, thermal_speed_;
  double usual_;    // square of the checked speed
  double gain_;     // of speed in an interval, from the field and the walls

  Grid<D> grid_{{}, {}, 1.0};            // as it was when the interval began
  std::vector<Colloid<D>> colloids_;
  std::vector<Range> ranges_;            // of each colloid
  Vector<D> turns_per_length_;           // 0 across walls
  double allowance_ = 0;
  std::vector<int> head_;                // of each cell, its list of entries; -1 for none
  std::vector<Entry> entries_;
  std::vector<int> listed_;
  std::vector<Candidate> candidates_;
  std::vector<Pair> others_;
};

}    // namespace mpc

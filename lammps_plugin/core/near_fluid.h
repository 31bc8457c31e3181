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

#include "colloid_cells.h"
#include "coupling.h"
#include "walls.h"

#include <functional>
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

  // The cutoff of the force is a function of the colloid's type.
  NearFluid(double interval, double temperature, const Vector<D> &field, const Walls<D> *walls,
            std::function<double(int)> cutoff)
    : interval_(interval), thermal_speed_(std::sqrt(temperature)),
      usual_(square_of(CHECKED_SPEED * thermal_speed_)),
      gain_(std::sqrt(square<D>(field)) * interval + (walls ? walls->gain() : 0)),
      cutoff_(std::move(cutoff))
  {
  }

  double reach(double cutoff) const
  {
    return cutoff + interval_ * flight_speed(PAIR_SPEED * thermal_speed_);
  }

  // Whether a particle is to be paired with all colloids.
  bool is_fast(double square_speed) const { return square_speed > usual_; }
  double usual() const { return usual_; }    // the largest square of a speed that is not

  // Farthest that a colloid may move before the interval ends.
  double allowance() const { return allowance_; }

  void begin(const Grid<D> &grid, const std::vector<Colloid<D>> &colloids, double speed)
  {
    colloids_ = colloids;
    allowance_ = interval_ * speed;
    candidates_.clear();
    others_.clear();
    cutoffs_.clear();
    square_reaches_.clear();
    for (int a = 0; a < D; ++a) centres_[a].clear();
    cells_.begin(grid);
    for (int a = 0; a < D; ++a) turns_per_length_[a] = grid.periodic[a] ? 1 / grid.box[a] : 0.0;
    for (int c = 0; c < static_cast<int>(colloids.size()); ++c) {
      const double cutoff = cutoff_(colloids[c].type), pairing = reach(cutoff) + allowance_;
      cutoffs_.push_back(cutoff);
      square_reaches_.push_back(square_of(pairing));
      for (int a = 0; a < D; ++a) centres_[a].push_back(colloids[c].x[a]);
      cells_.enter(c, colloids[c].x, pairing);    // at all cells with what could be paired with it
    }
    cells_.finish();
  }

  template <class Real> void take(const Fluid<D, Real> &fluid, int begin, int end)
  {
    if (colloids_.empty()) return;
    list(fluid, begin, end);
    look(fluid);
    for (int k = 0; k < listed_count_; ++k) {
      const int i = listed_[k], colloid = colloid_[k];
      if (colloid < 0)
        consider(fluid, i);
      else
        candidates_.push_back({i, colloid, seen_from(fluid.particle(i), colloid)});
    }
  }

  // What was taken, each with the nearest colloid; and all its other pairs, by the number of the
  // candidate.
  const std::vector<Candidate> &candidates() const { return candidates_; }
  const std::vector<Pair> &others() const { return others_; }
  const std::vector<Colloid<D>> &colloids() const { return colloids_; }    // as they were

 private:
  static constexpr double CHECKED_SPEED = 6.0;    // thermal speeds; e^-18 are faster
  static constexpr double PAIR_SPEED = 7.0;       // room for what one step adds to the checked

  static double square_of(double a) { return a * a; }

  double flight_speed(double speed) const { return speed + gain_; }

  // List the particles that have colloids near their cells, and the fast ones. Without branches: who is
  // in the list follows no pattern.
  template <class Real> void list(const Fluid<D, Real> &fluid, int begin, int end)
  {
    const double usual = usual_;
    int fast = 0;
    for (int i = begin; i < end; ++i) fast += square_speed(fluid, i) > usual;
    listed_.resize(end - begin);
    int *__restrict listed = listed_.data();
    int count = 0;
    for (int i = begin; i < end; ++i) {
      listed[count] = i;
      count += cells_.any(fluid.cell[i]);
      if (fast > 0 && is_fast(square_speed(fluid, i)) && !cells_.any(fluid.cell[i])) ++count;
    }
    listed_count_ = count;
  }

  // Keep those of the list that may come within the cutoff of the only colloid of their cell, or
  // whose cell has several, or that are fast: these must be looked at more closely.
  template <class Real> void look(const Fluid<D, Real> &fluid)
  {
    const int count = listed_count_;
    for (auto *of_each : {&speeds_, &squares_}) of_each->assign(count, 0);
    for (auto *of_each : {&colloid_, &nearest_, &within_}) of_each->resize(count);
    int *__restrict listed = listed_.data(), *__restrict colloid = colloid_.data();
    int *__restrict nearest = nearest_.data(), *__restrict within = within_.data();
    double *__restrict speeds = speeds_.data(), *__restrict r2 = squares_.data();
    for (int k = 0; k < count; ++k) {
      colloid[k] = cells_.only(fluid.cell[listed[k]]);
      nearest[k] = colloid[k] < 0 ? 0 : colloid[k];
    }
    for (int a = 0; a < D; ++a) {
      const double *centre = centres_[a].data();
      const Real *v = fluid.v[a].data();
      const auto position = fluid.positions(a);
      const double size = cells_.grid().box[a], per_size = turns_per_length_[a];
      for (int k = 0; k < count; ++k) {
        const double separation = position(listed[k]) - centre[nearest[k]];
        r2[k] += square_of(separation - std::rint(separation * per_size) * size);
        speeds[k] += square_of(v[listed[k]]);
      }
    }
    const double *cutoffs = cutoffs_.data(), usual = usual_, interval = interval_;
    const double least = allowance_ + interval_ * gain_;
    for (int k = 0; k < count; ++k) {
      const double reach = cutoffs[nearest[k]] + least + interval * std::sqrt(speeds[k]);
      within[k] = (colloid[k] < 0) | (r2[k] < square_of(reach)) | (speeds[k] > usual);
    }
    int kept = 0;
    for (int k = 0; k < count; ++k) {
      listed[kept] = listed[k];
      colloid[kept] = speeds[k] > usual ? ColloidCells<D>::SEVERAL : colloid[k];
      kept += within[k];
    }
    listed_count_ = kept;
  }

  template <class Real> static double square_speed(const Fluid<D, Real> &fluid, int i)
  {
    double speed = 0;
    for (int a = 0; a < D; ++a) speed += square_of(fluid.v[a][i]);
    return speed;
  }

  // The image that is nearest to a colloid.
  Particle<D> seen_from(Particle<D> particle, int colloid) const
  {
    for (int a = 0; a < D; ++a)
      particle.x[a] -= turns(a, particle.x[a] - centres_[a][colloid]) * cells_.grid().box[a];
    return particle;
  }

  // Take a particle if it could come within a cutoff, and pair it. Its cell lists the images of
  // colloids that are near; a fast one meets all images, and so must itself be the one in its cell.
  template <class Real> void consider(const Fluid<D, Real> &fluid, int i)
  {
    const auto &grid = cells_.grid();
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
        r2 += square_of(fast ? separation : separation - turns(a, separation) * grid.box[a]);
      }
      const bool paired = r2 < square_reaches_[c];
      if (!paired && !fast) return;
      const double travel = allowance_ + interval_ * flight_speed(std::sqrt(square_speed));
      within |= r2 < square_of(cutoffs_[c] + travel);
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
      cells_.each(fluid.cell[i], meet);
    }
    if (!within) {
      others_.resize(before);
      return;
    }
    candidates_.push_back({i, nearest, fast ? particle : seen_from(particle, nearest)});
  }

  // Whole boxes in a separation.
  double turns(int axis, double separation) const
  {
    return std::rint(separation * turns_per_length_[axis]);
  }

  void bring_into_cell(Vector<D> &x, int cell) const
  {
    const auto &grid = cells_.grid();
    const auto rows = grid.rows(cell);
    for (int a = 0; a < D; ++a) x[a] -= turns(a, x[a] - grid.centre(a, rows[a])) * grid.box[a];
  }

  double interval_, thermal_speed_;
  double usual_;    // square of the checked speed
  double gain_;     // of speed in an interval, from the field and the walls
  std::function<double(int)> cutoff_;

  ColloidCells<D> cells_;    // as the interval began
  std::vector<Colloid<D>> colloids_;
  std::vector<double> cutoffs_, square_reaches_;    // of each colloid's force, and of pairing
  std::array<std::vector<double>, D> centres_;
  Vector<D> turns_per_length_;           // 0 across walls
  double allowance_ = 0;
  std::vector<int> listed_;              // particles, the first so many of them
  int listed_count_ = 0;
  std::vector<double> speeds_, squares_;    // of those listed: squares of speed and distance
  std::vector<int> colloid_, nearest_, within_;
  std::vector<Candidate> candidates_;
  std::vector<Pair> others_;
};

}    // namespace mpc

// Colloids that repel the fluid by a 12-6 potential, cut at its minimum, at every MD step
// (tabatabaei-2009, 3.42, 3.45, 3.46, 3.50 to 3.52).
//
// Which of the fluid is moved here: near_fluid.h. That no colloid moves further than was allowed for
// is checked at every evaluation of the forces.

#pragma once

#include "near_fluid.h"
#include "streaming.h"

#include <cstdio>
#include <map>

namespace mpc {

template <int D> class ForceCoupling : public Coupling<D> {
 public:
  struct Interaction {
    double epsilon, sigma;
  };
  using Interactions = std::map<int, Interaction>;    // by colloid type

  ForceCoupling(Interactions interactions, double interval, double temperature,
                const Vector<D> &field, const Walls<D> *walls)
    : interactions_(std::move(interactions)),
      near_(interval, temperature, field, walls,
            [this](int type) { return cutoff(interactions_.at(type).sigma); }),
      field_(field), walls_(walls)
  {
  }
  ForceCoupling(const ForceCoupling &) = delete;    // what is near knows this one

  bool feels(int type) const override { return interactions_.count(type) > 0; }
  double room(int type) const override { return interactions_.at(type).sigma; }

  double reach() const override
  {
    double reach = 0;
    for (const auto &[type, interaction] : interactions_)
      reach = std::max(reach, near_.reach(cutoff(interaction.sigma)));
    return reach;
  }

  bool every_step() const override { return true; }

  void begin(const Grid<D> &grid, const std::vector<Colloid<D>> &colloids, double speed) override
  {
    near_.begin(grid, colloids, speed);
    taken_.clear();
  }

  void take(const Fluid<D> &fluid, int begin, int end) override
  {
    near_.take(fluid, begin, end);
    const auto &candidates = near_.candidates();
    for (auto k = taken_.size(); k < candidates.size(); ++k) taken_.push_back(candidates[k].index);
  }

  // Sort what was taken by colloid, and find the forces on it.
  void ready() override
  {
    const auto &candidates = near_.candidates();
    const int colloids = static_cast<int>(near_.colloids().size());
    start_.assign(colloids + 1, 0);
    for (const auto &candidate : candidates) ++start_[candidate.colloid + 1];
    for (int c = 0; c < colloids; ++c) start_[c + 1] += start_[c];

    const int count = static_cast<int>(candidates.size());
    taken_.resize(count);
    ids_.resize(count);
    with_all_.assign(count, false);
    for (int a = 0; a < D; ++a)
      for (auto *values : {&x_[a], &v_[a], &old_[a], &new_[a], &pull_[a]}) values->resize(count);
    auto next = start_;
    place_.resize(count);
    for (int k = 0; k < count; ++k) {
      const auto &candidate = candidates[k];
      const int at = place_[k] = next[candidate.colloid]++;
      taken_[at] = candidate.index;
      ids_[at] = candidate.particle.id;
      for (int a = 0; a < D; ++a) {
        x_[a][at] = candidate.particle.x[a];
        v_[a][at] = candidate.particle.v[a];
      }
    }
    others_ = near_.others();
    for (auto &pair : others_) pair.particle = place_[pair.particle];

    of_colloid_.clear();
    for (const auto &colloid : near_.colloids())
      of_colloid_.push_back(interactions_.at(colloid.type));
    std::vector<Push<D>> unused(colloids);
    forces(near_.colloids(), unused);
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
      throw bounces.fault(static_cast<std::uint32_t>(ids_[bounces.index]));
    }
  }

  void forces(const std::vector<Colloid<D>> &colloids, std::vector<Push<D>> &on_colloids) override
  {
    for (int c = 0; c < static_cast<int>(colloids.size()); ++c) {
      check_allowance(colloids[c], near_.colloids()[c]);
      on_colloids[c].linear = force_of(colloids[c], of_colloid_[c], start_[c], start_[c + 1]);
    }
    for (const auto &pair : others_) {
      const auto &colloid = colloids[pair.colloid];
      const auto &interaction = of_colloid_[pair.colloid];
      Vector<D> separation;
      for (int a = 0; a < D; ++a) separation[a] = x_[a][pair.particle] - colloid.x[a];
      const double r2 = square<D>(separation);
      if (!(r2 > square_of(CORE * interaction.sigma))) fault_in_core(pair.particle, colloid, r2);
      const double strength = force_over_distance(interaction, r2);
      for (int a = 0; a < D; ++a) {
        new_[a][pair.particle] += strength * separation[a];
        on_colloids[pair.colloid].linear[a] -= strength * separation[a];
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

 private:
  static constexpr double CORE = 0.5;    // of sigma: an energy of 16000 epsilon
  static constexpr int LANES = 8;

  using Pair = typename NearFluid<D>::Pair;

  static double square_of(double a) { return a * a; }

  static double cutoff(double sigma) { return 1.122462048309373 * sigma; }    // 2^(1/6)

  static double force_over_distance(const Interaction &of, double r2)
  {
    const double inverse = 1 / r2;
    const double ratio = of.sigma * of.sigma * inverse;
    const double u = ratio * ratio * ratio;
    const double strength = 24 * of.epsilon * (2 * u * u - u) * inverse;
    return r2 < square_of(cutoff(of.sigma)) ? strength : 0.0;
  }

  // Pair the particles that have become fast with all colloids.
  void pair_fast()
  {
    const int count = static_cast<int>(taken_.size());
    int fast = 0;
    for (int k = 0; k < count; ++k) {
      double speed = 0;
      for (int a = 0; a < D; ++a) speed += v_[a][k] * v_[a][k];
      fast += near_.is_fast(speed);
    }
    for (int k = 0; fast > 0 && k < count; ++k) {
      double speed = 0;
      for (int a = 0; a < D; ++a) speed += v_[a][k] * v_[a][k];
      if (!near_.is_fast(speed)) continue;
      --fast;
      if (with_all_[k]) continue;
      with_all_[k] = true;
      std::vector<bool> has(near_.colloids().size());
      for (const auto &pair : others_)
        if (pair.particle == k) has[pair.colloid] = true;
      for (int c = 0; c < static_cast<int>(near_.colloids().size()); ++c)
        if (!has[c] && !(start_[c] <= k && k < start_[c + 1])) others_.push_back({k, c});
    }
  }

  // Forces between a colloid and its own particles first ... last - 1; that on the colloid.
  Vector<D> force_of(const Colloid<D> &colloid, const Interaction &interaction, int first, int last)
  {
    const auto of = interaction;    // copies: for all the compiler knows, the loop could write there
    const auto centre = colloid.x;
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
        separation[a] = x[a][k] - centre[a];
        r2 += separation[a] * separation[a];
      }
      const double strength = force_over_distance(of, r2);
      deep += !(r2 > core);    // true for NaN
      for (int a = 0; a < D; ++a) {
        pull[a][k] = strength * separation[a];
        after[a][k] = strength * separation[a] + field[a];
      }
    }
    if (deep > 0) find_in_core(colloid, of.sigma, first, last);

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
    if (moved <= square_of(near_.allowance())) return;
    char text[200];
    std::snprintf(text, sizeof text,
                  "colloid %.0f moved by %.4g since the last collision, further than the %.4g that "
                  "the choice of near fluid allows: the time step is too long, or a force too strong",
                  now.id, std::sqrt(moved), near_.allowance());
    throw Fault(text);
  }

  void find_in_core(const Colloid<D> &colloid, double sigma, int first, int last) const
  {
    for (int k = first; k < last; ++k) {
      double r2 = 0;
      for (int a = 0; a < D; ++a) r2 += square_of(x_[a][k] - colloid.x[a]);
      if (!(r2 > square_of(CORE * sigma))) fault_in_core(k, colloid, r2);
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

  using Coupling<D>::taken_;

  Interactions interactions_;
  NearFluid<D> near_;
  Vector<D> field_;
  const Walls<D> *walls_;
  std::vector<Interaction> of_colloid_;    // seen as the interval began

  // taken particles, those of one colloid behind each other: colloid c has start_[c] ...
  std::vector<int> start_, place_;
  std::vector<double> ids_;
  std::array<std::vector<double>, D> x_, v_, old_, new_, pull_;
  std::vector<bool> with_all_;
  std::vector<Pair> others_;    // pairs beside those of the order above
};

}    // namespace mpc

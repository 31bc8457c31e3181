// Colloids that repel the fluid by a 12-6 potential, cut at its minimum, at every MD step
// (tabatabaei-2009, 3.42, 3.45, 3.46, 3.50 to 3.52).
//
// Which of the fluid is moved here: near_fluid.h. That no colloid moves further than was allowed for
// is checked at every evaluation of the forces.

#pragma once

#include "near_fluid.h"
#include "streaming.h"

#include <cstdint>
#include <cstdio>
#include <cstring>
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
    lowest_.fill(-std::numeric_limits<double>::infinity());
    highest_.fill(std::numeric_limits<double>::infinity());
    if (!walls) return;
    for (int a : walls->axes()) {
      lowest_[a] = 0;
      highest_[a] = walls->width(a);
    }
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

  void take(const Fluid<D> &fluid, int begin, int end) override { take_from(fluid, begin, end); }
  void take(const Fluid<D, float> &fluid, int begin, int end) override
  {
    take_from(fluid, begin, end);
  }

  // Lay out what was taken by colloid, and find the forces on it. What belongs to a colloid begins
  // and ends at whole lanes; the places that this leaves hold nobody, far away.
  void ready() override
  {
    const auto &candidates = near_.candidates();
    const int colloids = static_cast<int>(near_.colloids().size());
    std::vector<int> counts(colloids);
    for (const auto &candidate : candidates) ++counts[candidate.colloid];
    spans_.clear();
    int places = 0;
    for (int c = 0; c < colloids; ++c) {
      spans_.push_back({places, places + counts[c], (places + counts[c] + LANES - 1) / LANES * LANES});
      places = spans_[c].end;
    }
    ids_.resize(places);
    with_all_.assign(places, false);
    for (int a = 0; a < D; ++a)
      for (auto *values : {&x_[a], &v_[a], &acceleration_[a]}) values->resize(places);
    int away = 0;    // along an axis without walls, if there is one: nobody is not to meet them
    while (away < D - 1 && walls_ && walls_->across(away)) ++away;
    for (int c = 0; c < colloids; ++c)
      for (int k = spans_[c].last; k < spans_[c].end; ++k)
        for (int a = 0; a < D; ++a) {
          x_[a][k] = near_.colloids()[c].x[a] + (a == away ? FAR * near_.reach(0) : 0.0);
          v_[a][k] = 0;
        }

    std::vector<int> next;
    for (const auto &span : spans_) next.push_back(span.first);
    place_.clear();
    for (const auto &candidate : candidates) {
      const int at = next[candidate.colloid]++;
      place_.push_back(at);
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
    pair_fast();
  }

  void forces(const std::vector<Colloid<D>> &colloids, std::vector<Push<D>> &on_colloids) override
  {
    evaluate<false>(0, colloids, on_colloids);
  }

  void step(double time, const std::vector<Colloid<D>> &colloids,
            std::vector<Push<D>> &on_colloids) override
  {
    if (evaluate<true>(time, colloids, on_colloids)) pair_fast();
  }

  void give_back(Fluid<D> &fluid) override { give_back_to(fluid); }
  void give_back(Fluid<D, float> &fluid) override { give_back_to(fluid); }

 private:
  static constexpr double CORE = 0.5;    // of sigma: an energy of 16000 epsilon
  static constexpr double FAR = 1e6;     // of what a particle can fly in an interval
  static constexpr int LANES = 8;

  // So many numbers that a processor with the widest vectors takes at once.
  using Lanes = double __attribute__((vector_size(LANES * sizeof(double))));
  using Mask = std::int64_t __attribute__((vector_size(LANES * sizeof(double))));
  using Pair = typename NearFluid<D>::Pair;

  // Places of the particles of a colloid: first ... last - 1, with nobody until end.
  struct Span {
    int first, last, end;
  };

  template <class Real> void take_from(const Fluid<D, Real> &fluid, int begin, int end)
  {
    near_.take(fluid, begin, end);
    const auto &candidates = near_.candidates();
    for (auto k = taken_.size(); k < candidates.size(); ++k) taken_.push_back(candidates[k].index);
  }

  template <class Real> void give_back_to(Fluid<D, Real> &fluid) const
  {
    for (std::size_t k = 0; k < taken_.size(); ++k)
      for (int a = 0; a < D; ++a) {
        fluid.set_position(a, taken_[k], x_[a][place_[k]]);
        fluid.v[a][taken_[k]] = static_cast<Real>(v_[a][place_[k]]);
      }
  }

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

  static Lanes load(const double *from)
  {
    Lanes lanes;
    std::memcpy(&lanes, from, sizeof lanes);
    return lanes;
  }

  static void store(double *to, const Lanes &lanes) { std::memcpy(to, &lanes, sizeof lanes); }

  static double sum(const Lanes &lanes)
  {
    static_assert(LANES == 8);    // by halves: their additions do not wait for each other
    return ((lanes[0] + lanes[4]) + (lanes[2] + lanes[6])) +
        ((lanes[1] + lanes[5]) + (lanes[3] + lanes[7]));
  }

  static bool any(const Mask &mask)
  {
    std::int64_t some = 0;
    for (int l = 0; l < LANES; ++l) some |= mask[l];
    return some != 0;
  }

  // Forces at the places where particles are; in a step, where they come to in this time, and their
  // velocities after it. Whether one has become fast.
  template <bool Moving>
  bool evaluate(double time, const std::vector<Colloid<D>> &colloids,
                std::vector<Push<D>> &on_colloids)
  {
    Mask deep{}, quick{};
    for (std::size_t c = 0; c < colloids.size(); ++c) {
      check_allowance(colloids[c], near_.colloids()[c]);
      pass<Moving>(colloids[c], of_colloid_[c], spans_[c], time, on_colloids[c].linear, deep, quick);
    }
    if (any(deep)) find_in_core(colloids);
    bool fast = any(quick);
    for (const auto &pair : others_) {
      const auto &colloid = colloids[pair.colloid];
      const auto &interaction = of_colloid_[pair.colloid];
      Vector<D> separation;
      for (int a = 0; a < D; ++a) separation[a] = x_[a][pair.particle] - colloid.x[a];
      const double r2 = square<D>(separation);
      if (!(r2 > square_of(CORE * interaction.sigma))) fault_in_core(pair.particle, colloid, r2);
      const double strength = force_over_distance(interaction, r2);
      for (int a = 0; a < D; ++a) {
        acceleration_[a][pair.particle] += strength * separation[a];
        if (Moving) v_[a][pair.particle] += 0.5 * time * (strength * separation[a]);
        on_colloids[pair.colloid].linear[a] -= strength * separation[a];
      }
      if (Moving) fast |= is_fast(pair.particle);
    }
    return fast;
  }

  // The particles of a colloid in one pass over memory, by velocity Verlet; the force on the colloid.
  // Deep and fast: in which lanes there is a particle in the core of it, or one that is fast.
  template <bool Moving>
  void pass(const Colloid<D> &colloid, const Interaction &interaction, const Span &span, double time,
            Vector<D> &force, Mask &deep, Mask &fast)
  {
    const Lanes none{};
    const double cut = square_of(cutoff(interaction.sigma)), core = square_of(CORE * interaction.sigma);
    const double square_sigma = interaction.sigma * interaction.sigma;
    const double scale = 24 * interaction.epsilon, half = 0.5 * time;
    const double usual = near_.usual();
    const auto centre = colloid.x;
    const auto field = field_;
    std::array<Lanes, D> total{};
    for (int k = span.first; k < span.end; k += LANES) {
      std::array<Lanes, D> x, v, separation;    // v at half the step
      for (int a = 0; a < D; ++a) {
        x[a] = load(&x_[a][k]);
        if (!Moving) continue;
        v[a] = load(&v_[a][k]) + half * load(&acceleration_[a][k]);
        x[a] += time * v[a];
      }
      if (Moving && walls_ && beyond(x)) {
        const auto flown = bounce(k, span.last, time, {x, v});
        x = flown.x;
        v = flown.v;
      }
      Lanes r2 = none, speed = none;
      for (int a = 0; a < D; ++a) {
        if (Moving) store(&x_[a][k], x[a]);
        separation[a] = x[a] - centre[a];
        r2 += separation[a] * separation[a];
      }
      const Lanes inverse = 1 / r2;
      const Lanes ratio = square_sigma * inverse;
      const Lanes u = ratio * ratio * ratio;
      Lanes strength = (2 * u - 1) * u * (scale * inverse);
      strength = r2 < cut ? strength : none;
      deep |= !(r2 > core);    // true for NaN
      for (int a = 0; a < D; ++a) {
        const Lanes pull = strength * separation[a], after = pull + field[a];
        total[a] += pull;
        if (Moving) {
          v[a] += half * after;
          speed += v[a] * v[a];
          store(&v_[a][k], v[a]);
        }
        store(&acceleration_[a][k], after);
      }
      fast |= speed > usual;
    }
    for (int a = 0; a < D; ++a) force[a] = -sum(total[a]);
  }

  // Whether any of some places is beyond a wall.
  bool beyond(const std::array<Lanes, D> &x) const
  {
    Mask crossing{};
    for (int a = 0; a < D; ++a) crossing |= (x[a] < lowest_[a]) | (x[a] > highest_[a]);
    return any(crossing);
  }

  struct Flown {
    std::array<Lanes, D> x, v;    // v at half the step
  };

  // Where the particles at the places from k on come to, those that meet walls on their way.
  Flown bounce(int k, int last, double time, Flown flown) const
  {
    for (int l = 0; l < LANES && k + l < last; ++l) {
      Vector<D> x, v, acceleration;
      bool crossing = false;
      for (int a = 0; a < D; ++a) {
        crossing |= (flown.x[a][l] < lowest_[a]) | (flown.x[a][l] > highest_[a]);
        x[a] = x_[a][k + l];
        v[a] = v_[a][k + l];
        acceleration[a] = acceleration_[a][k + l];
      }
      if (!crossing) continue;
      if (!fly_between<D>(*walls_, x, v, acceleration, time))
        throw TooManyBounces{k + l}.fault(static_cast<std::uint64_t>(ids_[k + l]));
      for (int a = 0; a < D; ++a) {
        flown.x[a][l] = x[a];
        flown.v[a][l] = v[a] - 0.5 * time * acceleration[a];    // flying adds the whole of it
      }
    }
    return flown;
  }

  bool is_fast(int k) const
  {
    double speed = 0;
    for (int a = 0; a < D; ++a) speed += v_[a][k] * v_[a][k];
    return near_.is_fast(speed);
  }

  // Pair the particles that have become fast with all colloids.
  void pair_fast()
  {
    const int colloids = static_cast<int>(spans_.size());
    for (int own = 0; own < colloids; ++own)
      for (int k = spans_[own].first; k < spans_[own].last; ++k) {
        if (with_all_[k] || !is_fast(k)) continue;
        with_all_[k] = true;
        std::vector<bool> has(colloids);
        for (const auto &pair : others_)
          if (pair.particle == k) has[pair.colloid] = true;
        for (int c = 0; c < colloids; ++c)
          if (c != own && !has[c]) others_.push_back({k, c});
      }
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

  void find_in_core(const std::vector<Colloid<D>> &colloids) const
  {
    for (std::size_t c = 0; c < colloids.size(); ++c)
      for (int k = spans_[c].first; k < spans_[c].last; ++k) {
        double r2 = 0;
        for (int a = 0; a < D; ++a) r2 += square_of(x_[a][k] - colloids[c].x[a]);
        if (!(r2 > square_of(CORE * of_colloid_[c].sigma))) fault_in_core(k, colloids[c], r2);
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
  Vector<D> lowest_, highest_;             // coordinates between the walls
  std::vector<Interaction> of_colloid_;    // seen as the interval began

  // what was taken, by places: those of one colloid behind each other
  std::vector<Span> spans_;      // of each colloid
  std::vector<int> place_;       // of each that was taken
  std::vector<double> ids_;
  std::array<Array<double>, D> x_, v_, acceleration_;
  std::vector<bool> with_all_;
  std::vector<Pair> others_;     // pairs beside those with the colloid of the place
};

}    // namespace mpc

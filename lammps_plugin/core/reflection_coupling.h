// Colloids as hard, rotating spheres (disks in 2D) that reflect the fluid with thermal velocities
// (hecht-2005, section IV).
//
// Either a particle that has ended inside a colloid is put at the nearest point of the surface, half
// a step ago. Or a particle that has met a colloid on its way is put where it met it, when it did:
// also if it has ended outside, as those who graze a colloid do. It leaves with a velocity drawn
// from (13) and (14) in the frame of the surface, flies for the rest of the time, and is looked at
// again, up to ten contacts.
//
// The frame of the surface. A colloid takes several contacts in an interval. If all left with the
// velocity that it had before them, its temperature would come out high by half the fraction of its
// velocity that it loses in an interval, 5 to 10 % in practice. What the incoming particles bring is
// decided by its path up to now; so those that leave must see a later velocity, the one for which
// the exchange as a whole sees the mean of before and after: V + share (V' - V), with V' found
// together with the contacts. For a translation the share is (4/3 + pi/6) / 2 in 3D and
// (3/2 + pi/4) / 2 in 2D, from the free-molecular friction by what comes and what leaves (Epstein,
// Phys. Rev. 23, 710, 1924); for a rotation it is 1/2, as what comes does not know of it.

#pragma once

#include "colloid_cells.h"
#include "coupling.h"
#include "streaming.h"

#include <algorithm>
#include <map>
#include <string>

namespace mpc {

enum class Placement { Nearest, Entry };

template <int D> class ReflectionCoupling : public Coupling<D> {
 public:
  using Radii = std::map<int, double>;    // by colloid type

  ReflectionCoupling(Radii radii, Placement placement, double interval, double temperature,
                     const Vector<D> &field, const Walls<D> *walls)
    : radii_(std::move(radii)), placement_(placement), interval_(interval),
      temperature_(temperature), field_(field), walls_(walls)
  {
    if (placement == Placement::Entry) way_ = MOST_SPEED * std::sqrt(temperature) * interval;
  }

  bool feels(int type) const override { return radii_.count(type) > 0; }
  double room(int type) const override { return radii_.at(type); }

  double reach() const override
  {
    double reach = 0;
    for (const auto &[type, radius] : radii_) reach = std::max(reach, radius);
    return reach + way_;
  }

  void begin(const Grid<D> &, const std::vector<Colloid<D>> &colloids, double speed) override
  {
    colloids_ = colloids;
    allowance_ = speed * interval_;
    find_radii();
  }

  bool after_flight() const override { return true; }

  // From a cell beside a colloid that is looked at in meet, a particle so slow cannot have met it.
  const std::vector<double> &hold(const Grid<D> &grid) override
  {
    cells_.begin(grid);
    for (int a = 0; a < D; ++a) per_length_[a] = 1 / grid.box[a];
    slowest_.assign(grid.cells(), HUGE_VAL);
    const double gain = 0.5 * std::sqrt(square<D>(field_)) * interval_;
    for (std::size_t c = 0; c < colloids_.size(); ++c) {
      const double touching = radius_[c] + allowance_;
      cells_.enter(static_cast<int>(c), colloids_[c].x, touching + way_, [&](int cell, double square) {
        const double way = std::max(std::sqrt(square) - touching, 0.0);
        const double speed = std::max(way / interval_ - gain, 0.0);
        slowest_[cell] = std::min(slowest_[cell], speed * speed);
      });
    }
    return slowest_;
  }

  // Whether a particle may come to a colloid, which moves no further than its allowance.
  bool holds(const Fluid<D> &fluid, int i, int cell) const override
  {
    const auto particle = fluid.particle(i);
    Vector<D> way;
    double square_way = 0;
    for (int a = 0; a < D; ++a) {
      way[a] = interval_ * (particle.v[a] - 0.5 * interval_ * field_[a]);
      square_way += way[a] * way[a];
    }
    bool near = false;
    cells_.each(cell, [&](int c) {
      const auto from = separation(particle.x, colloids_[c]);
      double back = 0;
      for (int a = 0; a < D; ++a) back += from[a] * way[a];
      double part = square_way > 0 ? std::clamp(back / square_way, 0.0, 1.0) : 0.0;
      if (placement_ == Placement::Nearest) part = 0;
      double closest = 0;
      for (int a = 0; a < D; ++a) {
        const double distance = from[a] - part * way[a];
        closest += distance * distance;
      }
      const double touching = radius_[c] * (1 + 1e-9) + allowance_;
      near |= closest < touching * touching;
    });
    return near;
  }

  // The host may show other images now, after it moved colloids between processes.
  void meet(const std::vector<Colloid<D>> &colloids, const CounterRandom &random) override
  {
    bool same = colloids.size() == colloids_.size();
    for (std::size_t c = 0; same && c < colloids.size(); ++c) {
      const auto from = separation(colloids[c].x, colloids_[c], false);
      same = colloids[c].id == colloids_[c].id && square<D>(from) <= allowance_ * allowance_;
    }
    colloids_ = colloids;
    if (!same) enter_anew();
    random_ = random;
    sums_.assign(WIDTH * colloids.size(), 0.0);
    impulses_.assign(colloids.size(), {});
  }

  void announce(const Flight<D> &flight, int cell) override
  {
    const auto contact = find(flight, cell);
    if (contact.colloid < 0) return;
    const auto came = relative_to_rest(contact, leaving(flight, contact));
    double *sum = &sums_[WIDTH * contact.colloid];
    *sum++ += 1;
    for (int a = 0; a < D; ++a) *sum++ += contact.arm[a];
    for (int a = 0; a < D; ++a)
      for (int b = a; b < D; ++b) *sum++ += contact.arm[a] * contact.arm[b];
    for (double component : came) *sum++ += component;
    for (double component : torque(contact.arm, came)) *sum++ += component;
  }

  // The velocities of the surfaces.
  void decide(Processes &processes) override
  {
    processes.sum_images(sums_, WIDTH);
    surfaces_.clear();
    for (std::size_t c = 0; c < colloids_.size(); ++c)
      surfaces_.push_back(solve(colloids_[c], &sums_[WIDTH * c]));
  }

  bool reflect(Flight<D> &flight, int cell) override
  {
    if (flight.contacts == MOST_CONTACTS) return false;
    const auto contact = find(flight, cell);
    if (contact.colloid < 0) return false;
    const auto &colloid = colloids_[contact.colloid];
    const auto &surface = surfaces_[contact.colloid];
    auto v = leaving(flight, contact);
    const auto turning = cross(surface.spin, contact.arm);
    Vector<D> x, impulse;
    for (int a = 0; a < D; ++a) {
      v[a] += surface.v[a] + turning[a];
      impulse[a] = contact.v[a] - v[a];
      x[a] = colloid.x[a] - contact.left * colloid.v[a] + contact.arm[a];
    }
    auto &push = impulses_[contact.colloid];
    const auto turn = torque(contact.arm, impulse);
    for (int a = 0; a < D; ++a) push.linear[a] += impulse[a];
    for (std::size_t s = 0; s < turn.size(); ++s) push.angular[s] += turn[s];
    flight.x = x;
    flight.v = v;
    fly(flight, contact.left);
    flight.flown = contact.left;
    ++flight.contacts;
    return true;
  }

 private:
  using Coupling<D>::impulses_;
  using Coupling<D>::slowest_;
  static constexpr int MOST_CONTACTS = 10;    // N_max
  static constexpr double MOST_SPEED = 5;     // thermal speeds; of 1e5 two are faster
  static constexpr int SPINS = D == 2 ? 1 : 3;
  static constexpr int WIDTH = 1 + D + D * (D + 1) / 2 + D + SPINS;
  static constexpr double SHARE = D == 2 ? (1.5 + M_PI / 4) / 2 : (4.0 / 3 + M_PI / 6) / 2;

  struct Contact {
    int colloid = -1;
    Vector<D> arm, v;    // from the centre to the contact; of the particle that comes
    double left;         // time from the contact to the end of the interval
  };

  struct Surface {
    Vector<D> v;
    Spin<D> spin;
  };

  void find_radii()
  {
    radius_.clear();
    for (const auto &colloid : colloids_) radius_.push_back(radii_.at(colloid.type));
  }

  // Enter colloids at their cells as they are now; particles must have been held where they touch.
  void enter_anew()
  {
    find_radii();
    cells_.begin(Grid<D>(cells_.grid()));
    for (std::size_t c = 0; c < colloids_.size(); ++c)
      cells_.enter(static_cast<int>(c), colloids_[c].x, radius_[c] + allowance_ + way_,
                   [&](int cell, double square) {
                     if (square < radius_[c] * radius_[c] && slowest_[cell] > 0)
                       throw_moved_too_far(colloids_[c]);
                   });
  }

  Vector<D> separation(const Vector<D> &x, const Colloid<D> &colloid, bool nearest_image = true) const
  {
    Vector<D> from;
    for (int a = 0; a < D; ++a) {
      from[a] = x[a] - colloid.x[a];
      if (nearest_image && cells_.grid().periodic[a])
        from[a] -= cells_.grid().box[a] * std::rint(from[a] * per_length_[a]);
    }
    return from;
  }

  // The contact that comes first on a particle's way, or, where those who end inside are put at the
  // nearest point, with the colloid that it is deepest in; perhaps none.
  Contact find(const Flight<D> &flight, int cell) const
  {
    Contact contact;
    Vector<D> from{};    // from the centre of the colloid to the particle
    double most = placement_ == Placement::Entry ? -1 : 0;
    cells_.each(cell, [&](int c) {
      const auto &colloid = colloids_[c];
      const auto apart = separation(flight.x, colloid);
      const double inside = 1 - square<D>(apart) / (radius_[c] * radius_[c]);
      const double ago = placement_ == Placement::Entry
          ? entry(flight, colloid, apart, inside, radius_[c])
          : inside;
      if (!(ago > most)) return;
      most = ago;
      from = apart;
      contact.colloid = c;
    });
    if (contact.colloid < 0) return contact;

    const auto &colloid = colloids_[contact.colloid];
    if (placement_ == Placement::Nearest)
      contact.left = 0.5 * interval_;
    else if (most > flight.flown)    // it never came in: it was inside before
      contact.left = 0.5 * flight.flown;
    else {
      contact.left = most;
      const auto way = relative_velocity(flight, colloid);
      for (int a = 0; a < D; ++a) from[a] -= most * way[a];
    }
    const double scale = radius_[contact.colloid] / std::sqrt(square<D>(from));
    for (int a = 0; a < D; ++a) {
      contact.arm[a] = scale * from[a];
      contact.v[a] = flight.v[a] - contact.left * field_[a];
    }
    return contact;
  }

  // The mean over its flight, in the frame of the colloid.
  Vector<D> relative_velocity(const Flight<D> &flight, const Colloid<D> &colloid) const
  {
    Vector<D> v;
    for (int a = 0; a < D; ++a)
      v[a] = flight.v[a] - 0.5 * flight.flown * field_[a] - colloid.v[a];
    return v;
  }

  // How long ago a particle came in, on a straight way in the frame of the colloid; -1 for one that
  // did not, and more than it has flown for one that ends inside and was there all the time.
  double entry(const Flight<D> &flight, const Colloid<D> &colloid, const Vector<D> &from,
               double inside, double size) const
  {
    const auto v = relative_velocity(flight, colloid);
    double approach = 0;
    for (int a = 0; a < D; ++a) approach += v[a] * from[a];
    const double speed = square<D>(v);
    const double root = approach * approach + speed * inside * size * size;
    if (!(root > 0)) return -1;
    const double ago = (approach + std::sqrt(root)) / speed;
    if (!(ago >= 0)) return -1;
    if (ago <= flight.flown * (1 + 1e-9)) return std::min(ago, flight.flown);    // rounding
    return inside > 0 ? 2 * flight.flown : -1;
  }

  // The velocity that a particle leaves with, in the frame of the surface (13, 14): along the normal
  // and along tangents, the first of them beside the axis that is the least along the normal.
  Vector<D> leaving(const Flight<D> &flight, const Contact &contact) const
  {
    const auto words = random_.words(Stream::Reflection, static_cast<std::uint64_t>(flight.id),
                                     static_cast<std::uint64_t>(flight.contacts));
    const auto u = uniforms(words);
    const double scale = 1 / std::sqrt(square<D>(contact.arm));
    Vector<D> n;
    for (int a = 0; a < D; ++a) n[a] = scale * contact.arm[a];
    const double thermal = std::sqrt(temperature_);
    const double along = thermal * std::sqrt(-2 * logarithm(1 - u[0]));
    const auto [first, second] = normal_pair(u[2], u[3]);
    if constexpr (D == 2) {
      (void)second;
      return {along * n[0] - thermal * first * n[1], along * n[1] + thermal * first * n[0]};
    } else {
      int axis = 0;
      for (int a = 1; a < D; ++a)
        if (std::abs(n[a]) < std::abs(n[axis])) axis = a;
      Vector<3> beside{};
      beside[axis] = 1;
      for (int a = 0; a < 3; ++a) beside[a] -= n[axis] * n[a];
      const double length = std::sqrt(square<3>(beside));
      for (double &component : beside) component /= length;
      const auto other = cross(n, beside);
      Vector<3> v;
      for (int a = 0; a < 3; ++a)
        v[a] = along * n[a] + thermal * (first * beside[a] + second * other[a]);
      return v;
    }
  }

  // What a contact would give to a colloid whose surface rests.
  static Vector<D> relative_to_rest(const Contact &contact, const Vector<D> &leaving)
  {
    Vector<D> impulse;
    for (int a = 0; a < D; ++a) impulse[a] = contact.v[a] - leaving[a];
    return impulse;
  }

  // V and Omega of the surface from M (V' - V) = P - sum (V + Omega x r) and
  // I (Omega' - Omega) = Q - sum r x (V + Omega x r), primed ones as they are after all contacts.
  static Surface solve(const Colloid<D> &colloid, const double *sum)
  {
    constexpr int N = D + SPINS;
    const double count = *sum++;
    Vector<D> arms;
    for (int a = 0; a < D; ++a) arms[a] = *sum++;
    double squares[D][D], trace = 0;
    for (int a = 0; a < D; ++a)
      for (int b = a; b < D; ++b) squares[a][b] = squares[b][a] = *sum++;
    for (int a = 0; a < D; ++a) trace += squares[a][a];

    double matrix[N][N], right[N];
    for (int column = 0; column < N; ++column) {
      Vector<D> v{};
      Spin<D> spin{};
      (column < D ? v[column] : spin[column - D]) = 1;
      const auto turning = cross(spin, arms);
      const auto twist = torque(arms, v);
      for (int a = 0; a < D; ++a) matrix[a][column] = count * v[a] + turning[a];
      for (int s = 0; s < SPINS; ++s) {
        double of_spin = trace * spin[s];
        if constexpr (D == 3)
          for (int b = 0; b < 3; ++b) of_spin -= squares[s][b] * spin[b];
        matrix[D + s][column] = twist[s] + of_spin;
      }
    }
    for (int row = 0; row < N; ++row) {
      const double inertia = row < D ? colloid.mass / SHARE : 2 * colloid.inertia;
      matrix[row][row] += inertia;
      right[row] = *sum++ + inertia * (row < D ? colloid.v[row] : colloid.spin[row - D]);
    }
    for (int pivot = 0; pivot < N; ++pivot)    // symmetric and positive: no exchange of rows
      for (int row = pivot + 1; row < N; ++row) {
        const double factor = matrix[row][pivot] / matrix[pivot][pivot];
        for (int column = pivot; column < N; ++column)
          matrix[row][column] -= factor * matrix[pivot][column];
        right[row] -= factor * right[pivot];
      }
    for (int row = N - 1; row >= 0; --row) {
      for (int column = row + 1; column < N; ++column) right[row] -= matrix[row][column] * right[column];
      right[row] /= matrix[row][row];
    }
    Surface surface;
    std::copy_n(right, D, surface.v.begin());
    std::copy_n(right + D, SPINS, surface.spin.begin());
    return surface;
  }

  void fly(Flight<D> &flight, double time) const
  {
    if (!walls_) {
      for (int a = 0; a < D; ++a) {
        flight.x[a] += time * (flight.v[a] + 0.5 * time * field_[a]);
        flight.v[a] += time * field_[a];
      }
      return;
    }
    for (int a : walls_->axes()) flight.x[a] = std::clamp(flight.x[a], 0.0, walls_->width(a));
    if (!fly_between<D>(*walls_, flight.x, flight.v, field_, time))
      throw TooManyBounces::fault(static_cast<std::uint32_t>(flight.id));
  }

  [[noreturn]] void throw_moved_too_far(const Colloid<D> &colloid) const
  {
    throw Fault("colloid " + std::to_string(static_cast<std::int64_t>(colloid.id)) +
                " moved further since the last collision than " + std::to_string(allowance_) +
                ", which the choice of fluid to reflect allows: a force on it is too strong");
  }

  Radii radii_;
  Placement placement_;
  double interval_, temperature_;
  Vector<D> field_;
  const Walls<D> *walls_;
  std::vector<Colloid<D>> colloids_;
  std::vector<double> radius_;     // of each
  Vector<D> per_length_{};         // of the box
  double allowance_ = 0;           // how far they may move in the interval
  double way_ = 0;                 // how far behind a colloid its contacts are looked for
  ColloidCells<D> cells_;
  CounterRandom random_{0, 0};
  std::vector<double> sums_;
  std::vector<Surface> surfaces_;
};

}    // namespace mpc

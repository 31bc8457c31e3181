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
// velocity that it loses in an interval, 5 to 10 % in practice. The exchange as a whole must see
// (V + V') / 2, the mean of before and after. What comes sees the mean velocity W on the way of the
// interval, which between colloids that hold each other is not V. So what leaves must make up for it:
// by the free-molecular friction of a translation, 1 of what leaves and r of what comes, r = 1/3 +
// pi/6 in 3D and 1/2 + pi/4 in 2D (Epstein, Phys. Rev. 23, 710, 1924), it sees
// (1 + r) (V + V') / 2 - r W, with V' found together with the contacts. For a rotation it is the mean,
// as what comes does not know of it.
//
// Between colloids that nearly touch, particles go to and fro. So contacts come in rounds, the next of
// every particle, and each round changes V to V' as the first does.

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

  bool after_flight() const override { return true; }

  void meet(const Grid<D> &grid, const std::vector<Colloid<D>> &colloids,
            const CounterRandom &random) override
  {
    colloids_ = colloids;
    random_ = random;
    spheres_.clear();
    largest_ = fastest_ = 0;
    for (const auto &colloid : colloids) {
      spheres_.push_back({colloid.x, colloid.mean, radii_.at(colloid.type)});
      largest_ = std::max(largest_, spheres_.back().radius * (1 + 1e-9));
      fastest_ = std::max(fastest_, square<D>(colloid.mean));
    }
    fastest_ = std::sqrt(fastest_) + 0.5 * std::sqrt(square<D>(field_)) * interval_;
    for (int a = 0; a < D; ++a) per_length_[a] = grid.periodic[a] ? 1 / grid.box[a] : 0.0;
    cells_.begin(grid);
    for (std::size_t c = 0; c < spheres_.size(); ++c)
      cells_.enter(static_cast<int>(c), spheres_[c].x, distance(0, interval_) + way_);
    cells_.finish();
    sums_.assign(WIDTH * colloids.size(), 0.0);
    impulses_.assign(colloids.size(), {});
    now_.clear();
    for (const auto &colloid : colloids) now_.push_back({colloid.v, colloid.spin});
    surfaces_ = now_;
    announced_.clear();
  }

  void watch(const Fluid<D> &fluid, int begin, int end, std::vector<int> &met) override
  {
    const int count = end - begin;
    listed_.resize(count);
    within_.resize(count);
    for (int k = 0; k < count; ++k) {
      double square = 0;
      for (int a = 0; a < D; ++a) square += fluid.v[a][begin + k] * fluid.v[a][begin + k];
      const double within = distance(std::sqrt(square), interval_);
      within_[k] = within * within;
    }
    int listed = 0;    // a list without branches: who is in it follows no pattern
    for (int k = 0; k < count; ++k) {
      const int cell = fluid.cell[begin + k];
      cells_.prefetch_look(std::max(fluid.cell[begin + std::min(k + AHEAD, count - 1)], 0));
      listed_[listed] = begin + k;
      listed += (cell >= 0) & (within_[k] > cells_.nearest(cell >= 0 ? cell : 0));
    }
    candidates_.count = 0;
    for (int k = 0; k < listed; ++k) {
      const int i = listed_[k];
      cells_.prefetch(fluid.cell[listed_[std::min(k + AHEAD, listed - 1)]]);
      pair_up(fluid.particle(i), i, fluid.cell[i], within_[i - begin]);
    }
    may_have_met();
    int last = -1;
    for (int c = 0; c < candidates_.count; ++c) {
      const int i = candidates_.particle[c];
      if (!candidates_.near[c] || i == last) continue;
      last = i;
      const Flight<D> flight{fluid.particle(i), interval_, 0};
      const auto contact = find(flight, fluid.cell[i]);
      if (contact.colloid < 0) continue;
      met.push_back(i);
      remember(flight, contact);
    }
  }

  void announce(const Flight<D> &flight, int cell) override
  {
    remember(flight, flight.contacts < MOST_CONTACTS ? find(flight, cell) : Contact{});
  }

  // The velocities of the surfaces, and of the colloids after the round.
  void decide(Processes &processes) override
  {
    decided_.swap(announced_);
    announced_.clear();
    next_ = 0;
    processes.sum_images(sums_, WIDTH);
    for (std::size_t c = 0; c < colloids_.size(); ++c) {
      const double *sum = &sums_[WIDTH * c];
      if (!(*sum > 0)) continue;
      auto &now = now_[c];
      auto from = now;
      for (int a = 0; a < D; ++a) from.v[a] += (2 * SHARE - 1) * (now.v[a] - colloids_[c].mean[a]);
      surfaces_[c] = solve(colloids_[c], from, sum);
      for (int a = 0; a < D; ++a) now.v[a] += (surfaces_[c].v[a] - from.v[a]) / SHARE;
      for (int s = 0; s < SPINS; ++s) now.spin[s] += 2 * (surfaces_[c].spin[s] - from.spin[s]);
    }
    std::fill(sums_.begin(), sums_.end(), 0.0);
  }

  bool reflect_next(Flight<D> &flight) override
  {
    const auto &decided = decided_[next_++];
    if (decided.contact.colloid < 0) return false;
    rebound(flight, decided.contact, decided.leaving);
    return true;
  }

 private:
  using Coupling<D>::impulses_;
  static constexpr int MOST_CONTACTS = 10;    // N_max
  static constexpr int AHEAD = 16;            // particles
  static constexpr double MOST_SPEED = 5;     // thermal speeds; of 1e5 two are faster
  static constexpr int SPINS = D == 2 ? 1 : 3;
  static constexpr int WIDTH = 1 + D + D * (D + 1) / 2 + D + SPINS;
  static constexpr double SHARE = D == 2 ? (1.5 + M_PI / 4) / 2 : (4.0 / 3 + M_PI / 6) / 2;    // (1 + r) / 2

  struct Sphere {
    Vector<D> x, v;
    double radius;
  };

  struct Contact {
    int colloid = -1;
    Vector<D> arm, v;    // from the centre to the contact; of the particle that comes
    double left;         // time from the contact to the end of the interval
  };

  struct Announced {
    Contact contact;
    Vector<D> leaving;
  };

  struct Surface {
    Vector<D> v;
    Spin<D> spin;
  };

  // Particles and colloids that they may have met, component by component: loops over them are
  // vectorised.
  struct Candidates {
    int count = 0;
    std::array<std::vector<double>, D> from, v;    // of the particle, relative to the colloid
    std::vector<double> square;                    // of the radius
    std::vector<int> particle, near;

    void make_room(std::size_t size)
    {
      if (size <= particle.size()) return;
      size *= 2;
      for (auto *each : {&from, &v})
        for (auto &components : *each) components.resize(size);
      square.resize(size);
      particle.resize(size);
      near.resize(size);
    }
  };

  // A particle, at the end of an interval, and the colloids within a square distance of its cell.
  void pair_up(const Particle<D> &p, int index, int cell, double within)
  {
    auto &all = candidates_;
    Vector<D> mean;
    for (int a = 0; a < D; ++a) mean[a] = p.v[a] - 0.5 * interval_ * field_[a];
    const auto *entry = cells_.begin(cell), *end = cells_.end(cell);
    all.make_room(all.count + (end - entry));
    for (; entry < end; ++entry) {
      const auto &sphere = spheres_[entry->colloid];
      for (int a = 0; a < D; ++a) {
        all.from[a][all.count] = p.x[a] - sphere.x[a];
        all.v[a][all.count] = mean[a] - sphere.v[a];
      }
      all.square[all.count] = sphere.radius * sphere.radius;
      all.particle[all.count] = index;
      all.count += entry->square < within;
    }
  }

  // Which of them are inside, or came closer than the radius on their way: find() looks closer.
  void may_have_met()
  {
    auto &all = candidates_;
    const double flown = placement_ == Placement::Entry ? interval_ * (1 + 1e-6) : 0.0;
    std::array<const double *, D> from, velocity;
    for (int a = 0; a < D; ++a) {
      from[a] = all.from[a].data();
      velocity[a] = all.v[a].data();
    }
    const Vector<D> box = cells_.grid().box, per_length = per_length_;
    const double *radius = all.square.data();
    int *near = all.near.data();
    const int count = all.count;
    for (int c = 0; c < count; ++c) {
      double approach = 0, speed = 0, distance = 0;
      for (int a = 0; a < D; ++a) {
        const double v = velocity[a][c];
        double apart = from[a][c];
        apart -= box[a] * std::rint(apart * per_length[a]);
        approach += v * apart;
        speed += v * v;
        distance += apart * apart;
      }
      const double inside = radius[c] - distance;
      near[c] = (inside > 0) | ((approach > 0) & (approach * approach + speed * inside > 0) &
                                (approach < flown * speed));
    }
  }

  // How far from the place of a colloid it may end who has met it.
  double distance(double speed, double flown) const
  {
    return largest_ + (placement_ == Placement::Entry ? (speed + fastest_) * flown : 0.0);
  }

  void remember(const Flight<D> &flight, const Contact &contact)
  {
    announced_.push_back({contact, {}});
    if (contact.colloid < 0) return;
    auto &leaves = announced_.back().leaving = leaving(flight, contact);
    const auto came = relative_to_rest(contact, leaves);
    double *sum = &sums_[WIDTH * contact.colloid];
    *sum++ += 1;
    for (int a = 0; a < D; ++a) *sum++ += contact.arm[a];
    for (int a = 0; a < D; ++a)
      for (int b = a; b < D; ++b) *sum++ += contact.arm[a] * contact.arm[b];
    for (double component : came) *sum++ += component;
    for (double component : torque(contact.arm, came)) *sum++ += component;
  }

  // Put a particle where it met a colloid, and let it fly from there with a velocity that it leaves
  // with in the frame of the surface.
  void rebound(Flight<D> &flight, const Contact &contact, Vector<D> v)
  {
    const auto &sphere = spheres_[contact.colloid];
    const auto &surface = surfaces_[contact.colloid];
    const auto turning = cross(surface.spin, contact.arm);
    Vector<D> x, impulse;
    for (int a = 0; a < D; ++a) {
      v[a] += surface.v[a] + turning[a];
      impulse[a] = contact.v[a] - v[a];
      x[a] = sphere.x[a] - contact.left * sphere.v[a] + contact.arm[a];
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
  }

  // From the nearest image.
  Vector<D> separation(const Vector<D> &x, const Vector<D> &place) const
  {
    Vector<D> from;
    for (int a = 0; a < D; ++a) {
      from[a] = x[a] - place[a];
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
    Vector<D> mean;    // velocity over its flight
    for (int a = 0; a < D; ++a) mean[a] = flight.v[a] - 0.5 * flight.flown * field_[a];
    cells_.each(cell, distance(std::sqrt(square<D>(flight.v)), flight.flown), [&](int c) {
      const auto &sphere = spheres_[c];
      const auto apart = separation(flight.x, sphere.x);
      const double inside = sphere.radius * sphere.radius - square<D>(apart);
      const double ago = placement_ == Placement::Entry
          ? entry(flight.flown, mean, sphere, apart, inside)
          : inside / (sphere.radius * sphere.radius);
      if (!(ago > most)) return;
      most = ago;
      from = apart;
      contact.colloid = c;
    });
    if (contact.colloid < 0) return contact;

    const auto &sphere = spheres_[contact.colloid];
    if (placement_ == Placement::Nearest)
      contact.left = 0.5 * interval_;
    else if (most > flight.flown)    // it never came in: it was inside before
      contact.left = 0.5 * flight.flown;
    else {
      contact.left = most;
      for (int a = 0; a < D; ++a) from[a] -= most * (mean[a] - sphere.v[a]);
    }
    const double scale = sphere.radius / std::sqrt(square<D>(from));
    for (int a = 0; a < D; ++a) {
      contact.arm[a] = scale * from[a];
      contact.v[a] = flight.v[a] - contact.left * field_[a];
    }
    return contact;
  }

  // How long ago a particle came in, on a straight way in the frame of the colloid, with its mean
  // velocity; -1 for one that did not, and more than it has flown for one that ends inside and was
  // there all the time. `inside` is the square of the radius less that of the distance.
  double entry(double flown, const Vector<D> &mean, const Sphere &sphere, const Vector<D> &from,
               double inside) const
  {
    double approach = 0, speed = 0;
    for (int a = 0; a < D; ++a) {
      const double v = mean[a] - sphere.v[a];
      approach += v * from[a];
      speed += v * v;
    }
    const double root = approach * approach + speed * inside;
    if (!(root > 0) || (inside <= 0 && approach <= 0)) return -1;
    const double ago = (approach + std::sqrt(root)) / speed;
    if (!(ago >= 0)) return -1;
    if (ago <= flown * (1 + 1e-9)) return std::min(ago, flown);    // rounding
    return inside > 0 ? 2 * flown : -1;
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
  // I (Omega' - Omega) = Q - sum r x (V + Omega x r), primed ones as they are after the contacts.
  static Surface solve(const Colloid<D> &colloid, const Surface &from, const double *sum)
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
      right[row] = *sum++ + inertia * (row < D ? from.v[row] : from.spin[row - D]);
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
      throw TooManyBounces::fault(static_cast<std::uint64_t>(flight.id));
  }

  Radii radii_;
  Placement placement_;
  double interval_, temperature_;
  Vector<D> field_;
  const Walls<D> *walls_;
  std::vector<Colloid<D>> colloids_;
  std::vector<Sphere> spheres_;
  Vector<D> per_length_{};              // of the box; 0 across walls
  double largest_ = 0, fastest_ = 0;    // radius; speed, with what the field adds to the fluid's
  double way_ = 0;                      // how far behind a colloid its contacts are looked for
  ColloidCells<D> cells_;
  std::vector<int> listed_;
  std::vector<double> within_;
  Candidates candidates_;
  std::vector<Announced> announced_, decided_;
  std::size_t next_ = 0;    // of those decided
  CounterRandom random_{0, 0};
  std::vector<double> sums_;
  std::vector<Surface> now_, surfaces_;    // colloids after the rounds so far; what particles see
};

}    // namespace mpc

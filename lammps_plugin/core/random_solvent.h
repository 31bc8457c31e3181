// Random solvents: a fluid without hydrodynamic interactions (tabatabaei-2009, 4.3).

#pragma once

#include "collision.h"
#include "processes.h"

namespace mpc {

// What it does is begun at the collision, and done to a block of the fluid when somebody asks for the
// velocities of after.
template <int D> class RandomSolvent {
 public:
  virtual ~RandomSolvent() = default;

  // Whether the collision is left out, as far as nobody but the fluid takes part in it. Then nobody
  // asks for the velocities of before.
  virtual bool replaces_collision() const = 0;

  virtual void begin(const Fluid<D> &, const CounterRandom &, double particles) = 0;
  virtual void collect(const Fluid<D> &, int /*begin*/, int /*end*/) {}    // the velocities of before
  virtual void share(Processes &) {}
  virtual void redraw(Fluid<D> &, int begin, int end) const = 0;

  virtual double bytes() const { return 0; }
};

// A random permutation of 0 ... p - 1, p the smallest prime that is not below a count of at most 2^32:
// i -> (factor i + term) mod p, factor and term random. It is one of 0 ... count - 1 when the few
// values from count on go through again.
class Permutation {
 public:
  explicit Permutation(std::uint64_t count) : count_(count), prime_(std::max<std::uint64_t>(count, 2))
  {
    while (!is_prime(prime_)) ++prime_;
  }

  std::uint64_t count() const { return count_; }
  std::uint64_t prime() const { return prime_; }

  void draw(const CounterRandom &random)
  {
    const auto u = uniforms(random.words(Stream::Shuffle, 0));
    factor_ = 1 + static_cast<std::uint64_t>(u[0] * static_cast<double>(prime_ - 1));
    term_ = static_cast<std::uint64_t>(u[1] * static_cast<double>(prime_));
  }

  // Vectorised in a loop. The quotient in floating point is wrong by one at most.
  std::uint64_t once(std::uint64_t number) const
  {
    const std::uint64_t product = factor_ * number + term_;
    const double quotient = static_cast<double>(product) * (1 / static_cast<double>(prime_));
    const std::uint64_t rest = product - static_cast<std::uint64_t>(quotient) * prime_;
    const auto signed_rest = static_cast<std::int64_t>(rest);
    return signed_rest < 0 ? rest + prime_ : rest >= prime_ ? rest - prime_ : rest;
  }

  // Of a number from count on, what it comes to below; or itself, in a cycle that nothing leads to.
  std::uint64_t below(std::uint64_t number) const
  {
    auto image = once(number);
    while (image >= count_ && image != number) image = once(image);
    return image;
  }

 private:
  static bool is_prime(std::uint64_t number)
  {
    for (std::uint64_t divisor = 2; divisor * divisor <= number; ++divisor)
      if (number % divisor == 0) return false;
    return true;
  }

  std::uint64_t count_, prime_, factor_ = 1, term_ = 0;
};

// Particle i takes the velocity of particle pi(i). Every process sees all velocities for this: a
// random permutation has no neighbourhood to keep to.
template <int D> class ShuffledSolvent : public RandomSolvent<D> {
 public:
  bool replaces_collision() const override { return false; }

  void begin(const Fluid<D> &fluid, const CounterRandom &random, double particles) override
  {
    const auto count = static_cast<std::uint64_t>(particles);
    if (permutation_.count() != count) permutation_ = Permutation(count);
    permutation_.draw(random);
    all_.resize(permutation_.prime());
    if (fluid.size() < particles) std::fill(all_.begin(), all_.end(), Pack<D>{});
  }

  void collect(const Fluid<D> &fluid, int begin, int end) override
  {
    for (int i = begin; i < end; ++i) {
      auto &velocity = all_[fluid.id[i]];
      if constexpr (D == 2)
        velocity = pack(fluid.v[0][i], fluid.v[1][i]);
      else
        velocity = pack(fluid.v[0][i], fluid.v[1][i], fluid.v[2][i]);
    }
  }

  void share(Processes &processes) override
  {
    auto *values = reinterpret_cast<double *>(all_.data());
    const auto count = permutation_.count(), size = count * (sizeof(Pack<D>) / sizeof(double));
    constexpr std::uint64_t MOST = 1 << 24;    // in a message
    for (std::uint64_t first = 0; first < size; first += MOST)
      processes.sum(values + first, static_cast<int>(std::min(MOST, size - first)));
    for (auto beyond = count; beyond < all_.size(); ++beyond)
      all_[beyond] = all_[permutation_.below(beyond)];
  }

  void redraw(Fluid<D> &fluid, int begin, int end) const override
  {
    constexpr int BLOCK = 128;    // particles
    std::array<std::uint32_t, BLOCK> other;
    for (int first = begin; first < end; first += BLOCK) {
      const int count = std::min(BLOCK, end - first);
      for (int i = 0; i < count; ++i) other[i] = permutation_.once(fluid.id[first + i]);
      for (int i = 0; i < count; ++i) {
        const auto velocity = all_[other[i]];
        for (int a = 0; a < D; ++a) fluid.v[a][first + i] = velocity[a];
      }
    }
  }

  double bytes() const override { return all_.capacity() * 1.0 * sizeof(Pack<D>); }

 private:
  Permutation permutation_{1};
  Array<Pack<D>> all_;    // of all processes, by number
};

// All velocities are drawn anew from the Maxwell distribution, by mixed words of the particles.
template <int D> class BathSolvent : public RandomSolvent<D> {
 public:
  explicit BathSolvent(double temperature) : speed_(std::sqrt(temperature)) {}

  bool replaces_collision() const override { return true; }

  void begin(const Fluid<D> &, const CounterRandom &random, double) override
  {
    words_ = random.mixed(Stream::Bath);
  }

  // In blocks, whose loops are vectorised.
  void redraw(Fluid<D> &fluid, int begin, int end) const override
  {
    constexpr int BLOCK = 128;    // particles
    std::array<std::uint64_t, BLOCK> numbers;
    std::array<std::array<double, BLOCK>, 4> u, z;
    for (int first = begin; first < end; first += BLOCK) {
      const int count = std::min(BLOCK, end - first);
      fluid.numbers(first, count, numbers.data());
      for (int k = 0; k < D + D % 2; ++k)    // normals come in pairs
        for (int i = 0; i < count; ++i)
          u[k][i] = uniform(words_.word(k, numbers[i]));
      for (int k = 0; k < D; k += 2)
        for (int i = 0; i < count; ++i) {
          const auto pair = normal_pair(u[k][i], u[k + 1][i]);
          z[k][i] = pair[0];
          z[k + 1][i] = pair[1];
        }
      for (int a = 0; a < D; ++a)
        for (int i = 0; i < count; ++i) fluid.v[a][first + i] = speed_ * z[a][i];
    }
  }

 private:
  double speed_;
  MixedWords words_{};
};

}    // namespace mpc

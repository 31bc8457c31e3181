// Random solvents: a fluid without hydrodynamic interactions (tabatabaei-2009, 4.3).

#pragma once

#include "fluid.h"
#include "processes.h"

namespace mpc {

template <int D> class RandomSolvent {
 public:
  virtual ~RandomSolvent() = default;

  // Whether the collision is left out.
  virtual bool replaces_collision() const = 0;
  virtual void redraw(Fluid<D> &, const CounterRandom &, Processes &, double particles) = 0;
};

// A keyed permutation of 0 ... count - 1: a Feistel network of eight rounds on 2 h bits, h the
// smallest with 4^h >= count; values from count on go through again.
class Permutation {
 public:
  Permutation(std::uint64_t count, const CounterRandom &random) : count_(count)
  {
    while (half_ < 32 && (std::uint64_t{1} << (2 * half_)) < count) ++half_;
    for (int item = 0; item < 2; ++item) {
      const auto words = random.words(Stream::Shuffle, item);
      for (int word = 0; word < 4; ++word) keys_[4 * item + word] = words[word];
    }
  }

  std::uint64_t operator()(std::uint64_t number) const
  {
    do number = once(number);
    while (number >= count_);
    return number;
  }

 private:
  std::uint64_t once(std::uint64_t number) const
  {
    const std::uint64_t mask = (std::uint64_t{1} << half_) - 1;
    std::uint64_t left = number >> half_, right = number & mask;
    for (std::uint64_t key : keys_) {
      const std::uint64_t mixed = left ^ (mix(right + key) & mask);
      left = right;
      right = mixed;
    }
    return left << half_ | right;
  }

  // The finaliser of SplitMix64.
  static std::uint64_t mix(std::uint64_t z)
  {
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
    z = (z ^ z >> 27) * 0x94D049BB133111EBu;
    return z ^ z >> 31;
  }

  std::uint64_t count_;
  int half_ = 1;
  std::array<std::uint64_t, 8> keys_;
};

// Particle i takes the velocity of particle pi(i). Every process sees all velocities for this: a
// random permutation has no neighbourhood to keep to.
template <int D> class ShuffledSolvent : public RandomSolvent<D> {
 public:
  bool replaces_collision() const override { return false; }

  void redraw(Fluid<D> &fluid, const CounterRandom &random, Processes &processes,
              double particles) override
  {
    const Permutation permutation(static_cast<std::uint64_t>(particles), random);
    std::vector<std::uint32_t> other(fluid.size());
    for (int i = 0; i < fluid.size(); ++i)
      other[i] = static_cast<std::uint32_t>(permutation(fluid.id[i]));
    std::vector<double> all(static_cast<std::size_t>(particles));
    for (auto &component : fluid.v) {
      std::fill(all.begin(), all.end(), 0.0);
      for (int i = 0; i < fluid.size(); ++i) all[fluid.id[i]] = component[i];
      processes.sum(all.data(), static_cast<int>(particles));
      for (int i = 0; i < fluid.size(); ++i) component[i] = all[other[i]];
    }
  }
};

// All velocities are drawn anew from the Maxwell distribution.
template <int D> class BathSolvent : public RandomSolvent<D> {
 public:
  explicit BathSolvent(double temperature) : speed_(std::sqrt(temperature)) {}

  bool replaces_collision() const override { return true; }

  void redraw(Fluid<D> &fluid, const CounterRandom &random, Processes &, double) override
  {
    for (int i = 0; i < fluid.size(); ++i) {
      const auto z = normals<D>(random.words(Stream::Bath, fluid.id[i]));
      for (int a = 0; a < D; ++a) fluid.v[a][i] = speed_ * z[a];
    }
  }

 private:
  double speed_;
};

}    // namespace mpc

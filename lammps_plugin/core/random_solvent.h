// Random solvents: a fluid without hydrodynamic interactions (tabatabaei-2009, 4.3).

#pragma once

#include "fluid.h"
#include "processes.h"

namespace mpc {

template <int D> class RandomSolvent {
 public:
  virtual ~RandomSolvent() = default;

  // Whether the collision is left out, as far as nobody but the fluid takes part in it.
  virtual bool replaces_collision() const = 0;
  virtual void redraw(Fluid<D> &, const CounterRandom &, Processes &, double particles) = 0;
};

// A keyed permutation of 0 ... count - 1: a Feistel network of eight rounds on the pairs (number /
// columns, number % columns), columns the smallest with columns^2 >= count. The few values from
// count on go through again.
class Permutation {
 public:
  Permutation(std::uint64_t count, const CounterRandom &random) : count_(count)
  {
    columns_ = static_cast<std::uint64_t>(std::sqrt(static_cast<double>(count)));
    while (columns_ * columns_ < count) ++columns_;
    rows_ = (count + columns_ - 1) / columns_;
    for (int item = 0; item < 2; ++item) {
      const auto words = random.words(Stream::Shuffle, item);
      for (int word = 0; word < 4; ++word) keys_[4 * item + word] = words[word];
    }
  }

  // Of many numbers at a time: the first loop is vectorised.
  void operator()(const std::uint32_t *numbers, std::uint32_t *images, int count) const
  {
    for (int i = 0; i < count; ++i) images[i] = once(numbers[i]);
    for (int i = 0; i < count; ++i)
      while (images[i] >= count_) images[i] = once(images[i]);
  }

 private:
  std::uint32_t once(std::uint32_t number) const
  {
    auto row = static_cast<std::uint64_t>(static_cast<double>(number) / columns_);
    auto column = number - row * columns_;
    for (int round = 0; round < 8; round += 2) {
      row = moved(row, column + keys_[round], rows_);
      column = moved(column, row + keys_[round + 1], columns_);
    }
    return static_cast<std::uint32_t>(row * columns_ + column);
  }

  // By a pseudorandom distance, around `count` places.
  static std::uint64_t moved(std::uint64_t place, std::uint64_t key, std::uint64_t count)
  {
    place += (mix(key) >> 32) * count >> 32;
    return place < count ? place : place - count;
  }

  // The finaliser of SplitMix64.
  static std::uint64_t mix(std::uint64_t z)
  {
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
    z = (z ^ z >> 27) * 0x94D049BB133111EBu;
    return z ^ z >> 31;
  }

  std::uint64_t count_, rows_, columns_;
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
    permutation(fluid.id.data(), other.data(), fluid.size());
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
    constexpr int words_used = D + D % 2;    // normals come in pairs
    std::array<std::array<double, BLOCK>, words_used> u;
    for (int begin = 0; begin < fluid.size(); begin += BLOCK) {
      const int count = std::min(BLOCK, fluid.size() - begin);
      for (int i = 0; i < count; ++i) {
        const auto words = random.words(Stream::Bath, fluid.number(begin + i));
        for (int word = 0; word < words_used; ++word) u[word][i] = uniform(words[word]);
      }
      for (int a = 0; a < D; a += 2) {
        double *first = fluid.v[a].data() + begin;
        double *second = a + 1 < D ? fluid.v[a + 1].data() + begin : unused_.data();
        for (int i = 0; i < count; ++i) {
          const auto z = normal_pair(u[a][i], u[a + 1][i]);
          first[i] = speed_ * z[0];
          second[i] = speed_ * z[1];
        }
      }
    }
  }

 private:
  static constexpr int BLOCK = 256;    // particles; their loops are vectorised

  double speed_;
  std::array<double, BLOCK> unused_;    // the fourth normal of each block in 3D
};

}    // namespace mpc

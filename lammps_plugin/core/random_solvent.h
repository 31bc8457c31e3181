// Random solvents: a fluid without hydrodynamic interactions (tabatabaei-2009, 4.3).

#pragma once

#include "fluid.h"
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

  virtual void begin(const Fluid<D> &, const CounterRandom &, Processes &, double particles) = 0;
  virtual void redraw(Fluid<D> &, int begin, int end) const = 0;
};

// The finaliser of SplitMix64, and what its numbers count on by.
inline std::uint64_t mix(std::uint64_t z)
{
  z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
  z = (z ^ z >> 27) * 0x94D049BB133111EBu;
  return z ^ z >> 31;
}
constexpr std::uint64_t SPLIT_MIX = 0x9E3779B97F4A7C15u;

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

  std::uint64_t count_, rows_, columns_;
  std::array<std::uint64_t, 8> keys_;
};

// Particle i takes the velocity of particle pi(i). Every process sees all velocities for this: a
// random permutation has no neighbourhood to keep to.
template <int D> class ShuffledSolvent : public RandomSolvent<D> {
 public:
  bool replaces_collision() const override { return false; }

  void begin(const Fluid<D> &fluid, const CounterRandom &random, Processes &processes,
             double particles) override
  {
    const Permutation permutation(static_cast<std::uint64_t>(particles), random);
    other_.resize(fluid.size());
    permutation(fluid.id.data(), other_.data(), fluid.size());
    for (int a = 0; a < D; ++a) {
      all_[a].assign(static_cast<std::size_t>(particles), 0.0);
      for (int i = 0; i < fluid.size(); ++i) all_[a][fluid.id[i]] = fluid.v[a][i];
      processes.sum(all_[a].data(), static_cast<int>(particles));
    }
  }

  void redraw(Fluid<D> &fluid, int begin, int end) const override
  {
    for (int a = 0; a < D; ++a)
      for (int i = begin; i < end; ++i) fluid.v[a][i] = all_[a][other_[i]];
  }

 private:
  std::vector<std::uint32_t> other_;
  std::array<std::vector<double>, D> all_;
};

// All velocities are drawn anew from the Maxwell distribution: word k of particle i is number i of
// SplitMix64 from key_k on, the keys being the four words of the collision's block of the stream.
template <int D> class BathSolvent : public RandomSolvent<D> {
 public:
  explicit BathSolvent(double temperature) : speed_(std::sqrt(temperature)) {}

  bool replaces_collision() const override { return true; }

  void begin(const Fluid<D> &, const CounterRandom &random, Processes &, double) override
  {
    keys_ = random.words(Stream::Bath, 0);
  }

  // In blocks, whose loops are vectorised.
  void redraw(Fluid<D> &fluid, int begin, int end) const override
  {
    constexpr int BLOCK = 128;    // particles
    std::array<std::array<double, BLOCK>, 4> u, z;
    for (int first = begin; first < end; first += BLOCK) {
      const int count = std::min(BLOCK, end - first);
      for (int k = 0; k < D + D % 2; ++k)    // normals come in pairs
        for (int i = 0; i < count; ++i)
          u[k][i] = uniform(mix(keys_[k] + (fluid.id[first + i] + std::uint64_t{1}) * SPLIT_MIX));
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
  Words keys_{};
};

}    // namespace mpc

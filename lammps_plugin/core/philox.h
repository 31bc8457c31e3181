// Counter-based random numbers: Philox4x64-10 (Salmon et al., SC11), as numpy.random.Philox.
//
// A number is a function of (seed, stream, collision, item), so it does not depend on the order of
// the work or on the number of processes. The contract is that of
// srd_driver/reference/counter_random.py, word for word: both engines draw the same numbers.

#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace mpc {

using Words = std::array<std::uint64_t, 4>;

inline Words philox(Words counter, std::uint64_t key0, std::uint64_t key1)
{
  for (int round = 0; round < 10; ++round) {
    const auto left = static_cast<unsigned __int128>(counter[0]) * 0xD2E7470EE14C6C93u;
    const auto right = static_cast<unsigned __int128>(counter[2]) * 0xCA5A826395121157u;
    counter = {static_cast<std::uint64_t>(right >> 64) ^ counter[1] ^ key0,
               static_cast<std::uint64_t>(right),
               static_cast<std::uint64_t>(left >> 64) ^ counter[3] ^ key1,
               static_cast<std::uint64_t>(left)};
    key0 += 0x9E3779B97F4A7C15u;
    key1 += 0xBB67AE8584CAA73Bu;
  }
  return counter;
}

// Second key of the generator. Create is not of the contract: the reference creates in numpy.
enum class Stream : std::uint64_t {
  Shift = 1,
  Rotation = 2,
  Wall = 3,
  Thermostat = 4,
  Shuffle = 5,
  Bath = 6,
  Create = 7
};

inline double uniform(std::uint64_t word)
{
  return static_cast<double>(word >> 11) * 0x1p-53;
}

inline std::array<double, 4> uniforms(const Words &words)
{
  return {uniform(words[0]), uniform(words[1]), uniform(words[2]), uniform(words[3])};
}

// The first `count` standard normals of a block, by Box and Muller; they come in pairs.
template <int count> std::array<double, 4> normals(const Words &words)
{
  const auto u = uniforms(words);
  std::array<double, 4> z{};
  for (int pair = 0; pair < count; pair += 2) {
    const double radius = std::sqrt(-2 * std::log1p(-u[pair]));
    const double angle = 2 * M_PI * u[pair + 1];
    z[pair] = radius * std::cos(angle);
    z[pair + 1] = radius * std::sin(angle);
  }
  return z;
}

// The random numbers of one collision.
struct CounterRandom {
  std::uint64_t seed;
  std::uint64_t collision;    // collisions done before this one

  Words words(Stream stream, std::uint64_t item, std::uint64_t block = 0) const
  {
    return philox({item + 1, collision, block, 0}, seed, static_cast<std::uint64_t>(stream));
  }
};

}    // namespace mpc

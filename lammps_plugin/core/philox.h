// Counter-based random numbers: Philox4x64-10 (Salmon et al., SC11), as numpy.random.Philox.
//
// A number is a function of (seed, stream, collision, item), so it does not depend on the order of
// the work or on the number of processes. The contract is that of
// srd_driver/reference/counter_random.py, word for word: both engines draw the same numbers.

#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

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
  Create = 7,
  Reflection = 8,
  Pair = 9
};

inline double uniform(std::uint64_t word)
{
  return static_cast<double>(word >> 11) * 0x1p-53;
}

inline std::array<double, 4> uniforms(const Words &words)
{
  return {uniform(words[0]), uniform(words[1]), uniform(words[2]), uniform(words[3])};
}

// ln w for w in (0, 1], and the cosine and sine of 2 pi u for u in [0, 1), to 4 roundings of the
// last digit. Written out as power series: loops over calls of the C library are not vectorised.
inline double logarithm(double w)
{
  std::uint64_t bits;
  std::memcpy(&bits, &w, sizeof bits);
  constexpr std::uint64_t fraction = 0x000FFFFFFFFFFFFF, one = 0x3FF0000000000000;
  const std::uint64_t mantissa_bits = (bits & fraction) | one;
  double mantissa, exponent = static_cast<double>(static_cast<std::int32_t>(bits >> 52) - 1023);
  std::memcpy(&mantissa, &mantissa_bits, sizeof mantissa);
  const bool large = mantissa > M_SQRT2;
  mantissa = large ? 0.5 * mantissa : mantissa;
  exponent = large ? exponent + 1 : exponent;
  const double s = (mantissa - 1) / (mantissa + 1), z = s * s;    // ln m = 2 artanh s, |s| < 0.172
  double series = 1.0 / 21;
  for (int k = 19; k > 0; k -= 2) series = series * z + 1.0 / k;
  return exponent * M_LN2 + 2 * s * series;
}

// 1 / k! for k = 0 ... 17.
constexpr std::array<double, 18> inverse_factorials()
{
  std::array<double, 18> inverses{1};
  double factorial = 1;    // exact: all are below 2^53
  for (int k = 1; k < 18; ++k) inverses[k] = 1 / (factorial *= k);
  return inverses;
}

// e^x for |x| < 700, in the same way; beyond it is no number of any use.
inline double exponential(double x)
{
  const int exponent = static_cast<int>(x * M_LOG2E + 1024.5) - 1024;    // the nearest
  const double y = (x - exponent * 0x1.62e42feep-1) - exponent * 0x1.a39ef35793c76p-33;    // ln 2
  constexpr auto inverse = inverse_factorials();
  double series = inverse[13];
  for (int k = 12; k >= 0; --k) series = inverse[k] + series * y;
  const std::uint64_t bits = static_cast<std::uint64_t>(static_cast<std::int64_t>(exponent) + 1023)
      << 52;
  double power;
  std::memcpy(&power, &bits, sizeof power);
  return power * series;
}

inline std::array<double, 2> cosine_and_sine_of_turn(double u)
{
  constexpr auto inverse = inverse_factorials();
  const int quarter = static_cast<int>(4 * u + 0.5);
  const double x = (4 * u - quarter) * M_PI_2, z = x * x;    // |x| <= pi / 4
  double c = inverse[16], s = inverse[17];
  for (int k = 14; k >= 0; k -= 2) {
    c = inverse[k] - z * c;
    s = inverse[k + 1] - z * s;
  }
  s *= x;
  const double cosine = quarter & 1 ? s : c, sine = quarter & 1 ? c : s;
  return {(quarter + 1) & 2 ? -cosine : cosine, quarter & 2 ? -sine : sine};
}

// Two standard normals from two uniforms, by Box and Muller.
inline std::array<double, 2> normal_pair(double u0, double u1)
{
  const double radius = std::sqrt(-2 * logarithm(1 - u0));
  const auto [cosine, sine] = cosine_and_sine_of_turn(u1);
  return {radius * cosine, radius * sine};
}

// The first `count` standard normals of a block; they come in pairs.
template <int count> std::array<double, 4> normals(const Words &words)
{
  const auto u = uniforms(words);
  std::array<double, 4> z{};
  for (int pair = 0; pair < count; pair += 2) {
    const auto [first, second] = normal_pair(u[pair], u[pair + 1]);
    z[pair] = first;
    z[pair + 1] = second;
  }
  return z;
}

// Number `number` of SplitMix64 (Steele, Lea and Flood, OOPSLA 2014), from 0 on.
inline std::uint64_t split_mix(std::uint64_t seed, std::uint64_t number)
{
  std::uint64_t z = seed + (number + 1) * 0x9E3779B97F4A7C15u;
  z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
  z = (z ^ z >> 27) * 0x94D049BB133111EBu;
  return z ^ z >> 31;
}

// Of a stream of which every item needs words: word k of item i is number i of SplitMix64 from key_k,
// the four keys a block of Philox. One for each item would take longer than all else that is done to
// a cell's velocities, or to a particle.
struct MixedWords {
  Words keys;

  std::uint64_t word(int k, std::uint64_t item) const { return split_mix(keys[k], item); }
};

// The random numbers of one collision.
struct CounterRandom {
  std::uint64_t seed;
  std::uint64_t collision;    // collisions done before this one

  Words words(Stream stream, std::uint64_t item, std::uint64_t block = 0) const
  {
    return philox({item + 1, collision, block, 0}, seed, static_cast<std::uint64_t>(stream));
  }

  MixedWords mixed(Stream stream) const { return {words(stream, 0)}; }
};

}    // namespace mpc

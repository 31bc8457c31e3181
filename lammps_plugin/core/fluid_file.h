// The fluid as it rests in files and restarts: whatever the bytes are, it is read, or a Fault says
// in one line why not. Sizes are checked before memory is asked for.

#pragma once

#include "fluid.h"

#include <cmath>
#include <cstdio>
#include <cstring>
#include <vector>

namespace mpc {

constexpr char FLUID_FILE[8] = {'m', 'p', 'c', 'f', 'l', 'u', 'i', 'd'};
constexpr char RESTART[8] = {'m', 'p', 'c', 's', 't', 'a', 't', 'e'};
constexpr char RESTART_APART[8] = {'m', 'p', 'c', 'a', 'p', 'a', 'r', 't'};

// By words of 8 bytes, each step one-to-one: any word that changes changes it.
class Checksum {
 public:
  void add(const void *data, std::size_t bytes)
  {
    const char *next = static_cast<const char *>(data);
    for (; bytes >= sizeof(std::uint64_t); bytes -= sizeof(std::uint64_t)) {
      std::uint64_t word;
      std::memcpy(&word, next, sizeof word);
      value_ = (value_ ^ word) * 0x9e3779b97f4a7c15;
      value_ ^= value_ >> 32;    // else two changes of highest bits cancel
      next += sizeof word;
    }
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325;
};

// Of particles in a file, from a place on: what processes have of their parts adds up to that of all.
template <int D>
std::uint64_t checksum(const Particle<D> *particles, std::size_t count, std::uint64_t place)
{
  std::uint64_t total = 0;
  for (std::size_t n = 0; n < count; ++n, ++place) {
    Checksum sum;
    sum.add(&place, sizeof place);
    sum.add(&particles[n], sizeof particles[n]);
    total += sum.value();
  }
  return total;
}

// Where the particles of a restart are that are not in it, and what they are.
struct Apart {
  std::uint64_t checksum;
  char file[4096];    // ends with a 0
};

// What a restart begins with, before the pulls on the colloids, the average of the flow under way,
// the particles, or the file that they are in, and a checksum.
struct RestartHeader {
  FluidHeader fluid;
  std::int32_t processes;
  std::int32_t single;             // whether the state is in single precision; 0 in older ones
  std::int64_t pulls, averages;
  std::uint64_t seed, checksum;    // the latter of what stands before it

  std::uint64_t expected() const
  {
    Checksum sum;
    sum.add(this, sizeof *this - sizeof checksum);
    return sum.value();
  }
  bool apart() const { return !std::memcmp(fluid.magic, RESTART_APART, sizeof RESTART_APART); }
};

inline RestartHeader restart_header(bool apart, bool single, int dimension, std::int64_t particles,
                                    std::int64_t collisions, int processes, std::int64_t pulls,
                                    std::int64_t averages, std::uint64_t seed)
{
  RestartHeader header{
      {{}, dimension, particles, collisions}, processes, single, pulls, averages, seed, 0};
  std::memcpy(header.fluid.magic, apart ? RESTART_APART : RESTART, sizeof RESTART);
  header.checksum = header.expected();
  return header;
}

// The header of a restart of D dimensions, that seed and precision; the buffer holds at least one.
template <int D>
RestartHeader read_restart_header(const char *buffer, std::uint64_t seed, bool single)
{
  RestartHeader header;
  std::memcpy(&header, buffer, sizeof header);
  if (std::memcmp(header.fluid.magic, RESTART, sizeof RESTART) && !header.apart())
    throw Fault("restart: not of this version of fix mpc");
  if (header.checksum != header.expected()) throw Fault("restart: damaged");
  if (header.fluid.dimension != D) throw Fault("restart: of another dimension");
  if (header.seed != seed)
    throw Fault("restart: of the seed " + std::to_string(header.seed) + ", not " +
                std::to_string(seed));
  if (header.single != single)
    throw Fault(std::string("restart: of precision ") + (header.single ? "single" : "double") +
                ", not " + (single ? "single" : "double") + "; fix_modify save and load change it");
  return header;
}

// Visit the pulls, the numbers of an average, then the particles of a restart or the word of where
// they are, once all are known to be what was written.
template <int D, class Pull, class OnPull, class OnAverage, class OnParticle, class OnApart>
RestartHeader read_restart(const char *buffer, std::uint64_t seed, bool single,
                           const OnPull &on_pull, const OnAverage &on_average,
                           const OnParticle &on_particle, const OnApart &on_apart)
{
  const auto header = read_restart_header<D>(buffer, seed, single);
  const char *next = buffer + sizeof header;
  const std::size_t bytes =
      header.pulls * sizeof(Pull) + header.averages * sizeof(double) +
      (header.apart() ? sizeof(Apart) : header.fluid.particles * sizeof(Particle<D>));
  Checksum sum;
  sum.add(next, bytes);
  std::uint64_t checksum;
  std::memcpy(&checksum, next + bytes, sizeof checksum);
  if (checksum != sum.value()) throw Fault("restart: damaged");
  for (std::int64_t n = 0; n < header.pulls; ++n, next += sizeof(Pull)) {
    Pull pull;
    std::memcpy(&pull, next, sizeof pull);
    on_pull(pull);
  }
  for (std::int64_t n = 0; n < header.averages; ++n, next += sizeof(double)) {
    double average;
    std::memcpy(&average, next, sizeof average);
    on_average(average);
  }
  if (header.apart()) {
    Apart apart;
    std::memcpy(&apart, next, sizeof apart);
    if (!std::memchr(apart.file, 0, sizeof apart.file)) throw Fault("restart: damaged");
    on_apart(apart);
    return header;
  }
  for (std::int64_t n = 0; n < header.fluid.particles; ++n, next += sizeof(Particle<D>)) {
    Particle<D> particle;
    std::memcpy(&particle, next, sizeof particle);
    on_particle(particle);
  }
  return header;
}

// The header of a file of that many bytes, of a fluid in D dimensions.
template <int D>
void check_fluid_header(const FluidHeader &header, std::uint64_t bytes,
                        const char (&magic)[8] = FLUID_FILE)
{
  if (std::memcmp(header.magic, magic, sizeof magic) || header.dimension != D ||
      header.particles < 1)
    throw Fault("not a fluid in " + std::to_string(D) + " dimensions");
  const std::uint64_t most = (bytes - sizeof header) / sizeof(Particle<D>);
  if (static_cast<std::uint64_t>(header.particles) != most ||
      (bytes - sizeof header) % sizeof(Particle<D>))
    throw Fault(std::to_string(bytes) + " bytes do not hold " + std::to_string(header.particles) +
                " particles");
}

inline std::string short_number(double number)
{
  char text[32];
  std::snprintf(text, sizeof text, "%g", number);
  return text;
}

// Stop at a number that no particle of so many has.
inline void check_number(double number, std::int64_t particles)
{
  if (!(number >= 0 && number < static_cast<double>(particles) && number == std::floor(number)))
    throw Fault("a particle " + short_number(number) + ": numbers are whole, from 0 to " +
                std::to_string(particles - 1));
}

// Stop at a number that is known already, of those from `first` on.
inline void check_new(std::int64_t number, std::int64_t first, std::vector<bool> &known)
{
  if (known[number - first]) throw Fault("two particles " + std::to_string(number));
  known[number - first] = true;
}

}    // namespace mpc

// Damaged fluids and restarts given to the readers of the plugin: they must be read as they were
// written, or refused. Arguments: cases, seed. The sanitizers watch.

#include "fluid_file.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>

using namespace mpc;

namespace {

constexpr int D = 2;
constexpr std::uint64_t SEED = 7;

struct Pull {
  double process, id;
  Vector<D> x, force;
};

using Bytes = std::vector<char>;
using Chance = std::mt19937_64;

template <class Record> void append(Bytes &bytes, const Record &record)
{
  const char *data = reinterpret_cast<const char *>(&record);
  bytes.insert(bytes.end(), data, data + sizeof record);
}

std::vector<Particle<D>> some_particles(Chance &chance, int count)
{
  std::uniform_real_distribution<double> place(0, 10);
  std::vector<Particle<D>> particles(count);
  for (int n = 0; n < count; ++n)
    particles[n] = {static_cast<double>(n), {place(chance), place(chance)}, {place(chance), 0}};
  return particles;
}

Bytes fluid_file(const std::vector<Particle<D>> &particles)
{
  FluidHeader header{{}, D, static_cast<std::int64_t>(particles.size()), 3};
  std::memcpy(header.magic, FLUID_FILE, sizeof FLUID_FILE);
  Bytes bytes;
  append(bytes, header);
  for (const auto &particle : particles) append(bytes, particle);
  return bytes;
}

Bytes restart(const std::vector<Particle<D>> &particles, int pulls, int averages, bool apart,
              bool single)
{
  Bytes bytes, records;
  append(bytes, restart_header(apart, single, D, particles.size(), 3, 1, pulls, averages, SEED));
  for (int n = 0; n < pulls; ++n) append(records, Pull{0, 1.0 * n, {1, 2}, {3, 4}});
  for (int n = 0; n < averages; ++n) append(records, 1.5 * n);
  if (apart)
    append(records, Apart{checksum<D>(particles.data(), particles.size(), 0), "/a.fluid"});
  else
    for (const auto &particle : particles) append(records, particle);
  Checksum sum;
  sum.add(records.data(), records.size());
  bytes.insert(bytes.end(), records.begin(), records.end());
  append(bytes, sum.value());
  return bytes;
}

void damage(Bytes &bytes, Chance &chance, bool keep_size)
{
  const auto at = [&] { return bytes.empty() ? 0 : chance() % bytes.size(); };
  switch (chance() % (keep_size ? 4 : 6)) {
    case 0: bytes[at()] ^= static_cast<char>(1 << chance() % 8); break;
    case 1:
      for (auto n = chance() % 16; n > 0; --n) bytes[at()] = static_cast<char>(chance());
      break;
    case 2: {    // a word, of those that counts and sizes fear
      const std::uint64_t words[] = {0, 1, ~0ull, 1ull << 62, 1ull << 32, 0x7ff8000000000000ull};
      const auto word = words[chance() % 6];
      const auto place = std::min<std::size_t>(at() / 8 * 8, bytes.size() - 8);
      std::memcpy(&bytes[place], &word, sizeof word);
      break;
    }
    case 3: std::rotate(bytes.begin(), bytes.begin() + at() / 8 * 8, bytes.end()); break;
    case 4: bytes.resize(at()); break;
    default: bytes.insert(bytes.end(), 1 + chance() % 80, 'x');
  }
}

// In memory of just that size, so that the sanitizer sees a byte too far.
std::unique_ptr<char[]> exactly(const Bytes &bytes)
{
  std::unique_ptr<char[]> copy(new char[bytes.size()]);
  std::copy(bytes.begin(), bytes.end(), copy.get());
  return copy;
}

// Whether it was refused; as fix mpc does it.
bool load(const Bytes &bytes)
{
  try {
    if (bytes.size() < sizeof(FluidHeader)) throw Fault("not a fluid");
    const auto memory = exactly(bytes);
    FluidHeader header;
    std::memcpy(&header, memory.get(), sizeof header);
    check_fluid_header<D>(header, bytes.size());
    std::vector<bool> known(header.particles);
    for (std::int64_t n = 0; n < header.particles; ++n) {
      Particle<D> particle;
      std::memcpy(&particle, memory.get() + sizeof header + n * sizeof particle, sizeof particle);
      check_number(particle.id, header.particles);
      check_new(static_cast<std::int64_t>(particle.id), 0, known);
    }
    return false;
  } catch (const Fault &) {
    return true;
  }
}

bool read(const Bytes &bytes, bool single, std::vector<Particle<D>> &particles)
{
  try {
    const auto memory = exactly(bytes);
    read_restart<D, Pull>(
        memory.get(), SEED, single, [](const Pull &) {}, [](double) {},
        [&](const Particle<D> &particle) { particles.push_back(particle); },
        [](const Apart &apart) { if (apart.file[0] != '/') std::abort(); });
    return false;
  } catch (const Fault &) {
    return true;
  }
}

// What is wrong with the checksum of a file apart: it is the same in parts, as processes read it, and
// another of any other file.
std::string file_apart(std::vector<Particle<D>> particles, Chance &chance)
{
  const auto count = particles.size(), part = chance() % (count + 1);
  const auto of_all = checksum<D>(particles.data(), count, 0);
  if (of_all != checksum<D>(particles.data(), part, 0) +
          checksum<D>(particles.data() + part, count - part, part))
    return "parts do not add up";
  const auto before = particles;
  Bytes bytes(count * sizeof(Particle<D>));
  std::memcpy(bytes.data(), particles.data(), bytes.size());
  damage(bytes, chance, true);
  std::memcpy(static_cast<void *>(particles.data()), bytes.data(), bytes.size());
  const bool same = !std::memcmp(before.data(), bytes.data(), bytes.size());
  if ((checksum<D>(particles.data(), count, 0) == of_all) != same)
    return same ? "whole, but refused" : "damaged, but taken";
  return {};
}

}    // namespace

int main(int, char **argv)
{
  const long cases = std::atol(argv[1]);
  Chance chance(std::atol(argv[2]));
  long refused = 0;
  for (long n = 0; n < cases; ++n) {
    const auto particles = some_particles(chance, 1 + chance() % 30);
    const auto file = fluid_file(particles);
    auto damaged = file;
    damage(damaged, chance, false);
    refused += load(damaged);
    const bool single = chance() % 2;
    const auto whole = restart(particles, chance() % 4, 3, chance() % 2, single);
    auto other = whole;
    damage(other, chance, true);    // LAMMPS reads as many bytes as it wrote
    const auto differing = file_apart(particles, chance);
    if (!differing.empty()) {
      std::printf("case %ld: %s\n", n, differing.c_str());
      return 1;
    }
    std::vector<Particle<D>> found;
    const bool no = read(other, single, found);
    refused += no;
    if (no == (other == whole)) {
      std::printf("case %ld: a restart that is %s was %s\n", n, other == whole ? "whole" : "damaged",
                  no ? "refused" : "read");
      return 1;
    }
    if (!read(whole, !single, found)) {
      std::printf("case %ld: a restart of the other precision was read\n", n);
      return 1;
    }
  }
  std::printf("%ld cases of each, %ld refused\n", cases, refused);
}

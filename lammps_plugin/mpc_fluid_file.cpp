#include "mpc_fluid_file.h"

#include "comm.h"
#include "domain.h"
#include "error.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using mpc::Particle;

namespace {

// The particles of such a file, which all processes see.
template <int D> class ParticleFile {
 public:
  ParticleFile(const std::string &name, const char *mode) : file_(std::fopen(name.c_str(), mode)) {}
  ~ParticleFile()
  {
    if (file_) std::fclose(file_);
  }
  ParticleFile(const ParticleFile &) = delete;
  ParticleFile &operator=(const ParticleFile &) = delete;

  // From a place on; whether all could be.
  bool read(std::int64_t place, std::vector<Particle<D>> &particles)
  {
    const auto count = particles.size();
    return go_to(place) && std::fread(particles.data(), sizeof particles[0], count, file_) == count;
  }

  bool write(std::int64_t place, const std::vector<Particle<D>> &particles)
  {
    const auto count = particles.size();
    return go_to(place) && std::fwrite(particles.data(), sizeof particles[0], count, file_) == count;
  }

  // Whether the disk has what was written.
  bool reach_disk() { return file_ && !std::fflush(file_) && !fsync(fileno(file_)); }

 private:
  bool go_to(std::int64_t place)
  {
    const auto offset = static_cast<off_t>(sizeof(mpc::FluidHeader) + place * sizeof(Particle<D>));
    return file_ && !fseeko(file_, offset, SEEK_SET);
  }

  FILE *file_;
};

}    // namespace

template <int D>
MpcFluidFile<D>::MpcFluidFile(LAMMPS *lmp, mpc::AnySolver<D> &solver, MpcState<D> &state,
                              MpiProcesses &processes) :
    Pointers(lmp), solver_(solver), state_(state), processes_(processes)
{
}

template <int D>
mpc::FluidHeader MpcFluidFile<D>::read_header(LAMMPS *lmp, const std::string &name, const char *why,
                                              const char (&magic)[8])
{
  struct {
    mpc::FluidHeader header;
    char problem[1024];
  } seen{};
  if (lmp->comm->me == 0) {
    try {
      FILE *file = std::fopen(name.c_str(), "rb");
      if (!file) throw mpc::Fault("cannot be read");
      const bool whole = std::fread(&seen.header, sizeof seen.header, 1, file) == 1;
      std::fseek(file, 0, SEEK_END);
      const auto bytes = static_cast<std::uint64_t>(std::ftell(file));
      std::fclose(file);
      if (!whole) throw mpc::Fault("not a fluid in " + std::to_string(D) + " dimensions");
      mpc::check_fluid_header<D>(seen.header, bytes, magic);
    } catch (const mpc::Fault &fault) {
      std::strncpy(seen.problem, fault.what(), sizeof seen.problem - 1);
    }
  }
  MPI_Bcast(&seen, sizeof seen, MPI_BYTE, 0, lmp->world);
  if (seen.problem[0]) lmp->error->all(FLERR, "fix mpc: {}: {}: {}", why, name, seen.problem);
  return seen.header;
}

template <int D> double MpcFluidFile<D>::particles_in(LAMMPS *lmp, const std::string &name)
{
  return static_cast<double>(read_header(lmp, name, "load", mpc::FLUID_FILE).particles);
}

template <int D> void MpcFluidFile<D>::load(const std::string &name)
{
  const auto header = read_header(lmp, name, "load", mpc::FLUID_FILE);
  solver_.reset(header.collisions, state_.lower(), state_.upper());
  std::vector<double> numbers;
  numbers.reserve(state_.share(header.particles, comm->me + 1) -
                  state_.share(header.particles, comm->me));
  read(name, "load", header.particles, [&](std::int64_t, auto &particles) {
    for (auto &particle : particles) {
      check(particle, header.particles, name);
      numbers.push_back(particle.id);
      for (int a = 0; a < D; ++a) particle.x[a] -= domain->boxlo[a];
    }
  });
  solver_.count();
  check_each_once(std::move(numbers), header.particles, name);
}

template <int D>
void MpcFluidFile<D>::read(const std::string &name, const char *why, std::int64_t particles,
                           const typename MpcState<D>::Fill &visit)
{
  ParticleFile<D> file(name, "rb");
  state_.distribute(particles, [&](std::int64_t place, auto &chunk) {
    if (!file.read(place, chunk))
      error->one(FLERR, "fix mpc: {}: {} ends before its {} particles", why, name, particles);
    visit(place, chunk);
  });
}

// Stop at a particle that cannot be.
template <int D>
void MpcFluidFile<D>::check(const Particle<D> &particle, std::int64_t particles,
                            const std::string &name) const
{
  try {
    mpc::check_number(particle.id, particles);
  } catch (const mpc::Fault &fault) {
    error->one(FLERR, "fix mpc: load: {} has {}", name, fault.what());
  }
  for (int a = 0; a < D; ++a) {
    const double x = particle.x[a];
    if (!std::isfinite(x) ||
        (!domain->periodicity[a] && (x < domain->boxlo[a] || x > domain->boxhi[a])))
      error->one(FLERR, "fix mpc: load: particle {} of {} has {} = {}: not a number, or beyond a wall",
                 particle.id, name, "xyz"[a], x);
  }
}

// The numbers 0 ... N - 1 are each of one particle: each process looks at its share of them.
template <int D>
void MpcFluidFile<D>::check_each_once(std::vector<double> numbers, std::int64_t particles,
                                      const std::string &name)
{
  const auto home = [&](double number) {
    int process = static_cast<int>(number / static_cast<double>(particles) * comm->nprocs);
    while (number < state_.share(particles, process)) --process;
    while (number >= state_.share(particles, process + 1)) ++process;
    return process;
  };
  const auto first = state_.share(particles, comm->me);
  std::vector<bool> known(state_.share(particles, comm->me + 1) - first);
  try {
    for (double number : processes_.deliver(std::move(numbers), home))
      mpc::check_new(static_cast<std::int64_t>(number), first, known);
  } catch (const mpc::Fault &fault) {
    error->one(FLERR, "fix mpc: load: {} has {}", name, fault.what());
  }
}

template <int D> mpc::FluidHeader MpcFluidFile<D>::fluid_header(const char (&magic)[8]) const
{
  mpc::FluidHeader header{{}, D, static_cast<std::int64_t>(solver_.particles()),
                          static_cast<std::int64_t>(solver_.collisions())};
  std::memcpy(header.magic, magic, sizeof magic);
  return header;
}

template <int D>
std::uint64_t MpcFluidFile<D>::write(const std::string &name, const char *why,
                                     const char (&magic)[8], const double *origin)
{
  solver_.turn();
  const auto require = [&](bool written) {
    if (processes_.any(!written)) error->all(FLERR, "fix mpc: {}: cannot write {}", why, name);
  };
  bool written = true;
  if (comm->me == 0) {
    const auto header = fluid_header(magic);
    FILE *file = std::fopen(name.c_str(), "wb");
    written = file && std::fwrite(&header, sizeof header, 1, file) == 1;
    written = file && !std::fclose(file) && written;
  }
  require(written);

  const std::int64_t count = solver_.size();
  std::int64_t place = 0;
  MPI_Exscan(&count, &place, 1, MPI_INT64_T, MPI_SUM, world);
  ParticleFile<D> file(name, "r+b");
  std::uint64_t sum = 0;
  std::vector<Particle<D>> chunk;
  for (int i = 0; i < count && written; place += chunk.size()) {
    chunk.clear();
    for (; i < count && chunk.size() < MpcState<D>::CHUNK; ++i) {
      chunk.push_back(solver_.particle(i));
      for (int a = 0; a < D; ++a) chunk.back().x[a] += origin[a];
    }
    sum += mpc::checksum<D>(chunk.data(), chunk.size(), place);
    written = file.write(place, chunk);
  }
  require(written && file.reach_disk());
  MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_UINT64_T, MPI_SUM, world);
  return sum;
}

template <int D> void MpcFluidFile<D>::save(const std::string &name)
{
  write(name, "save", mpc::FLUID_FILE, domain->boxlo);
}

template class LAMMPS_NS::MpcFluidFile<2>;
template class LAMMPS_NS::MpcFluidFile<3>;

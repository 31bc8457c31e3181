#include "mpc_state.h"

#include "core/fluid_file.h"

#include "comm.h"
#include "domain.h"
#include "error.h"

#include <algorithm>
#include <climits>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using mpc::Colloid;
using mpc::Particle;
using mpc::Vector;

namespace {

constexpr std::uint64_t MOST_TRIALS = 100000;    // to place a particle outside the colloids

// A file of a fluid, its header read.
template <int D>
FILE *open_fluid(Error &error, const std::string &name, mpc::FluidHeader &header)
{
  FILE *file = std::fopen(name.c_str(), "rb");
  if (!file) error.one(FLERR, "fix mpc: load: cannot read {}", name);
  if (std::fread(&header, sizeof header, 1, file) != 1)
    error.one(FLERR, "fix mpc: load: {} is not a fluid in {} dimensions", name, D);
  std::fseek(file, 0, SEEK_END);
  try {
    mpc::check_fluid_header<D>(header, static_cast<std::uint64_t>(std::ftell(file)));
  } catch (const mpc::Fault &fault) {
    error.one(FLERR, "fix mpc: load: {}: {}", name, fault.what());
  }
  std::fseek(file, sizeof header, SEEK_SET);
  return file;
}

}    // namespace

template <int D>
MpcState<D>::MpcState(LAMMPS *lmp, const MpcArguments<D> &given, mpc::AnySolver<D> &solver) :
    Pointers(lmp), given_(given), solver_(solver)
{
}

// The first of this process's cells, from a corner of its sub-domain.
template <int D> std::array<int, D> MpcState<D>::bound(const double *corner) const
{
  std::array<int, D> cells;
  for (int a = 0; a < D; ++a)
    cells[a] = static_cast<int>(std::floor((corner[a] - domain->boxlo[a]) / given_.edge + 0.5));
  return cells;
}

template <int D> std::array<int, D> MpcState<D>::lower() const
{
  return bound(domain->sublo);
}

// Beyond the last sub-domain is the row of cells that only walls have.
template <int D> std::array<int, D> MpcState<D>::upper() const
{
  auto cells = bound(domain->subhi);
  for (int a = 0; a < D; ++a)
    if (comm->myloc[a] == comm->procgrid[a] - 1) cells[a] = solver_.grid().shape[a];
  return cells;
}

// Uniform outside the colloids, Maxwell velocities, no momentum; a function of the seed and the
// particle's number alone, so every process draws all and keeps its own.
template <int D> void MpcState<D>::create(const std::vector<Colloid<D>> &colloids,
                                          const mpc::Coupling<D> *coupling)
{
  solver_.reset(0, lower(), upper());
  const auto overlaps = [&](const Vector<D> &x) {
    for (const auto &colloid : colloids) {
      Vector<D> separation;
      for (int a = 0; a < D; ++a) {
        separation[a] = x[a] - colloid.x[a];
        if (domain->periodicity[a])
          separation[a] -= domain->prd[a] * std::round(separation[a] / domain->prd[a]);
      }
      const double room = coupling->room(colloid.type);
      if (mpc::square<D>(separation) < room * room) return true;
    }
    return false;
  };
  const mpc::CounterRandom random{given_.seed, 0};
  for (double number = 0; number < given_.particles; ++number) {
    const auto item = static_cast<std::uint64_t>(number);
    Particle<D> particle{number, {}, {}};
    std::uint64_t trial = 0;
    do {
      if (++trial > MOST_TRIALS)
        error->all(FLERR, "fix mpc: create {}: the colloids leave no room", given_.particles);
      const auto u = mpc::uniforms(random.words(mpc::Stream::Create, item, trial));
      for (int a = 0; a < D; ++a) particle.x[a] = u[a] * domain->prd[a];
    } while (overlaps(particle.x));
    const auto z = mpc::normals<D>(random.words(mpc::Stream::Create, item));
    for (int a = 0; a < D; ++a) particle.v[a] = std::sqrt(given_.temperature) * z[a];
    solver_.add(particle);
  }
  solver_.count();
  solver_.zero_momentum();
}

template <int D> double MpcState<D>::particles_in(Error &error, const std::string &name)
{
  mpc::FluidHeader header;
  std::fclose(open_fluid<D>(error, name, header));
  return static_cast<double>(header.particles);
}

template <int D> void MpcState<D>::load(const std::string &name)
{
  mpc::FluidHeader header;
  FILE *file = open_fluid<D>(*error, name, header);
  solver_.reset(header.collisions, lower(), upper());
  std::vector<bool> known(header.particles);
  Particle<D> particle;
  for (std::int64_t n = 0; n < header.particles; ++n) {
    if (std::fread(&particle, sizeof particle, 1, file) != 1)
      error->one(FLERR, "fix mpc: load: {} ends before its {} particles", name, header.particles);
    check(particle, known, name);
    for (int a = 0; a < D; ++a) particle.x[a] -= domain->boxlo[a];
    solver_.add(particle);
  }
  std::fclose(file);
  solver_.count();
}

// Stop at a particle that cannot be; the numbers 0 ... N - 1 are each of one particle.
template <int D>
void MpcState<D>::check(const Particle<D> &particle, std::vector<bool> &known,
                        const std::string &name) const
{
  try {
    mpc::check_number(particle, known);
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

// Visit the particles of all processes on the first, process by process.
template <int D> template <class Visit> void MpcState<D>::gather(const Visit &visit)
{
  solver_.turn();
  constexpr int CHUNK = 1 << 16;
  constexpr int record = sizeof(Particle<D>) / sizeof(double);
  std::vector<Particle<D>> chunk;
  for (int p = 0; p < comm->nprocs; ++p) {
    if (comm->me != 0 && comm->me != p) continue;
    int left = solver_.size();
    if (p > 0 && comm->me == p) MPI_Send(&left, 1, MPI_INT, 0, 0, world);
    if (p > 0 && comm->me == 0) MPI_Recv(&left, 1, MPI_INT, p, 0, world, MPI_STATUS_IGNORE);
    for (int done = 0; left > 0;) {
      chunk.resize(std::min(left, CHUNK));
      const int count = static_cast<int>(chunk.size());
      if (comm->me == p)
        for (int i = 0; i < count; ++i) chunk[i] = solver_.particle(done + i);
      if (p > 0 && comm->me == p) MPI_Send(chunk.data(), count * record, MPI_DOUBLE, 0, 0, world);
      if (p > 0 && comm->me == 0)
        MPI_Recv(chunk.data(), count * record, MPI_DOUBLE, p, 0, world, MPI_STATUS_IGNORE);
      if (comm->me == 0) visit(chunk);
      done += count;
      left -= count;
    }
  }
}

template <int D> mpc::FluidHeader MpcState<D>::fluid_header() const
{
  mpc::FluidHeader header{{}, D, static_cast<std::int64_t>(solver_.particles()),
                          static_cast<std::int64_t>(solver_.collisions())};
  std::memcpy(header.magic, mpc::FLUID_FILE, sizeof mpc::FLUID_FILE);
  return header;
}

template <int D> void MpcState<D>::save(const std::string &name)
{
  FILE *file = nullptr;
  const auto header = fluid_header();
  bool written = true;
  if (comm->me == 0) {
    file = std::fopen(name.c_str(), "wb");
    if (!file) error->one(FLERR, "fix mpc: save: cannot write {}", name);
    written = std::fwrite(&header, sizeof header, 1, file) == 1;
  }
  gather([&](std::vector<Particle<D>> &particles) {
    for (auto &particle : particles)
      for (int a = 0; a < D; ++a) particle.x[a] += domain->boxlo[a];
    written &= std::fwrite(particles.data(), sizeof particles[0], particles.size(), file) ==
        particles.size();
  });
  if (comm->me == 0 && (std::fclose(file) || !written))
    error->one(FLERR, "fix mpc: save: cannot write {}", name);
}

// The whole fluid in the order each process has it, and the last forces on the colloids: orders and
// forces decide the last bits, so that a continued run repeats an uninterrupted one.
template <int D>
void MpcState<D>::write_restart(FILE *file, const std::vector<Pull<D>> &pulls,
                                const std::vector<double> &average)
{
  mpc::Checksum sum;
  const double bytes = sizeof(mpc::RestartHeader) + pulls.size() * sizeof(Pull<D>) +
      average.size() * sizeof(double) + solver_.particles() * sizeof(Particle<D>) + sizeof sum.value();
  if (bytes > INT_MAX)
    error->all(FLERR, "fix mpc: restart: {} particles are too many for a LAMMPS restart file; "
               "use fix_modify save and load", solver_.particles());
  if (comm->me == 0) {
    const auto header = mpc::restart_header(
        D, static_cast<std::int64_t>(solver_.particles()),
        static_cast<std::int64_t>(solver_.collisions()), comm->nprocs,
        static_cast<std::int64_t>(pulls.size()), static_cast<std::int64_t>(average.size()),
        given_.seed, given_.single);
    const int size = static_cast<int>(bytes);
    std::fwrite(&size, sizeof size, 1, file);
    std::fwrite(&header, sizeof header, 1, file);
    std::fwrite(pulls.data(), sizeof(Pull<D>), pulls.size(), file);
    sum.add(pulls.data(), pulls.size() * sizeof(Pull<D>));
    std::fwrite(average.data(), sizeof(double), average.size(), file);
    sum.add(average.data(), average.size() * sizeof(double));
  }
  gather([&](const std::vector<Particle<D>> &particles) {
    std::fwrite(particles.data(), sizeof particles[0], particles.size(), file);
    sum.add(particles.data(), particles.size() * sizeof particles[0]);
  });
  const auto checksum = sum.value();
  if (comm->me == 0) std::fwrite(&checksum, sizeof checksum, 1, file);
}

template <int D>
typename MpcState<D>::Restored MpcState<D>::restart(const char *buffer)
{
  const auto header = mpc::read_restart_header<D>(buffer, given_.seed, given_.single);
  solver_.reset(header.fluid.collisions, lower(), upper());
  Restored restored;
  mpc::read_restart<D, Pull<D>>(
      buffer, given_.seed, given_.single,
      [&](const Pull<D> &pull) {
        if (header.processes == comm->nprocs) restored.pulls.push_back(pull);
      },
      [&](double value) { restored.average.push_back(value); },
      [&](const Particle<D> &particle) { solver_.add(particle); });
  solver_.count();
  return restored;
}

template class LAMMPS_NS::MpcState<2>;
template class LAMMPS_NS::MpcState<3>;

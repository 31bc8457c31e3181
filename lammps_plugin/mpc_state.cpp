#include "mpc_state.h"

#include "comm.h"
#include "domain.h"
#include "error.h"
#include "platform.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using mpc::Colloid;
using mpc::Particle;
using mpc::Vector;

namespace {

constexpr std::uint64_t MOST_TRIALS = 100000;    // to place a particle outside the colloids
constexpr int CHUNK = 1 << 16;                   // particles made, read or written at a time

// A fluid of more is beside LAMMPS's restart file, which every process reads all of.
constexpr double MOST_WITHIN = 1e5;

// The header of a file of a fluid, which the first process looks at; `why` it is read.
template <int D>
mpc::FluidHeader read_header(LAMMPS *lmp, const std::string &name, const char *why,
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
MpcState<D>::MpcState(LAMMPS *lmp, const MpcArguments<D> &given, mpc::AnySolver<D> &solver,
                      MpiProcesses &processes) :
    Pointers(lmp), given_(given), solver_(solver), processes_(processes)
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

// The first of so many particles that a process makes or reads.
template <int D> std::int64_t MpcState<D>::share(std::int64_t particles, int process) const
{
  return particles * process / comm->nprocs;
}

// Each process makes or reads its share, and hands it to those that have the cells: whatever the
// number of processes, each has its own in the order of all.
template <int D>
template <class Fill>
void MpcState<D>::distribute(std::int64_t particles, const Fill &fill)
{
  const bool alone = comm->nprocs == 1;
  const auto first = share(particles, comm->me), end = share(particles, comm->me + 1);
  std::vector<Particle<D>> mine, chunk;
  if (!alone) mine.reserve(end - first);
  for (auto place = first; place < end; place += CHUNK) {
    chunk.assign(std::min<std::int64_t>(end - place, CHUNK), {});
    fill(place, chunk);
    if (!alone) mine.insert(mine.end(), chunk.begin(), chunk.end());
    if (alone)
      for (const auto &particle : chunk) solver_.add(particle);
  }

  const auto &grid = solver_.grid();
  std::array<std::vector<int>, D> rows;    // the first of each process along an axis
  for (int a = 0; a < D; ++a) {
    rows[a].resize(comm->procgrid[a]);
    rows[a][comm->myloc[a]] = grid.lower[a];
    MPI_Allreduce(MPI_IN_PLACE, rows[a].data(), comm->procgrid[a], MPI_INT, MPI_MAX, world);
  }
  const auto home = [&](const Particle<D> &particle) {
    std::array<int, 3> at{};
    for (int a = 0; a < D; ++a) {
      const int row = grid.row(a, mpc::wrapped<D>(grid, a, particle.x[a]));
      const auto next = std::upper_bound(rows[a].begin() + 1, rows[a].end(), row);
      at[a] = static_cast<int>(next - rows[a].begin()) - 1;
    }
    return comm->grid2proc[at[0]][at[1]][at[2]];
  };
  for (const auto &particle : processes_.deliver(std::move(mine), home)) solver_.add(particle);
}

// Which colloids, or periodic images of them, may leave no room; about a cell for each colloid.
template <int D>
mpc::ColloidCells<D> MpcState<D>::rooms(const std::vector<Colloid<D>> &colloids,
                                        const mpc::Coupling<D> *coupling) const
{
  Vector<D> box;
  double volume = 1;
  for (int a = 0; a < D; ++a) volume *= box[a] = domain->prd[a];
  const double share = volume / std::max<std::size_t>(1, colloids.size());
  mpc::ColloidCells<D> cells;
  cells.begin({box, {}, std::pow(share, 1.0 / D)});
  int images = 1;
  for (int a = 0; a < D; ++a) images *= 3;
  for (std::size_t c = 0; c < colloids.size(); ++c) {
    for (int image = 0; image < images; ++image) {
      auto x = colloids[c].x;
      bool real = true;
      for (int a = 0, digits = image; a < D; ++a, digits /= 3) {
        x[a] += (digits % 3 - 1) * box[a];
        real &= digits % 3 == 1 || domain->periodicity[a];
      }
      if (real) cells.enter(static_cast<int>(c), x, coupling->room(colloids[c].type));
    }
  }
  cells.finish();
  return cells;
}

// Uniform outside the colloids, Maxwell velocities, no momentum; a function of the seed and the
// particle's number alone.
template <int D> void MpcState<D>::create(const std::vector<Colloid<D>> &colloids,
                                          const mpc::Coupling<D> *coupling)
{
  solver_.reset(0, lower(), upper());
  const auto near = rooms(colloids, coupling);
  const auto overlaps = [&](const Vector<D> &x) {
    bool within = false;
    near.each(near.grid().local(x), [&](int c) {
      Vector<D> separation;
      for (int a = 0; a < D; ++a) {
        separation[a] = x[a] - colloids[c].x[a];
        if (domain->periodicity[a])
          separation[a] -= domain->prd[a] * std::round(separation[a] / domain->prd[a]);
      }
      const double room = coupling->room(colloids[c].type);
      within |= mpc::square<D>(separation) < room * room;
    });
    return within;
  };
  const mpc::CounterRandom random{given_.seed, 0};
  distribute(static_cast<std::int64_t>(given_.particles), [&](std::int64_t number, auto &particles) {
    for (auto &particle : particles) {
      const auto item = static_cast<std::uint64_t>(number++);
      particle.id = static_cast<double>(item);
      std::uint64_t trial = 0;
      do {
        if (++trial > MOST_TRIALS)
          error->one(FLERR, "fix mpc: create {}: the colloids leave no room", given_.particles);
        const auto u = mpc::uniforms(random.words(mpc::Stream::Create, item, trial));
        for (int a = 0; a < D; ++a) particle.x[a] = u[a] * domain->prd[a];
      } while (overlaps(particle.x));
      const auto z = mpc::normals<D>(random.words(mpc::Stream::Create, item));
      for (int a = 0; a < D; ++a) particle.v[a] = std::sqrt(given_.temperature) * z[a];
    }
  });
  solver_.count();
  solver_.zero_momentum();
}

template <int D> double MpcState<D>::particles_in(LAMMPS *lmp, const std::string &name)
{
  return static_cast<double>(read_header<D>(lmp, name, "load", mpc::FLUID_FILE).particles);
}

template <int D> void MpcState<D>::load(const std::string &name)
{
  const auto header = read_header<D>(lmp, name, "load", mpc::FLUID_FILE);
  solver_.reset(header.collisions, lower(), upper());
  ParticleFile<D> file(name, "rb");
  std::vector<double> numbers;
  numbers.reserve(share(header.particles, comm->me + 1) - share(header.particles, comm->me));
  distribute(header.particles, [&](std::int64_t place, auto &particles) {
    if (!file.read(place, particles))
      error->one(FLERR, "fix mpc: load: {} ends before its {} particles", name, header.particles);
    for (auto &particle : particles) {
      check(particle, header.particles, name);
      numbers.push_back(particle.id);
      for (int a = 0; a < D; ++a) particle.x[a] -= domain->boxlo[a];
    }
  });
  solver_.count();
  check_each_once(std::move(numbers), header.particles, name);
}

// Stop at a particle that cannot be.
template <int D>
void MpcState<D>::check(const Particle<D> &particle, std::int64_t particles,
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
void MpcState<D>::check_each_once(std::vector<double> numbers, std::int64_t particles,
                                  const std::string &name)
{
  const auto home = [&](double number) {
    int process = static_cast<int>(number / static_cast<double>(particles) * comm->nprocs);
    while (number < share(particles, process)) --process;
    while (number >= share(particles, process + 1)) ++process;
    return process;
  };
  const auto first = share(particles, comm->me);
  std::vector<bool> known(share(particles, comm->me + 1) - first);
  try {
    for (double number : processes_.deliver(std::move(numbers), home))
      mpc::check_new(static_cast<std::int64_t>(number), first, known);
  } catch (const mpc::Fault &fault) {
    error->one(FLERR, "fix mpc: load: {} has {}", name, fault.what());
  }
}

// Visit the particles of all processes on the first, process by process.
template <int D> template <class Visit> void MpcState<D>::gather(const Visit &visit)
{
  solver_.turn();
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

template <int D> mpc::FluidHeader MpcState<D>::fluid_header(const char (&magic)[8]) const
{
  mpc::FluidHeader header{{}, D, static_cast<std::int64_t>(solver_.particles()),
                          static_cast<std::int64_t>(solver_.collisions())};
  std::memcpy(header.magic, magic, sizeof magic);
  return header;
}

// The particles of each process after those of the one before, seen from an origin; `why` they are
// written. The checksum of all.
template <int D>
std::uint64_t MpcState<D>::write(const std::string &name, const char *why, const char (&magic)[8],
                                 const double *origin)
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
    for (; i < count && chunk.size() < CHUNK; ++i) {
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

template <int D> void MpcState<D>::save(const std::string &name)
{
  write(name, "save", mpc::FLUID_FILE, domain->boxlo);
}

// The whole fluid in the order each process has it, and the last forces on the colloids: orders and
// forces decide the last bits, so that a continued run repeats an uninterrupted one.
template <int D>
void MpcState<D>::write_restart(FILE *file, const std::vector<Pull<D>> &pulls,
                                const std::vector<double> &average)
{
  const bool apart = solver_.particles() > MOST_WITHIN;
  mpc::Apart beside{};
  if (apart) {
    name_beside(file, beside.file);
    constexpr double corner[D] = {};    // of the box: to add another would round
    beside.checksum = write(beside.file, "restart", mpc::RESTART_APART, corner);
  }
  mpc::Checksum sum;
  const auto put = [&](const auto *records, std::size_t count) {
    std::fwrite(records, sizeof *records, count, file);
    sum.add(records, count * sizeof *records);
  };
  if (comm->me == 0) {
    const auto header = mpc::restart_header(
        apart, given_.single, D, static_cast<std::int64_t>(solver_.particles()),
        static_cast<std::int64_t>(solver_.collisions()), comm->nprocs,
        static_cast<std::int64_t>(pulls.size()), static_cast<std::int64_t>(average.size()),
        given_.seed);
    const auto size = static_cast<int>(
        sizeof header + pulls.size() * sizeof(Pull<D>) + average.size() * sizeof(double) +
        (apart ? sizeof beside : header.fluid.particles * sizeof(Particle<D>)) +
        sizeof sum.value());
    std::fwrite(&size, sizeof size, 1, file);
    std::fwrite(&header, sizeof header, 1, file);
    put(pulls.data(), pulls.size());
    put(average.data(), average.size());
    if (apart) put(&beside, 1);
  }
  if (!apart)
    gather([&](const std::vector<Particle<D>> &chunk) { put(chunk.data(), chunk.size()); });
  const auto checksum = sum.value();
  if (comm->me == 0) std::fwrite(&checksum, sizeof checksum, 1, file);
}

// The name of a restart file, and ".fluid".
template <int D>
void MpcState<D>::name_beside(FILE *restart, char (&name)[sizeof mpc::Apart::file]) const
{
  constexpr char end[] = ".fluid";
  if (comm->me == 0) {
    platform::guesspath(restart, name, sizeof name - sizeof end);
    std::strcat(name, end);
  }
  MPI_Bcast(name, sizeof name, MPI_CHAR, 0, world);
  if (name[0] != '/')
    error->all(FLERR, "fix mpc: restart: {} particles go to a file beside the restart file, whose "
               "name this system does not tell; use fix_modify save", solver_.particles());
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
      [&](const Particle<D> &particle) { solver_.add(particle); },
      [&](const mpc::Apart &apart) { read_apart(header.fluid, apart); });
  solver_.count();
  return restored;
}

// From the working directory, as the files of a run are moved together, or where it was written.
template <int D>
void MpcState<D>::read_apart(const mpc::FluidHeader &expected, const mpc::Apart &apart)
{
  const std::string written = apart.file, here = written.substr(written.rfind('/') + 1);
  const auto is_there = [&](const std::string &file) {
    return processes_.any(comm->me == 0 && platform::file_is_readable(file));
  };
  const auto &name = is_there(here) ? here : written;
  if (!is_there(name))
    error->all(FLERR, "fix mpc: restart: {} is missing, here and as {}", here, written);
  const auto header = read_header<D>(lmp, name, "restart", mpc::RESTART_APART);
  ParticleFile<D> file(name, "rb");
  std::uint64_t sum = 0;
  distribute(header.particles, [&](std::int64_t place, auto &particles) {
    if (!file.read(place, particles))
      error->one(FLERR, "fix mpc: restart: {} cannot be read", name);
    sum += mpc::checksum<D>(particles.data(), particles.size(), place);
  });
  MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_UINT64_T, MPI_SUM, world);
  if (sum != apart.checksum || std::memcmp(&header, &expected, sizeof header))
    error->all(FLERR, "fix mpc: restart: {}: damaged, or of another restart file", name);
}

template class LAMMPS_NS::MpcState<2>;
template class LAMMPS_NS::MpcState<3>;

#include "mpc_restart.h"

#include "comm.h"
#include "error.h"
#include "platform.h"

#include <algorithm>
#include <cstring>

using namespace LAMMPS_NS;
using mpc::Particle;

namespace {

// A fluid of more is beside LAMMPS's restart file, which every process reads all of.
constexpr double MOST_WITHIN = 1e5;

}    // namespace

template <int D>
MpcRestart<D>::MpcRestart(LAMMPS *lmp, const MpcArguments<D> &given, mpc::AnySolver<D> &solver,
                          MpcState<D> &state, MpiProcesses &processes) :
    Pointers(lmp), given_(given), solver_(solver), state_(state), processes_(processes),
    files_(lmp, solver, state, processes)
{
}

// Visit the particles of all processes on the first, process by process.
template <int D> template <class Visit> void MpcRestart<D>::gather(const Visit &visit)
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
      chunk.resize(std::min(left, MpcState<D>::CHUNK));
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

// The whole fluid in the order each process has it, and the last forces on the colloids: orders and
// forces decide the last bits, so that a continued run repeats an uninterrupted one.
template <int D>
void MpcRestart<D>::write(FILE *file, const std::vector<Pull<D>> &pulls,
                                const std::vector<double> &average)
{
  const bool apart = solver_.particles() > MOST_WITHIN;
  mpc::Apart beside{};
  if (apart) {
    name_beside(file, beside.file);
    constexpr double corner[D] = {};    // of the box: to add another would round
    beside.checksum = files_.write(beside.file, "restart", mpc::RESTART_APART, corner);
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
void MpcRestart<D>::name_beside(FILE *restart, char (&name)[sizeof mpc::Apart::file]) const
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
typename MpcRestart<D>::Restored MpcRestart<D>::read(const char *buffer)
{
  const auto header = mpc::read_restart_header<D>(buffer, given_.seed, given_.single);
  solver_.reset(header.fluid.collisions, state_.lower(), state_.upper());
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
void MpcRestart<D>::read_apart(const mpc::FluidHeader &expected, const mpc::Apart &apart)
{
  const std::string written = apart.file, here = written.substr(written.rfind('/') + 1);
  const auto is_there = [&](const std::string &file) {
    return processes_.any(comm->me == 0 && platform::file_is_readable(file));
  };
  const auto &name = is_there(here) ? here : written;
  if (!is_there(name))
    error->all(FLERR, "fix mpc: restart: {} is missing, here and as {}", here, written);
  const auto header = files_.read_header(lmp, name, "restart", mpc::RESTART_APART);
  std::uint64_t sum = 0;
  files_.read(name, "restart", header.particles, [&](std::int64_t place, auto &particles) {
    sum += mpc::checksum<D>(particles.data(), particles.size(), place);
  });
  MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_UINT64_T, MPI_SUM, world);
  if (sum != apart.checksum || std::memcmp(&header, &expected, sizeof header))
    error->all(FLERR, "fix mpc: restart: {}: damaged, or of another restart file", name);
}

template class LAMMPS_NS::MpcRestart<2>;
template class LAMMPS_NS::MpcRestart<3>;

#include "mpc_state.h"

#include "comm.h"
#include "domain.h"
#include "error.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using mpc::Colloid;
using mpc::Particle;
using mpc::Vector;

namespace {

constexpr std::uint64_t MOST_TRIALS = 100000;    // to place a particle outside the colloids

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

template <int D> std::int64_t MpcState<D>::share(std::int64_t particles, int process) const
{
  return particles * process / comm->nprocs;
}

template <int D> void MpcState<D>::distribute(std::int64_t particles, const Fill &fill)
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

template class LAMMPS_NS::MpcState<2>;
template class LAMMPS_NS::MpcState<3>;

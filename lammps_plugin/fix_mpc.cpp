#include "fix_mpc.h"

#include "core/force_coupling.h"
#include "core/no_slip_walls.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "force.h"
#include "group.h"
#include "neighbor.h"
#include "update.h"

#include <algorithm>
#include <climits>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using namespace FixConst;
using mpc::Colloid;
using mpc::Particle;
using mpc::Vector;

namespace {

constexpr std::uint64_t MOST_TRIALS = 100000;    // to place a particle outside the colloids
constexpr double SPEED_MARGIN = 3;    // thermal speeds a colloid may gain between two collisions
constexpr char MAGIC[8] = {'m', 'p', 'c', 'f', 'l', 'u', 'i', 'd'};

// What follows it in a restart, before the pulls on the colloids and the particles.
struct RestartHeader {
  mpc::FluidHeader fluid;
  std::int64_t processes, pulls;
};

}    // namespace

template <int D>
FixMPC<D>::FixMPC(LAMMPS *lmp, int narg, char **arg) :
    Fix(lmp, narg, arg), given_(lmp, narg, arg), processes_(*comm, world)
{
  if (std::string(update->unit_style) != "lj")
    error->all(FLERR, "fix mpc: units {}: must be lj", update->unit_style);
  if (domain->triclinic) error->all(FLERR, "fix mpc: the box must not be triclinic");
  if (!domain->xperiodic || (D == 3 && !domain->zperiodic))
    error->all(FLERR, "fix mpc: boundary: must be p in x and z; y may be f, for walls");
  if (!domain->yperiodic && (domain->boundary[1][0] != 1 || domain->boundary[1][1] != 1))
    error->all(FLERR, "fix mpc: boundary: y must be p or f");

  restart_global = 1;
  nevery = given_.every;
  time_integrate = 1;
  scalar_flag = vector_flag = array_flag = 1;
  global_freq = given_.every;
  size_vector = 5;
  size_array_rows = given_.bins;
  size_array_cols = 5;
  extscalar = extvector = extarray = 0;
  dynamic_group_allow = 0;
  open_profile();
}

template <int D> FixMPC<D>::~FixMPC()
{
  if (profile_file_) std::fclose(profile_file_);
}

template <int D> void FixMPC<D>::open_profile()
{
  if (given_.profile_file.empty() || comm->me != 0) return;
  profile_file_ = std::fopen(given_.profile_file.c_str(), given_.profile_append ? "a" : "w");
  if (!profile_file_) error->one(FLERR, "fix mpc: profile: cannot write {}", given_.profile_file);
  if (!given_.profile_append)
    std::fprintf(profile_file_,
                 "# Chunk-averaged data for fix %s and group fluid\n"
                 "# Timestep Number-of-chunks Total-count\n"
                 "# Chunk Coord1 Ncount density/number vx temp\n",
                 id);
}

template <int D> int FixMPC<D>::setmask()
{
  return INITIAL_INTEGRATE | PRE_REVERSE | FINAL_INTEGRATE | END_OF_STEP;
}

template <int D> void FixMPC<D>::init()
{
  if (comm->style != Comm::BRICK || comm->layout == Comm::LAYOUT_TILED)
    error->all(FLERR, "fix mpc: comm_style tiled is not supported");
  if (!given_.interactions.empty() && !force->newton_pair)
    error->all(FLERR, "fix mpc: newton: must be on, forces on ghost colloids are to be summed");
  if (domain->box_change_size || domain->box_change_shape)
    error->all(FLERR, "fix mpc: the box must not change");
  if (!solver_) {
    make_solver();
    if (given_.load_file.empty())
      create_fluid();
    else
      load_fluid();
  }
  if (update->dt * given_.every != interval_)
    error->all(FLERR, "fix mpc: timestep: must not change");
  if (!open_ && update->ntimestep % given_.every)
    error->all(FLERR, "fix mpc: N {}: the first step {} must be a multiple of it", given_.every,
               update->ntimestep);
}

template <int D> void FixMPC<D>::make_solver()
{
  Vector<D> box;
  std::array<bool, D> periodic;
  for (int a = 0; a < D; ++a) {
    box[a] = domain->prd[a];
    periodic[a] = domain->periodicity[a];
  }
  const mpc::Grid<D> grid(box, periodic, given_.edge);
  interval_ = update->dt * given_.every;

  const mpc::Rotation rotation(given_.angle * M_PI / 180, given_.axes);
  mpc::Method<D> method{
      given_.seed, interval_, given_.field, rotation, given_.shifted, {}, {}, {}, {}};
  if (!domain->yperiodic)
    method.walls =
        std::make_unique<mpc::NoSlipWalls<D>>(domain->yprd, given_.density, given_.temperature);
  if (given_.tstat == "layer")
    method.thermostat = std::make_unique<mpc::LayerThermostat<D>>(given_.temperature);
  else if (given_.tstat == "monte_carlo")
    method.thermostat = std::make_unique<mpc::MonteCarloThermostat<D>>(given_.temperature);
  else if (given_.tstat == "maxwell_boltzmann")
    method.thermostat = std::make_unique<mpc::MaxwellBoltzmannThermostat<D>>(given_.temperature);
  else if (given_.tstat == "rescale")
    method.thermostat = std::make_unique<mpc::RescalingThermostat<D>>(given_.temperature);
  else if (given_.tstat == "andersen")
    method.thermostat = std::make_unique<mpc::AndersenThermostat<D>>(given_.temperature, interval_);
  if (given_.hydro == "shuffle")
    method.random_solvent = std::make_unique<mpc::ShuffledSolvent<D>>();
  else if (given_.hydro == "bath")
    method.random_solvent = std::make_unique<mpc::BathSolvent<D>>(given_.temperature);
  if (!given_.interactions.empty())
    method.coupling = std::make_unique<mpc::ForceCoupling<D>>(
        interval_, given_.temperature, given_.field, method.walls.get());
  solver_ = std::make_unique<mpc::Solver<D>>(grid, std::move(method), processes_);
}

// The first of this process's cells, from a corner of its sub-domain.
template <int D> std::array<int, D> FixMPC<D>::bound(const double *corner) const
{
  std::array<int, D> cells;
  for (int a = 0; a < D; ++a)
    cells[a] = static_cast<int>(std::floor((corner[a] - domain->boxlo[a]) / given_.edge + 0.5));
  return cells;
}

template <int D> std::array<int, D> FixMPC<D>::lower() const
{
  return bound(domain->sublo);
}

// Beyond the last sub-domain is the row of cells that only walls have.
template <int D> std::array<int, D> FixMPC<D>::upper() const
{
  auto cells = bound(domain->subhi);
  for (int a = 0; a < D; ++a)
    if (comm->myloc[a] == comm->procgrid[a] - 1) cells[a] = solver_->grid().shape[a];
  return cells;
}

// Uniform outside the colloids, Maxwell velocities, no momentum; a function of the seed and the
// particle's number alone, so every process draws all and keeps its own.
template <int D> void FixMPC<D>::create_fluid()
{
  solver_->reset(0, lower(), upper());
  std::vector<Colloid<D>> mine;
  for (int i = 0; i < atom->nlocal; ++i) {
    const auto interaction = given_.interactions.find(atom->type[i]);
    if (!(atom->mask[i] & given_.colloid_bit) || interaction == given_.interactions.end()) continue;
    mine.push_back({static_cast<double>(atom->tag[i]), {}, 0, interaction->second.sigma});
    for (int a = 0; a < D; ++a) mine.back().x[a] = atom->x[i][a] - domain->boxlo[a];
  }
  const auto colloids = everyones(mine);

  const auto overlaps = [&](const Vector<D> &x) {
    for (const auto &colloid : colloids) {
      Vector<D> separation;
      for (int a = 0; a < D; ++a) {
        separation[a] = x[a] - colloid.x[a];
        if (domain->periodicity[a])
          separation[a] -= domain->prd[a] * std::round(separation[a] / domain->prd[a]);
      }
      if (mpc::square<D>(separation) < colloid.sigma * colloid.sigma) return true;
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
    solver_->add(particle);
  }
  solver_->count();
  solver_->zero_momentum();
}

template <int D> void FixMPC<D>::load_fluid()
{
  FILE *file = std::fopen(given_.load_file.c_str(), "rb");
  if (!file) error->one(FLERR, "fix mpc: load: cannot read {}", given_.load_file);
  mpc::FluidHeader header;
  if (std::fread(&header, sizeof header, 1, file) != 1 ||
      std::memcmp(header.magic, MAGIC, sizeof MAGIC) || header.dimension != D)
    error->one(FLERR, "fix mpc: load: {} is not a fluid in {} dimensions", given_.load_file, D);
  solver_->reset(header.collisions, lower(), upper());
  Particle<D> particle;
  for (std::int64_t n = 0; n < header.particles; ++n) {
    if (std::fread(&particle, sizeof particle, 1, file) != 1)
      error->one(FLERR, "fix mpc: load: {} ends before its {} particles", given_.load_file,
                 header.particles);
    for (int a = 0; a < D; ++a) particle.x[a] -= domain->boxlo[a];
    solver_->add(particle);
  }
  std::fclose(file);
  solver_->count();
  if (solver_->particles() != static_cast<double>(header.particles))
    error->all(FLERR, "fix mpc: load: {} has particles outside the box", given_.load_file);
}

// Records of all processes on all, process by process; for the few that colloids are.
template <int D>
template <class T>
std::vector<T> FixMPC<D>::everyones(const std::vector<T> &mine) const
{
  const int size = static_cast<int>(mine.size() * sizeof(T));
  std::vector<int> sizes(comm->nprocs), starts(comm->nprocs);
  MPI_Allgather(&size, 1, MPI_INT, sizes.data(), 1, MPI_INT, world);
  for (int p = 1; p < comm->nprocs; ++p) starts[p] = starts[p - 1] + sizes[p - 1];
  std::vector<T> all((starts.back() + sizes.back()) / sizeof(T));
  MPI_Allgatherv(mine.data(), size, MPI_BYTE, all.data(), sizes.data(), starts.data(), MPI_BYTE,
                 world);
  return all;
}

// Visit the particles of all processes on the first, process by process.
template <int D> template <class Visit> void FixMPC<D>::gather(const Visit &visit)
{
  solver_->turn();
  constexpr int CHUNK = 1 << 16;
  constexpr int record = sizeof(Particle<D>) / sizeof(double);
  std::vector<Particle<D>> chunk;
  for (int p = 0; p < comm->nprocs; ++p) {
    if (comm->me != 0 && comm->me != p) continue;
    int left = solver_->fluid().size();
    if (p > 0 && comm->me == p) MPI_Send(&left, 1, MPI_INT, 0, 0, world);
    if (p > 0 && comm->me == 0) MPI_Recv(&left, 1, MPI_INT, p, 0, world, MPI_STATUS_IGNORE);
    for (int done = 0; left > 0;) {
      chunk.resize(std::min(left, CHUNK));
      const int count = static_cast<int>(chunk.size());
      if (comm->me == p)
        for (int i = 0; i < count; ++i) chunk[i] = solver_->fluid().particle(done + i);
      if (p > 0 && comm->me == p) MPI_Send(chunk.data(), count * record, MPI_DOUBLE, 0, 0, world);
      if (p > 0 && comm->me == 0)
        MPI_Recv(chunk.data(), count * record, MPI_DOUBLE, p, 0, world, MPI_STATUS_IGNORE);
      if (comm->me == 0) visit(chunk);
      done += count;
      left -= count;
    }
  }
}

template <int D> mpc::FluidHeader FixMPC<D>::fluid_header() const
{
  mpc::FluidHeader header{{}, D, static_cast<std::int64_t>(solver_->particles()),
                          static_cast<std::int64_t>(solver_->collisions())};
  std::memcpy(header.magic, MAGIC, sizeof MAGIC);
  return header;
}

template <int D> void FixMPC<D>::save_fluid(const std::string &name)
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

template <int D> int FixMPC<D>::modify_param(int narg, char **arg)
{
  if (std::string(arg[0]) != "save") return 0;
  if (narg < 2) error->all(FLERR, "fix_modify save: needs a file name");
  if (!solver_ || open_)
    error->all(FLERR, "fix_modify save: the step must be a multiple of N = {}", given_.every);
  save_fluid(arg[1]);
  return 2;
}

// The whole fluid in the order each process has it, and the last forces on the colloids: orders and
// forces decide the last bits, so that a continued run repeats an uninterrupted one.
template <int D> void FixMPC<D>::write_restart(FILE *file)
{
  if (!solver_ || open_)
    error->all(FLERR, "fix mpc: restart: the step {} must be a multiple of N = {}",
               update->ntimestep, given_.every);
  const auto pulls = everyones(pulls_);
  const double bytes = sizeof(RestartHeader) + pulls.size() * sizeof(Pull) +
      solver_->particles() * sizeof(Particle<D>);
  if (bytes > INT_MAX)
    error->all(FLERR, "fix mpc: restart: {} particles are too many for a LAMMPS restart file; "
               "use fix_modify save and load", solver_->particles());
  if (comm->me == 0) {
    const RestartHeader header{fluid_header(), comm->nprocs,
                               static_cast<std::int64_t>(pulls.size())};
    const int size = static_cast<int>(bytes);
    std::fwrite(&size, sizeof size, 1, file);
    std::fwrite(&header, sizeof header, 1, file);
    std::fwrite(pulls.data(), sizeof(Pull), pulls.size(), file);
  }
  gather([&](const std::vector<Particle<D>> &particles) {
    std::fwrite(particles.data(), sizeof particles[0], particles.size(), file);
  });
}

template <int D> void FixMPC<D>::restart(char *buffer)
{
  const auto read = [&](auto &record) {
    std::memcpy(&record, buffer, sizeof record);
    buffer += sizeof record;
  };
  RestartHeader header;
  read(header);
  if (header.fluid.dimension != D) error->all(FLERR, "fix mpc: restart: of another dimension");
  for (std::int64_t n = 0; n < header.pulls; ++n) {
    Pull pull;
    read(pull);
    if (header.processes == comm->nprocs && pull.process == comm->me) pulls_.push_back(pull);
  }
  make_solver();
  solver_->reset(header.fluid.collisions, lower(), upper());
  for (std::int64_t n = 0; n < header.fluid.particles; ++n) {
    Particle<D> particle;
    read(particle);
    solver_->add(particle);
  }
  solver_->count();
}

// The colloids and images that this process sees, as they stand after a collision.
template <int D> void FixMPC<D>::snapshot()
{
  slots_.clear();
  atoms_.clear();
  double bounds[2] = {0, 0};    // speed squared, and inverse mass
  double sigma = 0;
  for (int i = 0; i < atom->nlocal + atom->nghost; ++i) {
    const auto interaction = given_.interactions.find(atom->type[i]);
    if (!(atom->mask[i] & given_.colloid_bit) || interaction == given_.interactions.end()) continue;
    slots_.push_back({static_cast<double>(atom->tag[i]), {}, interaction->second.epsilon,
                      interaction->second.sigma});
    atoms_.push_back(i);
    sigma = std::max(sigma, interaction->second.sigma);
    if (i >= atom->nlocal) continue;
    double speed = 0;
    for (int a = 0; a < D; ++a) speed += atom->v[i][a] * atom->v[i][a];
    const double mass = atom->rmass ? atom->rmass[i] : atom->mass[atom->type[i]];
    bounds[0] = std::max(bounds[0], speed);
    bounds[1] = std::max(bounds[1], 1 / mass);
  }
  read_colloids();
  forces_.resize(slots_.size());
  if (comm->nprocs > 1) MPI_Allreduce(MPI_IN_PLACE, bounds, 2, MPI_DOUBLE, MPI_MAX, world);
  colloid_speed_ = std::sqrt(bounds[0]) + SPEED_MARGIN * std::sqrt(given_.temperature * bounds[1]);

  // cells reach beyond the sub-domain by the shift and half a cell, and colloids move
  if (slots_.empty()) return;
  const double needed =
      1.5 * given_.edge + solver_->coupling()->reach(sigma) + 3 * interval_ * colloid_speed_;
  for (int a = 0; a < D; ++a)
    if (comm->cutghost[a] < needed && domain->periodicity[a])
      error->one(FLERR, "fix mpc: the ghost cutoff {:.4g} is too short for the fluid to see all "
                 "colloids: use comm_modify cutoff {:.4g} or more", comm->cutghost[a], needed);
}

// The local or ghost atom of a colloid nearest to a place, within a distance; -1 if there is none.
template <int D>
int FixMPC<D>::atom_at(double id, const Vector<D> &x, double distance) const
{
  int nearest = -1;
  double least = distance * distance;
  for (int i = 0; i < atom->nlocal + atom->nghost; ++i) {
    if (static_cast<double>(atom->tag[i]) != id) continue;
    double square = 0;
    for (int a = 0; a < D; ++a) {
      const double separation = atom->x[i][a] - domain->boxlo[a] - x[a];
      square += separation * separation;
    }
    if (square <= least) {
      least = square;
      nearest = i;
    }
  }
  return nearest;
}

// An image that is no longer among the ghosts is out of reach: it stays where it was seen last.
template <int D> void FixMPC<D>::read_colloids()
{
  for (std::size_t s = 0; s < slots_.size(); ++s)
    if (atoms_[s] >= 0)
      for (int a = 0; a < D; ++a) slots_[s].x[a] = atom->x[atoms_[s]][a] - domain->boxlo[a];
}

template <int D> void FixMPC<D>::add_forces()
{
  if (neighbor->ago == 0)    // atoms were exchanged; a colloid moves much less than its images
    for (std::size_t s = 0; s < slots_.size(); ++s)
      atoms_[s] = atom_at(slots_[s].id, slots_[s].x, given_.edge);
  read_colloids();
  guarded([&] { solver_->coupling()->forces(slots_, forces_); });
  for (std::size_t s = 0; s < slots_.size(); ++s)
    if (atoms_[s] >= 0)
      for (int a = 0; a < D; ++a) atom->f[atoms_[s]][a] += forces_[s][a];
}

// Stop at a fault, with the step.
template <int D> template <class Action> void FixMPC<D>::guarded(const Action &action)
{
  try {
    action();
  } catch (const mpc::Fault &fault) {
    error->one(FLERR, "fix mpc: step {}: {}", update->ntimestep, fault.what());
  }
}

template <int D> void FixMPC<D>::remember_pulls()
{
  pulls_.clear();
  for (std::size_t s = 0; s < slots_.size(); ++s)
    if (mpc::square<D>(forces_[s]) > 0)
      pulls_.push_back({static_cast<double>(comm->me), slots_[s].id, slots_[s].x, forces_[s]});
}

// Add the remembered forces, if all colloids are where they were.
template <int D> bool FixMPC<D>::repeat_pulls()
{
  std::vector<int> atoms;
  for (const auto &pull : pulls_) atoms.push_back(atom_at(pull.id, pull.x, 1e-9 * given_.edge));
  const bool moved = std::count(atoms.begin(), atoms.end(), -1) > 0;
  double known = static_cast<double>(pulls_.size());
  processes_.sum(&known, 1);
  if (processes_.any(moved) || known == 0) return false;
  for (std::size_t k = 0; k < atoms.size(); ++k)
    for (int a = 0; a < D; ++a) atom->f[atoms[k]][a] += pulls_[k].force[a];
  return true;
}

template <int D> void FixMPC<D>::setup_pre_reverse(int, int)
{
  if (given_.interactions.empty()) return;
  if (!open_) {
    snapshot();
    if (repeat_pulls()) return;
    guarded([&] { solver_->find_near(slots_, colloid_speed_); });
  }
  add_forces();
}

template <int D> void FixMPC<D>::initial_integrate(int)
{
  if (!open_) {
    if (comm->nprocs > 1) solver_->redistribute(lower(), upper());
    guarded([&] { solver_->begin_interval(slots_, colloid_speed_); });
    open_ = true;
  }
  if (!given_.interactions.empty()) guarded([&] { solver_->coupling()->drift(update->dt); });
}

template <int D> void FixMPC<D>::pre_reverse(int, int)
{
  if (!given_.interactions.empty()) add_forces();
}

template <int D> void FixMPC<D>::final_integrate()
{
  if (!given_.interactions.empty()) solver_->coupling()->kick(update->dt);
}

template <int D> void FixMPC<D>::end_of_step()
{
  guarded([&] { solver_->end_interval(); });
  open_ = false;
  if (!given_.interactions.empty()) {
    remember_pulls();
    snapshot();
  }
  if (given_.profile_every && update->ntimestep % given_.profile_every == 0) write_profile();
}

// Layers of the fluid as it is now.
template <int D> const std::vector<mpc::Layer> &FixMPC<D>::profile()
{
  if (layers_step_ != update->ntimestep) {
    solver_->turn();
    layers_ = mpc::layers<D>(solver_->fluid(), solver_->grid(), given_.bins, processes_);
    layers_step_ = update->ntimestep;
  }
  return layers_;
}

// The file of fix ave/chunk with a chunk/atom bin/1d y: averaged over the looks of Nfreq steps.
template <int D> void FixMPC<D>::write_profile()
{
  averaged_.resize(given_.bins);
  const auto &now = profile();
  for (int bin = 0; bin < given_.bins; ++bin) {
    averaged_[bin].count += now[bin].count;
    averaged_[bin].momentum_x += now[bin].momentum_x;
    averaged_[bin].squares += now[bin].squares;
  }
  ++looks_;
  if (update->ntimestep % given_.profile_frequency) return;

  if (comm->me == 0) {
    const double depth = domain->yprd / given_.bins;
    const double volume = depth * domain->xprd * (D == 3 ? domain->zprd : 1);
    std::fprintf(profile_file_, BIGINT_FORMAT " %d %g\n", update->ntimestep, given_.bins,
                 solver_->particles());
    for (int bin = 0; bin < given_.bins; ++bin) {
      const auto &layer = averaged_[bin];
      const double occupied = std::max(layer.count, 1.0);
      std::fprintf(profile_file_, "  %d %g %g %g %.6g %.6g\n", bin + 1,
                   domain->boxlo[1] + depth * (bin + 0.5), layer.count / looks_,
                   layer.count / looks_ / volume, layer.momentum_x / occupied,
                   layer.squares / (D * occupied));
    }
    std::fflush(profile_file_);
  }
  averaged_.clear();
  looks_ = 0;
}

template <int D> double FixMPC<D>::compute_scalar()
{
  return mpc::temperature(profile(), D);
}

// Momentum along x, y, z, then particles, then collisions.
template <int D> double FixMPC<D>::compute_vector(int index)
{
  if (index == 3) return solver_->particles();
  if (index == 4) return static_cast<double>(solver_->collisions());
  return index < D ? solver_->momentum()[index] : 0.0;
}

template <int D> double FixMPC<D>::compute_array(int row, int column)
{
  const auto &layer = profile()[row];
  const double depth = domain->yprd / given_.bins;
  const double occupied = std::max(layer.count, 1.0);
  switch (column) {
    case 0: return domain->boxlo[1] + depth * (row + 0.5);
    case 1: return layer.count;
    case 2: return layer.count / (depth * domain->xprd * (D == 3 ? domain->zprd : 1));
    case 3: return layer.momentum_x / occupied;
    default: return layer.squares / (D * occupied);
  }
}

template <int D> double FixMPC<D>::memory_usage()
{
  return solver_ ? solver_->memory() : 0.0;
}

template class LAMMPS_NS::FixMPC<2>;
template class LAMMPS_NS::FixMPC<3>;

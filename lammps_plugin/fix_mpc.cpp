#include "fix_mpc.h"

#include "core/cell_coupling.h"
#include "mpc_warnings.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "force.h"
#include "update.h"

#include <algorithm>
#include <climits>
#include <cmath>

using namespace LAMMPS_NS;
using namespace FixConst;

namespace {

enum Entries { PARTICLES = 3, COLLISIONS, SKEWNESS, KURTOSIS = SKEWNESS + 3, WALLS = KURTOSIS + 3 };

}    // namespace

template <int D>
FixMPC<D>::FixMPC(LAMMPS *lmp, int narg, char **arg) :
    Fix(lmp, narg, arg), given_(lmp, narg, arg), processes_(*comm, world),
    colloids_(lmp, this, given_.colloid_bit, given_.temperature, given_.edge, processes_)
{
  if (std::string(update->unit_style) != "lj")
    error->all(FLERR, "fix mpc: units {}: must be lj", update->unit_style);
  if (domain->triclinic) error->all(FLERR, "fix mpc: the box must not be triclinic");
  for (int a = 0; a < D; ++a)
    if (!domain->periodicity[a] && (domain->boundary[a][0] != 1 || domain->boundary[a][1] != 1))
      error->all(FLERR, "fix mpc: boundary: {} must be p or f", "xyz"[a]);

  restart_global = 1;
  nevery = given_.every;
  time_integrate = !given_.colloid_bit;    // colloids have an integrator of their own
  scalar_flag = vector_flag = array_flag = 1;
  global_freq = given_.every;
  size_vector = WALLS + 18;
  size_array_rows = given_.bins;
  size_array_cols = 5;
  extscalar = extvector = extarray = 0;
  dynamic_group_allow = 0;
  comm_forward = comm_reverse = MpcColloids<D>::MOST_CARRIED;
  warn_of_unread_fluid(lmp, id);
  if (!given_.colloid_bit) expect_no_atoms(lmp, given_.edge);
  if (!given_.profile_file.empty())
    profile_ = std::make_unique<MpcProfile>(lmp, given_.profile_file, given_.profile_append, id);
  if (given_.flow.every) flow_ = std::make_unique<MpcFlow<D>>(lmp, given_.flow, processes_, id);
  if (given_.dump.every) dump_ = std::make_unique<MpcDump<D>>(lmp, given_.dump);
}

template <int D> int FixMPC<D>::setmask()
{
  return INITIAL_INTEGRATE | PRE_REVERSE | END_OF_STEP;
}

template <int D> void FixMPC<D>::init()
{
  if (comm->style != Comm::BRICK || comm->layout == Comm::LAYOUT_TILED)
    error->all(FLERR, "fix mpc: comm_style tiled is not supported");
  if (!given_.interactions.empty() && !force->newton_pair)
    error->all(FLERR, "fix mpc: newton: must be on, forces on ghost colloids are to be summed");
  if (!given_.radii.empty() && !atom->omega_flag)
    error->all(FLERR, "fix mpc: reflect: needs atom_style sphere, colloids rotate");
  if (domain->box_change_size || domain->box_change_shape)
    error->all(FLERR, "fix mpc: the box must not change");
  if (!solver_) {
    const bool loading = !given_.load_file.empty();
    make_solver(loading ? MpcFluidFile<D>::particles_in(lmp, given_.load_file) : given_.particles);
    check_processes();
    guarded([&] {
      if (loading)
        fluid_file().load(given_.load_file);
      else
        state_->create(colloids_.all(), coupling());
    });
    warn_of_density<D>(lmp, given_.density, solver_->particles(), given_.edge, colloids_.all(),
                       coupling());
  }
  if (given_.colloid_bit && !looked_)
    warn_of_unfelt<D>(lmp, given_.colloid_bit, coupling(), processes_);
  looked_ = true;
  check_processes();
  if (update->dt * given_.every != interval_)
    error->all(FLERR, "fix mpc: timestep: must not change");
  if (!open_ && update->ntimestep % given_.every)
    error->all(FLERR, "fix mpc: N {}: the first step {} must be a multiple of it", given_.every,
               update->ntimestep);
}

// A process without cells would wait for particles that nobody sends it.
template <int D> void FixMPC<D>::check_processes()
{
  const auto lower = state_->lower(), upper = state_->upper();
  for (int a = 0; a < D; ++a)
    if (processes_.any(upper[a] <= lower[a]))
      error->all(FLERR, "fix mpc: {} processes along {} are too many for its {} cells",
                 comm->procgrid[a], "xyz"[a], solver_->grid().shape[a]);
}

template <int D>
std::unique_ptr<mpc::Coupling<D>>
FixMPC<D>::make_coupling(const mpc::Vector<D> &field, const mpc::Walls<D> *walls) const
{
  if (!given_.interactions.empty())
    return std::make_unique<mpc::ForceCoupling<D>>(given_.interactions, interval_,
                                                   given_.temperature, field, walls);
  if (!given_.radii.empty())
    return std::make_unique<mpc::ReflectionCoupling<D>>(given_.radii, given_.placement, interval_,
                                                        given_.temperature, field, walls);
  if (given_.in_collision) return std::make_unique<mpc::CellCoupling<D>>();
  return nullptr;
}

template <int D> void FixMPC<D>::make_solver(double particles)
{
  mpc::Vector<D> box;
  std::array<bool, D> periodic;
  for (int a = 0; a < D; ++a) {
    box[a] = domain->prd[a];
    periodic[a] = domain->periodicity[a];
  }
  if (particles > INT_MAX && given_.hydro == "shuffle")
    error->all(FLERR, "fix mpc: hydro shuffle: {} particles are more than {}", particles, INT_MAX);
  const mpc::Grid<D> grid(box, periodic, given_.edge);
  interval_ = update->dt * given_.every;

  auto field = given_.field;
  if (mpc::square<D>(given_.compensated) > 0) {
    const double masses = colloids_.mass() / particles;
    for (int a = 0; a < D; ++a) field[a] -= masses * given_.compensated[a];
  }
  const mpc::Rotation rotation(given_.angle * M_PI / 180, given_.axes);
  mpc::Method<D> method{given_.seed, interval_, field, rotation, given_.shifted, {}, {}, {}, {}};
  if (given_.walls)
    method.walls = std::make_unique<mpc::NoSlipWalls<D>>(
        grid, given_.virtual_particles ? given_.density : 0, given_.temperature,
        given_.wall_velocities);
  if (given_.tstat == "layer")
    method.thermostat = std::make_unique<mpc::LayerThermostat<D>>(
        given_.temperature, method.walls ? method.walls->axes()[0] : 1);
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
  method.coupling = make_coupling(field, method.walls.get());
  method.thermal_speed = std::sqrt(given_.temperature);
  if (given_.single)
    solver_ = std::make_unique<mpc::Solver<D, float>>(grid, std::move(method), processes_);
  else
    solver_ = std::make_unique<mpc::Solver<D>>(grid, std::move(method), processes_);
  state_ = std::make_unique<MpcState<D>>(lmp, given_, *solver_, processes_);
  colloids_.set_coupling(coupling());
}

template <int D> int FixMPC<D>::modify_param(int narg, char **arg)
{
  if (std::string(arg[0]) != "save") return 0;
  if (narg < 2) error->all(FLERR, "fix_modify save: needs a file name");
  if (!solver_ || open_)
    error->all(FLERR, "fix_modify save: the step must be a multiple of N = {}", given_.every);
  fluid_file().save(arg[1]);
  return 2;
}

template <int D> void FixMPC<D>::write_restart(FILE *file)
{
  if (!solver_ || open_)
    error->all(FLERR, "fix mpc: restart: the step {} must be a multiple of N = {}",
               update->ntimestep, given_.every);
  MpcRestart<D>(lmp, given_, *solver_, *state_, processes_)
      .write(file, processes_.everyones(colloids_.pulls),
             flow_ ? flow_->state() : std::vector<double>{});
}

template <int D> void FixMPC<D>::restart(char *buffer)
{
  guarded([&] {
    const auto header = mpc::read_restart_header<D>(buffer, given_.seed, given_.single);
    make_solver(static_cast<double>(header.fluid.particles));
    check_processes();
    auto restored = MpcRestart<D>(lmp, given_, *solver_, *state_, processes_).read(buffer);
    if (flow_ && !restored.average.empty() && !flow_->restore(restored.average))
      throw mpc::Fault("restart: its flow has not the bins of this fix");
    auto &pulls = colloids_.pulls;
    pulls = std::move(restored.pulls);
    if (couples_every_step())    // images of a colloid are of one process, atoms may change theirs
      pulls.erase(std::remove_if(pulls.begin(), pulls.end(),
                                 [&](const auto &pull) { return pull.process != comm->me; }),
                  pulls.end());
    restored_ = true;
  });
}

template <int D> void FixMPC<D>::add_forces(bool moving)
{
  colloids_.follow();
  guarded([&] {
    if (moving)
      coupling()->step(update->dt, colloids_.seen(), colloids_.forces());
    else
      coupling()->forces(colloids_.seen(), colloids_.forces());
  });
  colloids_.apply_forces();
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

template <int D> void FixMPC<D>::setup_pre_reverse(int, int)
{
  if (!coupling()) return;
  if (!open_) {
    colloids_.see(interval_);
    if (!couples_every_step() || colloids_.repeat_pulls()) return;
    guarded([&] { solver_->find_near(colloids_.seen(), colloids_.speed()); });
  }
  if (couples_every_step()) add_forces(false);
}

template <int D> void FixMPC<D>::setup(int)
{
  if (restored_ && coupling() && !couples_every_step()) colloids_.repeat_forces();
  restored_ = false;
  if (dump_ && !begun_ && !given_.dump.append) dump();
  begun_ = true;
}

template <int D> void FixMPC<D>::initial_integrate(int)
{
  if (!open_) {
    guarded([&] {
      if (comm->nprocs > 1) solver_->redistribute(state_->lower(), state_->upper());
      solver_->begin_interval(colloids_.seen(), colloids_.speed());
    });
    open_ = true;
  }
}

template <int D> void FixMPC<D>::pre_reverse(int, int)
{
  if (couples_every_step()) add_forces(true);
}

template <int D> void FixMPC<D>::end_of_step()
{
  if (couples_every_step())
    colloids_.follow();
  else if (coupling())
    colloids_.see_velocities(interval_);
  guarded([&] { solver_->end_interval(colloids_.seen()); });
  open_ = false;
  if (couples_every_step()) {
    colloids_.remember_pulls();
  } else if (coupling()) {
    colloids_.apply_impulses(coupling()->impulses());
    colloids_.remember_forces();
  }
  if (given_.momentum_every > 0 && solver_->collisions() % given_.momentum_every == 0)
    remove_momentum();
  if (coupling()) colloids_.see(interval_);
  const bigint step = update->ntimestep;
  if (profile_) {
    if (step % given_.profile_every == 0) profile_->look(layers());
    if (step % given_.profile_frequency == 0) profile_->write(solver_->particles());
  }
  if (flow_) {
    if (step % given_.flow.every == 0) flow_->look(*solver_);
    if (step % given_.flow.frequency == 0) flow_->write(solver_->particles());
  }
  if (dump_) dump();
}

// A frame of the fluid, at the steps that have one.
template <int D> void FixMPC<D>::dump()
{
  if (open_ || update->ntimestep % given_.dump.every) return;
  solver_->turn();
  dump_->write(*solver_);
}

// Take the total momentum from all velocities alike.
template <int D> void FixMPC<D>::remove_momentum()
{
  auto sums = colloids_.momentum();
  processes_.sum(sums.data(), D);
  const auto of_fluid = solver_->momentum();
  const double mass = solver_->particles() + colloids_.mass();
  mpc::Vector<D> change;
  for (int a = 0; a < D; ++a) change[a] = -(sums[a] + of_fluid[a]) / mass;
  solver_->add_velocity(change);
  colloids_.add_velocity(change);
}

template <int D> int FixMPC<D>::pack_forward_comm(int count, int *atoms, double *buffer, int, int *)
{
  return colloids_.pack(count, atoms, buffer);
}

template <int D> void FixMPC<D>::unpack_forward_comm(int count, int first, double *buffer)
{
  colloids_.set(count, first, buffer);
}

template <int D> int FixMPC<D>::pack_reverse_comm(int count, int first, double *buffer)
{
  return colloids_.pack(count, first, buffer);
}

template <int D> void FixMPC<D>::unpack_reverse_comm(int count, int *atoms, double *buffer)
{
  colloids_.add(count, atoms, buffer);
}

// Layers of the fluid as it is now.
template <int D> const std::vector<mpc::Layer> &FixMPC<D>::layers()
{
  if (layers_step_ != update->ntimestep) {
    layers_ = solver_->layers(given_.bins);
    layers_step_ = update->ntimestep;
  }
  return layers_;
}

template <int D> double FixMPC<D>::compute_scalar()
{
  return mpc::temperature(layers(), D);
}

// How velocities are distributed now.
template <int D> const mpc::Moments<D> &FixMPC<D>::moments()
{
  if (moments_step_ != update->ntimestep) {
    moments_ = solver_->moments();
    moments_step_ = update->ntimestep;
  }
  return moments_;
}

template <int D> const mpc::Vector<D> &FixMPC<D>::momentum()
{
  if (momentum_step_ != update->ntimestep) {
    momentum_ = solver_->momentum();
    momentum_step_ = update->ntimestep;
  }
  return momentum_;
}

template <int D> const mpc::FaceVectors<D> &FixMPC<D>::momentum_of_walls()
{
  if (walls_step_ != update->ntimestep) {
    momentum_of_walls_ = solver_->momentum_of_walls();
    walls_step_ = update->ntimestep;
  }
  return momentum_of_walls_;
}

// Momentum along x, y, z, then particles, then collisions; skewness and excess kurtosis along x, y,
// z; the force on each wall, from xlo to zhi, along x, y, z.
template <int D> double FixMPC<D>::compute_vector(int index)
{
  if (index == PARTICLES) return solver_->particles();
  if (index == COLLISIONS) return static_cast<double>(solver_->collisions());
  const int component = index < PARTICLES ? index : (index - SKEWNESS) % 3;
  const int face = (index - WALLS) / 3;
  if (component >= D || face >= 2 * D) return 0.0;
  if (index < PARTICLES) return momentum()[component];
  if (index < KURTOSIS) return moments().skewness[component];
  if (index < WALLS) return moments().excess_kurtosis[component];
  return momentum_of_walls()[face][component] / interval_;
}

template <int D> double FixMPC<D>::compute_array(int row, int column)
{
  const auto &layer = layers()[row];
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

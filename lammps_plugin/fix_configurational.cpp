#include "fix_configurational.h"

#include "step_limit.h"

#include "atom.h"
#include "comm.h"
#include "error.h"
#include "memory.h"
#include "update.h"

#include <cmath>
#include <string>

using namespace LAMMPS_NS;
using namespace FixConst;

namespace {
constexpr double coldest = 0.1;    // of T: a start below it runs away (docs)
}

FixConfigurational::FixConfigurational(LAMMPS *lmp, int narg, char **arg) :
    Fix(lmp, narg, arg), sllod_(std::string(arg[2]) == "configurational/sllod")
{
  if (narg != 5) error->all(FLERR, "fix {}: takes the temperature and the damping constant Q", style);
  temperature_ = utils::numeric(FLERR, arg[3], false, lmp);
  damping_ = utils::numeric(FLERR, arg[4], false, lmp);
  if (!(temperature_ > 0))
    error->all(FLERR, "fix {}: temperature {}: must be positive", style, arg[3]);
  if (!(damping_ > 0)) error->all(FLERR, "fix {}: Q {}: must be positive", style, arg[4]);
  if (igroup != 0) error->all(FLERR, "fix {}: the group must be all", style);

  time_integrate = 1;
  scalar_flag = vector_flag = 1;
  size_vector = 3;
  global_freq = 1;
  extscalar = extvector = 0;
  restart_global = restart_peratom = 1;
  create_attribute = 1;
  comm_forward = 3;
  comm_reverse = 6;
  maxexchange = 3;
  FixConfigurational::grow_arrays(atom->nmax);
  for (int i = 0; i < atom->nlocal; ++i) FixConfigurational::set_arrays(i);
  atom->add_callback(Atom::GROW);
  atom->add_callback(Atom::RESTART);
}

FixConfigurational::~FixConfigurational()
{
  if (pair_ && force && force->pair == pair_) pair_->collect(nullptr);
  atom->delete_callback(id, Atom::GROW);
  atom->delete_callback(id, Atom::RESTART);
  memory->destroy(before_);
}

int FixConfigurational::setmask()
{
  return INITIAL_INTEGRATE | PRE_REVERSE | FINAL_INTEGRATE;
}

void FixConfigurational::init()
{
  if (std::string(update->unit_style) != "lj")
    error->all(FLERR, "fix {}: units {}: must be lj", style, update->unit_style);
  if (std::string(update->integrate_style).find("respa") == 0)
    error->all(FLERR, "fix {}: run_style respa is not supported", style);
  pair_ = &ConfigurationalTemperature::pair_of(*force, *error, style);
  pair_->collect(&now_.curvature);
  step_ = update->dt;
}

void FixConfigurational::reset_dt()
{
  step_ = update->dt;
}

double FixConfigurational::mass(int i) const
{
  return atom->rmass ? atom->rmass[i] : atom->mass[atom->type[i]];
}

void FixConfigurational::setup_pre_reverse(int eflag, int vflag)
{
  pre_reverse(eflag, vflag);
}

void FixConfigurational::setup(int)
{
  if (sllod_) flow_ = ShearFlow::of(*domain, *error, style);
  if (!begun_ && now_.temperature() < coldest * temperature_)
    error->all(FLERR,
               "fix {}: the configurational temperature is {:.3g} at the start, a lattice or nearly "
               "one: below {} T the thermostat runs away, let another thermostat heat it first",
               style, now_.temperature(), coldest);
}

// After the pair style, before its forces on ghosts return and before other fixes add theirs: these
// are the forces of the potential energy alone.
void FixConfigurational::pre_reverse(int, int)
{
  const int atoms = atom->nlocal, ghosts = atom->nghost;
  const auto *f = reinterpret_cast<const Triple *>(atom->f[0]);
  now_.force.assign(f, f + atoms + ghosts);
  now_.sum(*comm, world, this, atoms);
  if (!(now_.laplacian > 0))
    error->all(FLERR,
               "fix {}: step {}: the Laplacian of the potential energy is {:.3g}, so that the "
               "configurational temperature has no positive value: too few atoms interact",
               style, update->ntimestep, now_.laplacian);
  now_.differentiate(*comm, this, atoms, ghosts, domain->dimension,
                     reinterpret_cast<const double (*)[3]>(atom->x[0]));
}

void FixConfigurational::kick()
{
  auto *v = reinterpret_cast<double (*)[3]>(atom->v[0]);
  const auto *f = reinterpret_cast<const double (*)[3]>(atom->f[0]);
  for (int i = 0; i < atom->nlocal; ++i) {
    const double factor = step_ / 2 / mass(i);
    for (int a = 0; a < 3; ++a) v[i][a] += factor * f[i][a];
  }
}

void FixConfigurational::turn_multiplier()
{
  multiplier_ -= step_ / 2 * damping_ * (now_.temperature() - temperature_) / temperature_;
}

// (5): momenta and s by half steps, positions by a whole one, in which the gradient of T_conf is
// extrapolated to the middle of the step from its last two values (second order, one evaluation a
// step). In a shear flow, momenta relative to it lose rate p_y in two halves.
void FixConfigurational::initial_integrate(int)
{
  kick();
  turn_multiplier();
  auto *x = reinterpret_cast<double (*)[3]>(atom->x[0]);
  auto *v = reinterpret_cast<double (*)[3]>(atom->v[0]);
  auto *before = reinterpret_cast<double (*)[3]>(before_[0]);
  const double rate = flow_.rate, shear = rate * step_ / 2;
  const double now = multiplier_ / temperature_ * (begun_ ? 1.5 : 1.0);
  const double then = multiplier_ / temperature_ * (begun_ ? -0.5 : 0.0);
  const double longest = longest_move(*neighbor);
  double furthest = 0;
  for (int i = 0; i < atom->nlocal; ++i) {
    const auto &gradient = now_.gradient[i];
    const double height = x[i][1] - flow_.origin;
    double c[3] = {v[i][0] - rate * height - shear * v[i][1], v[i][1], v[i][2]};
    double squares = 0, rise = 0;
    for (int a = 0; a < 3; ++a) {
      const double speed = c[a] + now * gradient[a] + then * before[i][a];
      x[i][a] += step_ * speed;
      squares += speed * speed;
      if (a == 1) rise = speed;
      before[i][a] = gradient[a];
    }
    x[i][0] += rate * step_ * (height + step_ / 2 * rise);
    v[i][0] = c[0] - shear * c[1] + rate * (x[i][1] - flow_.origin);
    const double move = step_ * std::sqrt(squares);
    furthest = move < longest ? std::max(furthest, move) : HUGE_VAL;
    if (!(move < longest)) {
      const double share = step_ * std::fabs(multiplier_ / temperature_) *
          std::hypot(gradient[0], gradient[1], gradient[2]);
      stop_at_move(*error, style, *update, atom->tag[i], move, longest,
                   fmt::format(" (by {:.3g} of it the thermostat, with s = {:.3g} and T_conf = "
                               "{:.3g})",
                               share, multiplier_, now_.temperature())
                       .c_str());
    }
  }
  begun_ = true;
}

void FixConfigurational::final_integrate()
{
  kick();
  turn_multiplier();
}

double FixConfigurational::compute_scalar()
{
  return now_.temperature();
}

double FixConfigurational::compute_vector(int index)
{
  return index == 0 ? multiplier_ : index == 1 ? now_.force_squares : now_.laplacian;
}

double FixConfigurational::memory_usage()
{
  return sizeof(Triple) * (now_.force.capacity() + now_.gradient.capacity() +
                           now_.curvature.gradient.capacity() + atom->nmax) +
      sizeof(Contact) * now_.curvature.contacts.capacity();
}

void FixConfigurational::write_restart(FILE *file)
{
  if (comm->me != 0) return;
  const double state[2] = {multiplier_, begun_ ? 1.0 : 0.0};
  const int size = sizeof state;
  fwrite(&size, sizeof size, 1, file);
  fwrite(state, sizeof state, 1, file);
}

void FixConfigurational::restart(char *buffer)
{
  const auto *state = reinterpret_cast<const double *>(buffer);
  multiplier_ = state[0];
  begun_ = state[1] != 0;
}

void FixConfigurational::grow_arrays(int atoms)
{
  memory->grow(before_, atoms, 3, "configurational:before");
}

void FixConfigurational::copy_arrays(int from, int to, int)
{
  for (int a = 0; a < 3; ++a) before_[to][a] = before_[from][a];
}

void FixConfigurational::set_arrays(int i)
{
  for (int a = 0; a < 3; ++a) before_[i][a] = 0;
}

int FixConfigurational::pack_exchange(int i, double *buffer)
{
  for (int a = 0; a < 3; ++a) buffer[a] = before_[i][a];
  return 3;
}

int FixConfigurational::unpack_exchange(int i, double *buffer)
{
  for (int a = 0; a < 3; ++a) before_[i][a] = buffer[a];
  return 3;
}

int FixConfigurational::pack_restart(int i, double *buffer)
{
  buffer[0] = size_restart(i);
  return 1 + pack_exchange(i, buffer + 1);
}

void FixConfigurational::unpack_restart(int i, int nth)
{
  const double *values = atom->extra[i];
  int m = 0;
  for (int k = 0; k < nth; ++k) m += static_cast<int>(values[m]);
  for (int a = 0; a < 3; ++a) before_[i][a] = values[m + 1 + a];
}

int FixConfigurational::size_restart(int)
{
  return 4;
}

int FixConfigurational::maxsize_restart()
{
  return 4;
}

int FixConfigurational::pack_forward_comm(int n, int *list, double *buffer, int, int *)
{
  return now_.pack_forward(n, list, buffer);
}

void FixConfigurational::unpack_forward_comm(int n, int first, double *buffer)
{
  now_.unpack_forward(n, first, buffer);
}

int FixConfigurational::pack_reverse_comm(int n, int first, double *buffer)
{
  return now_.pack_reverse(n, first, buffer);
}

void FixConfigurational::unpack_reverse_comm(int n, int *list, double *buffer)
{
  now_.unpack_reverse(n, list, buffer);
}

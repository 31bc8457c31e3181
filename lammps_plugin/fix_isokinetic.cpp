#include "fix_isokinetic.h"

#include "step_limit.h"

#include "atom.h"
#include "comm.h"
#include "error.h"
#include "update.h"

#include <cmath>
#include <string>

using namespace LAMMPS_NS;
using namespace FixConst;

FixIsokinetic::FixIsokinetic(LAMMPS *lmp, int narg, char **arg) :
    Fix(lmp, narg, arg), sllod_(std::string(arg[2]) == "isokinetic/sllod")
{
  if (narg != 4 && narg != 5)
    error->all(FLERR, "fix {}: takes the temperature and perhaps the directions", style);
  temperature_ = utils::numeric(FLERR, arg[3], false, lmp);
  if (!(temperature_ > 0))
    error->all(FLERR, "fix {}: temperature {}: must be positive", style, arg[3]);
  const std::string directions = narg == 5 ? arg[4] : "xyz";
  if (directions != "xyz" && directions != "x" && directions != "y" && directions != "z")
    error->all(FLERR, "fix {}: directions {}: must be xyz, x, y or z", style, directions);
  if (sllod_ && directions != "xyz")
    error->all(FLERR, "fix {}: directions {}: must be xyz", style, directions);
  if (directions == "z" && domain->dimension == 2)
    error->all(FLERR, "fix {}: directions z: there is no z in 2D", style);
  if (igroup != 0) error->all(FLERR, "fix {}: the group must be all", style);
  for (int a = 0; a < 3; ++a) held_[a] = directions.find("xyz"[a]) != std::string::npos;

  time_integrate = 1;
  scalar_flag = 1;
  global_freq = 1;
  extscalar = 0;
}

int FixIsokinetic::setmask()
{
  return INITIAL_INTEGRATE | FINAL_INTEGRATE;
}

void FixIsokinetic::init()
{
  if (std::string(update->unit_style) != "lj")
    error->all(FLERR, "fix {}: units {}: must be lj", style, update->unit_style);
  if (std::string(update->integrate_style).find("respa") == 0)
    error->all(FLERR, "fix {}: run_style respa is not supported", style);
  step_ = update->dt;
  inverse_.assign(atom->ntypes + 1, 0.0);
  if (!atom->rmass)
    for (int type = 1; type <= atom->ntypes; ++type) inverse_[type] = 1 / atom->mass[type];
}

void FixIsokinetic::reset_dt()
{
  step_ = update->dt;
}

double FixIsokinetic::mass(int i) const
{
  return atom->rmass ? atom->rmass[i] : atom->mass[atom->type[i]];
}

double FixIsokinetic::inverse_mass(int i) const
{
  return atom->rmass ? 1 / atom->rmass[i] : inverse_[atom->type[i]];
}

// The sum that gives canonical configurations at T: of n directions of N atoms, n are taken by the
// total momentum and one by the constraint.
void FixIsokinetic::setup(int)
{
  if (sllod_) flow_ = ShearFlow::of(*domain, *error, style);
  int directions = 0;
  for (int a = 0; a < domain->dimension; ++a) directions += held_[a];
  const double freedom = directions * (static_cast<double>(atom->natoms) - 1) - 1;
  if (!(freedom > 0)) error->all(FLERR, "fix {}: {} atoms: too few", style, atom->natoms);
  squares_ = freedom * temperature_;

  // sum m c^2 and the momentum of the held directions, and the mass
  double mine[5] = {0, 0, 0, 0, 0}, all[5];
  for (int i = 0; i < atom->nlocal; ++i) {
    const double m = mass(i);
    mine[4] += m;
    for (int a = 0; a < 3; ++a) {
      if (!held_[a]) continue;
      const double flow = a == 0 ? flow_.rate * (atom->x[i][1] - flow_.origin) : 0.0;
      const double c = atom->v[i][a] - flow;
      mine[0] += m * c * c;
      mine[1 + a] += m * c;
    }
  }
  MPI_Allreduce(mine, all, 5, MPI_DOUBLE, MPI_SUM, world);
  if (!(all[0] > 0))
    error->all(FLERR, "fix {}: the atoms are at rest: give them velocities (velocity create)", style);
  const double moving = (all[1] * all[1] + all[2] * all[2] + all[3] * all[3]) / all[4];
  if (moving > 1e-6 * all[0] && comm->me == 0)
    error->warning(FLERR,
                   "fix {}: {:.2g} of the kinetic energy is motion of the whole, which counts as "
                   "heat: use velocity all zero linear",
                   style, moving / all[0]);
}

// (2) and (3) over half a step at fixed positions, exactly: with a = F.p / (2K), b = F.(F/m) / (2K),
// p' = (p + F s) / (ds/dt), s = (a/b)(cosh(tau sqrt b) - 1) + sinh(tau sqrt b) / sqrt b. The length
// of p + F s is known, so that p' is put on the constraint to rounding, whatever p was.
FixIsokinetic::Kick FixIsokinetic::kick()
{
  const auto *__restrict x = reinterpret_cast<const double (*)[3]>(atom->x[0]);
  const auto *__restrict v = reinterpret_cast<const double (*)[3]>(atom->v[0]);
  const auto *__restrict f = reinterpret_cast<const double (*)[3]>(atom->f[0]);
  const double tau = step_ / 2, rate = flow_.rate, origin = flow_.origin;
  const int n = atom->nlocal;

  double pp[3] = {}, pf[3] = {}, ff[3] = {};    // by direction, so that no addition waits
  for (int i = 0; i < n; ++i) {
    const double m = mass(i), inverse = inverse_mass(i);
    const double c[3] = {v[i][0] - rate * (x[i][1] - origin), v[i][1], v[i][2]};
    for (int a = 0; a < 3; ++a) {
      pp[a] += m * c[a] * c[a];
      pf[a] += c[a] * f[i][a];
      ff[a] += f[i][a] * f[i][a] * inverse;
    }
  }
  double mine[3] = {}, all[3];
  for (int a = 0; a < 3; ++a) {
    if (!held_[a]) continue;
    mine[0] += pp[a];
    mine[1] += pf[a];
    mine[2] += ff[a];
  }
  MPI_Allreduce(mine, all, 3, MPI_DOUBLE, MPI_SUM, world);

  friction_ = all[1] / all[0];
  const double b = all[2] / all[0];
  const double angle = tau * std::sqrt(b);
  if (!(angle < 0.5))
    error->all(FLERR,
               "fix {}: step {}: the forces turn the velocities by {:.3g} in half a step, more than "
               "0.5: the timestep {} is too long for this field, use a shorter one",
               style, update->ntimestep, angle, update->dt);
  const double half = std::sinh(angle / 2);    // cosh - 1 = 2 half^2
  const double s = b > 0 ? friction_ / b * 2 * half * half + std::sinh(angle) / std::sqrt(b) : tau;
  const double norm = std::sqrt(squares_ / (all[0] + 2 * s * all[1] + s * s * all[2]));

  Kick kick;
  for (int a = 0; a < 3; ++a) {
    kick.velocity[a] = held_[a] ? norm : 1;
    kick.force[a] = held_[a] ? norm * s : tau;
  }
  return kick;
}

// Kicks, and with `flies` a flight of a step; the square of the longest.
template <bool flies> double FixIsokinetic::apply(const Kick &kick)
{
  auto *__restrict x = reinterpret_cast<double (*)[3]>(atom->x[0]);
  auto *__restrict v = reinterpret_cast<double (*)[3]>(atom->v[0]);
  const auto *__restrict f = reinterpret_cast<const double (*)[3]>(atom->f[0]);
  const int n = atom->nlocal;
  double fastest = 0;
  for (int i = 0; i < n; ++i) {
    const double inverse = inverse_mass(i);
    const double flow = flow_.rate * (x[i][1] - flow_.origin);
    v[i][0] = flow + kick.velocity[0] * (v[i][0] - flow) + kick.force[0] * f[i][0] * inverse;
    for (int a = 1; a < 3; ++a)
      v[i][a] = kick.velocity[a] * v[i][a] + kick.force[a] * f[i][a] * inverse;
    if constexpr (flies) {
      for (int a = 0; a < 3; ++a) x[i][a] += step_ * v[i][a];
      fastest = std::max(fastest, v[i][0] * v[i][0] + v[i][1] * v[i][1] + v[i][2] * v[i][2]);
    }
  }
  return step_ * step_ * fastest;
}

void FixIsokinetic::initial_integrate(int)
{
  double furthest;
  if (sllod_) {
    apply<false>(kick());
    furthest = drift_with_flow();
  } else
    furthest = apply<true>(kick());
  const double longest = longest_move(*neighbor);
  if (!(furthest < longest * longest)) stop(longest);
}

void FixIsokinetic::final_integrate()
{
  apply<false>(kick());
}

// SLLOD without forces: half a step of dc_x/dt = -rate c_y kept on the constraint, flight with the
// flow at constant c, and half a step again. Each part is exact.
double FixIsokinetic::drift_with_flow()
{
  auto *x = reinterpret_cast<double (*)[3]>(atom->x[0]);
  auto *v = reinterpret_cast<double (*)[3]>(atom->v[0]);
  const double rate = flow_.rate, origin = flow_.origin, shear = rate * step_ / 2;
  const int n = atom->nlocal;

  double xy = 0, yy = 0;    // sums of m c_x c_y and m c_y^2
  for (int i = 0; i < n; ++i) {
    const double m = mass(i);
    xy += m * (v[i][0] - rate * (x[i][1] - origin)) * v[i][1];
    yy += m * v[i][1] * v[i][1];
  }
  const double mine[2] = {xy, yy};
  double all[2], scale[2];
  MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_SUM, world);
  for (double &factor : scale) {
    factor = std::sqrt(squares_ / (squares_ - 2 * shear * all[0] + shear * shear * all[1]));
    all[0] = factor * factor * (all[0] - shear * all[1]);
    all[1] *= factor * factor;
  }

  double fastest = 0;
  for (int i = 0; i < n; ++i) {
    const double height = x[i][1] - origin;
    double c[3] = {v[i][0] - rate * height, v[i][1], v[i][2]};
    c[0] -= shear * c[1];
    for (double &component : c) component *= scale[0];
    for (int a = 0; a < 3; ++a) x[i][a] += step_ * c[a];
    x[i][0] += rate * step_ * (height + step_ / 2 * c[1]);
    fastest = std::max(fastest, c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
    c[0] -= shear * c[1];
    for (double &component : c) component *= scale[1];
    v[i][0] = rate * (x[i][1] - origin) + c[0];
    v[i][1] = c[1];
    v[i][2] = c[2];
  }
  return step_ * step_ * fastest;
}

void FixIsokinetic::stop(double longest)
{
  for (int i = 0; i < atom->nlocal; ++i) {
    const auto *v = atom->v[i];
    const double flow = flow_.rate * (atom->x[i][1] - flow_.origin);
    const double move = step_ * std::hypot(v[0] - flow, v[1], v[2]);
    if (!(move < longest)) stop_at_move(*error, style, *update, atom->tag[i], move, longest, "");
  }
}

double FixIsokinetic::compute_scalar()
{
  return friction_;
}

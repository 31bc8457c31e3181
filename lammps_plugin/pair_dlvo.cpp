#include "pair_dlvo.h"

#include "core/grid.h"
#include "core/philox.h"

#include "atom.h"
#include "comm.h"
#include "error.h"
#include "force.h"
#include "memory.h"
#include "neigh_list.h"
#include "neighbor.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <string>

using namespace LAMMPS_NS;
using mpc::Vector;

PairDLVO::PairDLVO(LAMMPS *lmp) : Pair(lmp)
{
  restartinfo = 0;
  single_enable = 1;
}

PairDLVO::~PairDLVO()
{
  if (!allocated) return;
  memory->destroy(setflag);
  memory->destroy(cutsq);
}

void PairDLVO::allocate()
{
  allocated = 1;
  types_ = atom->ntypes;
  memory->create(setflag, types_ + 1, types_ + 1, "pair:setflag");
  memory->create(cutsq, types_ + 1, types_ + 1, "pair:cutsq");
  for (int i = 1; i <= types_; ++i)
    for (int j = 1; j <= types_; ++j) setflag[i][j] = 0;
  spheres_.resize((types_ + 1) * (types_ + 1));
}

void PairDLVO::settings(int narg, char **arg)
{
  if (narg != 3) error->all(FLERR, "pair_style dlvo: needs cutoff, temperature and seed");
  cutoff_ = utils::numeric(FLERR, arg[0], false, lmp);
  temperature_ = utils::numeric(FLERR, arg[1], false, lmp);
  const auto seed = utils::bnumeric(FLERR, arg[2], false, lmp);
  if (!(cutoff_ > 0)) error->all(FLERR, "pair_style dlvo: cutoff {}: must be positive", arg[0]);
  if (!(temperature_ >= 0))
    error->all(FLERR, "pair_style dlvo: temperature {}: must not be negative", arg[1]);
  if (seed < 1) error->all(FLERR, "pair_style dlvo: seed {}: must be positive", arg[2]);
  seed_ = static_cast<std::uint64_t>(seed);
}

void PairDLVO::coeff(int narg, char **arg)
{
  if (narg < 3) error->all(FLERR, "pair_coeff dlvo: needs two atom types and the diameter");
  if (!allocated) allocate();
  int ilo, ihi, jlo, jhi;
  utils::bounds(FLERR, arg[0], 1, types_, ilo, ihi, error);
  utils::bounds(FLERR, arg[1], 1, types_, jlo, jhi, error);

  Spheres given;
  given.cutoff = cutoff_;
  const auto value = [&](int i, const char *name, bool zero) {
    const double number = utils::numeric(FLERR, arg[i], false, lmp);
    if (!(zero ? number >= 0 : number > 0) || !std::isfinite(number))
      error->all(FLERR, "pair_coeff dlvo: {} {}: must {}", name, arg[i],
                 zero ? "not be negative" : "be positive");
    return number;
  };
  given.diameter = value(2, "diameter", false);
  for (int i = 3; i < narg;) {
    const std::string keyword = arg[i];
    const int count = keyword == "coulomb" ? 2 : keyword == "lubrication" ? 3 : 1;
    if (i + count >= narg)
      error->all(FLERR, "pair_coeff dlvo: {}: needs {} value(s)", keyword, count);
    if (keyword == "coulomb") {
      given.charge = value(i + 1, "coulomb strength", true);
      given.kappa = value(i + 2, "coulomb kappa", false);
    } else if (keyword == "vdw") {
      given.hamaker = value(i + 1, "vdw", true);
    } else if (keyword == "hertz") {
      given.hertz = value(i + 1, "hertz", true);
    } else if (keyword == "minimum") {
      given.depth = value(i + 1, "minimum", false);
    } else if (keyword == "damping") {
      given.damping = value(i + 1, "damping", true);
    } else if (keyword == "friction") {
      given.friction = value(i + 1, "friction", true);
    } else if (keyword == "lubrication") {
      given.viscosity = value(i + 1, "lubrication viscosity", true);
      given.closest = value(i + 2, "lubrication closest gap", false);
      given.farthest = value(i + 3, "lubrication farthest gap", false);
    } else if (keyword == "cutoff") {
      given.cutoff = value(i + 1, "cutoff", false);
    } else {
      error->all(FLERR, "pair_coeff dlvo: unknown keyword {}", keyword);
    }
    i += count + 1;
  }
  if (given.hamaker > 0 && given.depth == 0)
    error->all(FLERR, "pair_coeff dlvo: minimum: needed with vdw, which diverges at contact");
  if (given.hamaker > 0) given.join();
  if (given.cutoff <= std::max(given.diameter, given.joint))
    error->all(FLERR, "pair_coeff dlvo: cutoff {}: must be beyond contact and minimum, {}",
               given.cutoff, std::max(given.diameter, given.joint));

  for (int i = ilo; i <= ihi; ++i)
    for (int j = std::max(jlo, i); j <= jhi; ++j) {
      of(i, j) = of(j, i) = given;
      setflag[i][j] = 1;
    }
}

void PairDLVO::init_style()
{
  dissipates_ = rubs_ = false;
  for (const auto &spheres : spheres_) {
    rubs_ |= spheres.friction > 0;
    dissipates_ |= spheres.friction > 0 || spheres.damping > 0 || spheres.viscosity > 0;
  }
  if (rubs_ && !atom->omega_flag)
    error->all(FLERR, "pair_style dlvo: friction: needs atom_style sphere, it makes torques");
  if (dissipates_ && !comm->ghost_velocity)
    error->all(FLERR, "pair_style dlvo: damping, friction and lubrication need comm_modify vel yes");
  neighbor->add_request(this);
}

double PairDLVO::init_one(int i, int j)
{
  if (!setflag[i][j]) error->all(FLERR, "pair_style dlvo: no pair_coeff for types {} {}", i, j);
  auto &spheres = of(i, j);
  spheres.shift = 0;
  if (offset_flag) spheres.shift = spheres.energy(spheres.cutoff);
  of(j, i) = spheres;
  return std::max(spheres.cutoff, spheres.diameter + spheres.farthest);
}

// (1); so far out that it is no more than a rounding of the strength, nothing.
double PairDLVO::Spheres::coulomb(double r) const
{
  const double exponent = kappa * (r - diameter);
  return exponent < 40 ? charge * diameter * diameter / r * std::exp(-exponent) : 0.0;
}

// (1) and (2).
double PairDLVO::Spheres::dlvo_energy(double r) const
{
  if (hamaker == 0) return coulomb(r);
  const double ratio = diameter * diameter / (r * r);
  return coulomb(r) - hamaker / 12 * (ratio / (1 - ratio) + ratio + 2 * std::log1p(-ratio));
}

double PairDLVO::Spheres::dlvo_force(double r) const
{
  const double d2 = diameter * diameter, gap = r * r - d2;
  const double repulsion = charge > 0 ? coulomb(r) * (1 / r + kappa) : 0.0;
  return repulsion - hamaker / 6 * d2 * d2 * d2 / (r * r * r * gap * gap);
}

// With the parabola -depth + stiffness (r - d)^2 / 2 from contact to the joint, and (3) below contact.
double PairDLVO::Spheres::energy(double r) const
{
  const double gap = std::max(r - diameter, 0.0), overlap = std::max(diameter - r, 0.0);
  const double outer = hamaker > 0 && r < joint ? -depth + 0.5 * stiffness * gap * gap
                                                : dlvo_energy(r);
  return outer + hertz * overlap * overlap * std::sqrt(overlap) - shift;
}

double PairDLVO::Spheres::force(double r) const
{
  double force;
  if (hamaker > 0)
    force = r < joint ? -stiffness * std::max(r - diameter, 0.0) : dlvo_force(r);
  else
    force = coulomb(r) * (1 / r + kappa);
  if (r < diameter) force += 2.5 * hertz * (diameter - r) * std::sqrt(diameter - r);
  return force;
}

// The innermost gap h with V(h) + depth = h V'(h) / 2: there a parabola from the depth at contact has
// the energy and the force of V.
void PairDLVO::Spheres::join()
{
  const auto excess = [&](double gap) {
    const double r = diameter + gap;
    return dlvo_energy(r) + depth + 0.5 * gap * dlvo_force(r);
  };
  double inner = 1e-8 * diameter, outer = inner;
  while (excess(outer) < 0) {
    inner = outer;
    outer *= 1.01;
  }
  for (int step = 0; step < 200; ++step) {
    const double middle = 0.5 * (inner + outer);
    (excess(middle) < 0 ? inner : outer) = middle;
  }
  joint = diameter + outer;
  stiffness = -dlvo_force(joint) / outer;
}

// Of the relative velocity along the line of centres: lubrication (4), largest in contact and zero
// from the farthest gap on, and damping (6 corrected).
double PairDLVO::Spheres::normal_friction(double r) const
{
  const double gap = r - diameter;
  double friction = 0;
  if (viscosity > 0 && gap < farthest) {
    const double reduced = 0.25 * diameter;    // (5)
    friction = 6 * M_PI * viscosity * reduced * reduced *
        (1 / (std::max(gap, 0.0) + closest) - 1 / (farthest + closest));
  }
  if (gap < 0) friction += damping * std::sqrt(-gap);
  return friction;
}

void PairDLVO::compute(int eflag, int vflag)
{
  ev_init(eflag, vflag);
  double **x = atom->x, **v = atom->v, **f = atom->f;
  double **omega = atom->omega, **torque = atom->torque;
  const int *type = atom->type;
  const tagint *tag = atom->tag;
  const int nlocal = atom->nlocal, newton = force->newton_pair;
  const mpc::CounterRandom random{seed_, static_cast<std::uint64_t>(update->ntimestep)};
  const double noise = std::sqrt(2 * temperature_ / update->dt);

  for (int ii = 0; ii < list->inum; ++ii) {
    const int i = list->ilist[ii];
    for (int jj = 0; jj < list->numneigh[i]; ++jj) {
      const int j = list->firstneigh[i][jj] & NEIGHMASK;
      Vector<3> e;    // from j to i
      for (int a = 0; a < 3; ++a) e[a] = x[i][a] - x[j][a];
      const double r2 = mpc::square<3>(e);
      const int itype = type[i], jtype = type[j];
      if (r2 >= cutsq[itype][jtype]) continue;
      const auto &spheres = of(itype, jtype);
      const double r = std::sqrt(r2), inverse = 1 / r;
      for (double &component : e) component *= inverse;

      double along = r < spheres.cutoff ? spheres.force(r) : 0;
      Vector<3> pull{};
      const double friction = dissipates_ ? spheres.normal_friction(r) : 0;
      const bool rubbing = spheres.friction > 0 && r < spheres.diameter;
      if (friction > 0 || rubbing) {
        Vector<3> relative;
        for (int a = 0; a < 3; ++a) relative[a] = v[i][a] - v[j][a];
        double approach = 0;
        for (int a = 0; a < 3; ++a) approach += relative[a] * e[a];
        std::array<double, 4> z{};
        if (temperature_ > 0) {
          const auto [low, high] = std::minmax(tag[i], tag[j]);
          z = mpc::normals<4>(random.words(mpc::Stream::Pair, low, high));
          if (tag[i] != low)    // across the line of centres; along it e has another sign
            for (int k = 1; k < 4; ++k) z[k] = -z[k];
        }
        along += noise * std::sqrt(friction) * z[0] - friction * approach;
        if (rubbing) {
          // of the surfaces where they touch, half way between the centres
          Vector<3> spin, turn;
          for (int a = 0; a < 3; ++a) spin[a] = 0.5 * r * (omega[i][a] + omega[j][a]);
          turn = mpc::cross(spin, e);
          const double strength = noise * std::sqrt(spheres.friction);
          double normal = 0;
          for (int a = 0; a < 3; ++a) {
            pull[a] = strength * z[a + 1] - spheres.friction * (relative[a] - turn[a]);
            normal += pull[a] * e[a];
          }
          for (int a = 0; a < 3; ++a) pull[a] -= normal * e[a];
          const auto twist = mpc::torque(e, pull);
          for (int a = 0; a < 3; ++a) {
            torque[i][a] -= 0.5 * r * twist[a];
            if (newton || j < nlocal) torque[j][a] -= 0.5 * r * twist[a];
          }
        }
      }
      for (int a = 0; a < 3; ++a) {
        pull[a] += along * e[a];
        f[i][a] += pull[a];
        if (newton || j < nlocal) f[j][a] -= pull[a];
      }
      if (!evflag) continue;
      const double energy = eflag && r < spheres.cutoff ? spheres.energy(r) : 0;
      ev_tally_xyz(i, j, nlocal, newton, energy, 0.0, pull[0], pull[1], pull[2],
                   r * e[0], r * e[1], r * e[2]);
    }
  }
  if (vflag_fdotr) virial_fdotr_compute();
}

double PairDLVO::single(int, int, int itype, int jtype, double rsq, double, double, double &fforce)
{
  const auto &spheres = of(itype, jtype);
  const double r = std::sqrt(rsq);
  if (r >= spheres.cutoff) return fforce = 0;
  fforce = spheres.force(r) / r;
  return spheres.energy(r);
}

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
  near_.resize(spheres_.size());
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
inline double PairDLVO::Spheres::coulomb(double r, double inverse) const
{
  const double exponent = kappa * (r - diameter);
  return exponent < 40 ? charge * diameter * diameter * inverse * mpc::exponential(-exponent) : 0.0;
}

// (1) and (2).
double PairDLVO::Spheres::dlvo_energy(double r) const
{
  if (hamaker == 0) return coulomb(r, 1 / r);
  const double ratio = diameter * diameter / (r * r);
  return coulomb(r, 1 / r) - hamaker / 12 * (ratio / (1 - ratio) + ratio + 2 * std::log1p(-ratio));
}

// With the inverse of r, for divisions take longer than the rest.
inline double PairDLVO::Spheres::dlvo_force(double r, double inverse) const
{
  const double d2 = diameter * diameter, ratio = d2 * inverse * inverse, gap = r * r - d2;
  const double repulsion = coulomb(r, inverse) * (inverse + kappa);
  return hamaker > 0 ? repulsion - hamaker / 6 * d2 * d2 * ratio * inverse / (gap * gap) : repulsion;
}

// With the parabola -depth + stiffness (r - d)^2 / 2 from contact to the joint, and (3) below contact.
double PairDLVO::Spheres::energy(double r) const
{
  const double gap = std::max(r - diameter, 0.0), overlap = std::max(diameter - r, 0.0);
  const double outer = hamaker > 0 && r < joint ? -depth + 0.5 * stiffness * gap * gap
                                                : dlvo_energy(r);
  return outer + hertz * overlap * overlap * std::sqrt(overlap) - shift;
}

// Without branches, for loops over many.
inline double PairDLVO::Spheres::force(double r, double inverse) const
{
  const double outer = dlvo_force(r, inverse);
  const double overlap = r < diameter ? diameter - r : 0, gap = r < diameter ? 0 : r - diameter;
  const double force = r < joint ? -stiffness * gap : outer;
  return force + 2.5 * hertz * overlap * std::sqrt(overlap);
}

// The innermost gap h with V(h) + depth = h V'(h) / 2: there a parabola from the depth at contact has
// the energy and the force of V.
void PairDLVO::Spheres::join()
{
  const auto excess = [&](double gap) {
    const double r = diameter + gap;
    return dlvo_energy(r) + depth + 0.5 * gap * dlvo_force(r, 1 / r);
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
  stiffness = -dlvo_force(joint, 1 / joint) / outer;
}

// Of the relative velocity along the line of centres: lubrication (4), largest in contact and zero
// from the farthest gap on, and damping (6 corrected).
inline double PairDLVO::Spheres::normal_friction(double r) const
{
  const double gap = r < diameter ? 0 : r - diameter, overlap = r < diameter ? diameter - r : 0;
  const double reduced = 0.25 * diameter;    // (5)
  const double squeezed = 6 * M_PI * viscosity * reduced * reduced *
      (1 / (gap + closest) - 1 / (farthest + closest));
  return (gap < farthest ? squeezed : 0) + damping * std::sqrt(overlap);
}

void PairDLVO::compute(int eflag, int vflag)
{
  ev_init(eflag, vflag);
  const int *type = atom->type;
  for (int ii = 0; ii < list->inum; ++ii) {
    const int i = list->ilist[ii], *neighbors = list->firstneigh[i], count = list->numneigh[i];
    const auto types = static_cast<std::size_t>(type[i]) * (types_ + 1);
    if (types_ == 1) {
      gather(types + 1, i, neighbors, count, eflag);
    } else {
      for (int jj = 0; jj < count; ++jj)
        gather(types + type[neighbors[jj] & NEIGHMASK], i, neighbors + jj, 1, eflag);
    }
  }
  for (std::size_t types = 0; types < near_.size(); ++types)
    if (near_[types].count > 0) act(spheres_[types], near_[types], eflag);
  if (vflag_fdotr) virial_fdotr_compute();
}

// Pairs of two types, as the list has them: whether they are in range is told by their forces.
inline void PairDLVO::gather(std::size_t types, int i, const int *neighbors, int count, int eflag)
{
  auto &pairs = near_[types];
  double **x = atom->x;
  const double xi = x[i][0], yi = x[i][1], zi = x[i][2];
  while (count > 0) {
    const int first = pairs.count, some = std::min(count, Pairs::MOST - first);
    for (int n = 0; n < some; ++n) {
      const int j = neighbors[n] & NEIGHMASK, k = first + n;
      pairs.i[k] = i;
      pairs.j[k] = j;
      pairs.x[k] = xi - x[j][0];
      pairs.y[k] = yi - x[j][1];
      pairs.z[k] = zi - x[j][2];
    }
    pairs.count += some;
    neighbors += some;
    count -= some;
    if (pairs.count == Pairs::MOST) act(spheres_[types], pairs, eflag);
  }
}

// All that the pairs gathered do.
void PairDLVO::act(const Spheres &spheres, Pairs &pairs, int eflag)
{
  repel(spheres, pairs);
  if (dissipates_) dissipate(spheres, pairs);
  if (evflag)
    tally(spheres, pairs, eflag);
  else
    push(pairs);
  pairs.count = 0;
}

// (1) to (3). A function of its own: inlined, GCC 12 leaves the vector registers' upper halves in use
// (no vzeroupper), and LAMMPS's own styles, of older instructions, then take twice as long.
[[gnu::noinline]] void PairDLVO::repel(const Spheres &given, Pairs &pairs)
{
  const Spheres spheres = given;
  const int count = pairs.count;
  for (int k = 0; k < count; ++k) {
    const double ex = pairs.x[k], ey = pairs.y[k], ez = pairs.z[k];
    const double r = std::sqrt(ex * ex + ey * ey + ez * ez), inverse = 1 / r;
    pairs.x[k] = ex * inverse;
    pairs.y[k] = ey * inverse;
    pairs.z[k] = ez * inverse;
    pairs.r[k] = r;
    const double force = spheres.force(r, inverse);
    pairs.along[k] = r < spheres.cutoff ? force : 0;
  }
}

// Of all pairs; those of an atom follow each other.
void PairDLVO::push(const Pairs &pairs)
{
  double *f = atom->f[0];
  const int count = pairs.count, own = force->newton_pair ? atom->nlocal + atom->nghost : atom->nlocal;
  for (int k = 0; k < count;) {
    const int i = pairs.i[k];
    double fx = 0, fy = 0, fz = 0;
    for (; k < count && pairs.i[k] == i; ++k) {
      const double px = pairs.along[k] * pairs.x[k], py = pairs.along[k] * pairs.y[k],
                   pz = pairs.along[k] * pairs.z[k];
      fx += px;
      fy += py;
      fz += pz;
      if (pairs.j[k] >= own) continue;
      double *fj = f + 3 * pairs.j[k];
      fj[0] -= px;
      fj[1] -= py;
      fj[2] -= pz;
    }
    f[3 * i] += fx;
    f[3 * i + 1] += fy;
    f[3 * i + 2] += fz;
  }
}

// The same, with the energy and the virial.
void PairDLVO::tally(const Spheres &spheres, const Pairs &pairs, int eflag)
{
  for (int k = 0; k < pairs.count; ++k) {
    const double e[3] = {pairs.x[k], pairs.y[k], pairs.z[k]}, r = pairs.r[k];
    const double energy = eflag && r < spheres.cutoff ? spheres.energy(r) : 0;
    const double f = pairs.along[k];
    push(pairs.i[k], pairs.j[k], {f * e[0], f * e[1], f * e[2]}, e, r, energy);
  }
}

// Friction along the line of centres, and of surfaces in contact, with the noise that they demand.
void PairDLVO::dissipate(const Spheres &spheres, Pairs &pairs)
{
  const int count = pairs.count;
  for (int k = 0; k < count; ++k) pairs.friction[k] = spheres.normal_friction(pairs.r[k]);
  const bool rough = spheres.friction > 0;
  Pairs::Each<int> near;
  int found = 0;
  for (int k = 0; k < count; ++k) {
    near[found] = k;
    found += (pairs.friction[k] > 0) | (rough & (pairs.r[k] < spheres.diameter));
  }

  const mpc::CounterRandom random{seed_, static_cast<std::uint64_t>(update->ntimestep)};
  const tagint *tag = atom->tag;
  Pairs::Each<mpc::Words> words;
  Pairs::Each<double> first, second, z;
  z.fill(0);
  if (temperature_ > 0) {
    for (int n = 0; n < found; ++n) {
      const auto [low, high] = std::minmax(tag[pairs.i[near[n]]], tag[pairs.j[near[n]]]);
      words[n] = random.words(mpc::Stream::Pair, low, high);
      first[n] = mpc::uniform(words[n][0]);
      second[n] = mpc::uniform(words[n][1]);
    }
    for (int n = 0; n < found; ++n) z[n] = mpc::normal_pair(first[n], second[n])[0];
  }
  double **v = atom->v;
  const double noise = std::sqrt(2 * temperature_ / update->dt);
  for (int n = 0; n < found; ++n) {
    const int k = near[n];
    const double *vi = v[pairs.i[k]], *vj = v[pairs.j[k]];
    const double approach = (vi[0] - vj[0]) * pairs.x[k] + (vi[1] - vj[1]) * pairs.y[k] +
        (vi[2] - vj[2]) * pairs.z[k];
    pairs.along[k] += noise * std::sqrt(pairs.friction[k]) * z[n] - pairs.friction[k] * approach;
    if (rough && pairs.r[k] < spheres.diameter)
      rub(spheres, pairs, k, temperature_ > 0 ? mpc::normals<4>(words[n]) : Normals{});
  }
}

// Friction of the surfaces where they touch, half way between the centres; of the noise the last
// three.
void PairDLVO::rub(const Spheres &spheres, const Pairs &pairs, int k, const Normals &z)
{
  const int i = pairs.i[k], j = pairs.j[k];
  const double *vi = atom->v[i], *vj = atom->v[j], *oi = atom->omega[i], *oj = atom->omega[j];
  const Vector<3> e{pairs.x[k], pairs.y[k], pairs.z[k]};
  const double arm = 0.5 * pairs.r[k];
  const Vector<3> spin{arm * (oi[0] + oj[0]), arm * (oi[1] + oj[1]), arm * (oi[2] + oj[2])};
  const auto turn = mpc::cross(spin, e);
  const double noise = std::sqrt(2 * temperature_ / update->dt * spheres.friction);
  const double sign = atom->tag[i] < atom->tag[j] ? 1 : -1;    // along, e has it
  Vector<3> pull;
  double normal = 0;
  for (int a = 0; a < 3; ++a) {
    pull[a] = sign * noise * z[a + 1] - spheres.friction * (vi[a] - vj[a] - turn[a]);
    normal += pull[a] * e[a];
  }
  for (int a = 0; a < 3; ++a) pull[a] -= normal * e[a];
  const auto twist = mpc::torque(e, pull);
  double **torque = atom->torque;
  for (int a = 0; a < 3; ++a) {
    torque[i][a] -= arm * twist[a];
    if (force->newton_pair || j < atom->nlocal) torque[j][a] -= arm * twist[a];
  }
  push(i, j, pull, e.data(), pairs.r[k], 0);
}

inline void PairDLVO::push(int i, int j, const Vector<3> &pull, const double *e, double r,
                           double energy)
{
  double **f = atom->f;
  const int newton = force->newton_pair;
  for (int a = 0; a < 3; ++a) {
    f[i][a] += pull[a];
    if (newton || j < atom->nlocal) f[j][a] -= pull[a];
  }
  if (evflag)
    ev_tally_xyz(i, j, atom->nlocal, newton, energy, 0.0, pull[0], pull[1], pull[2], r * e[0],
                 r * e[1], r * e[2]);
}

double PairDLVO::single(int, int, int itype, int jtype, double rsq, double, double, double &fforce)
{
  const auto &spheres = of(itype, jtype);
  const double r = std::sqrt(rsq);
  if (r >= spheres.cutoff) return fforce = 0;
  fforce = spheres.force(r, 1 / r) / r;
  return spheres.energy(r);
}

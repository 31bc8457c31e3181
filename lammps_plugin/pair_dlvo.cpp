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

namespace {

constexpr double FARTHEST_COULOMB = 40;    // decay lengths: there it is no more than a rounding
constexpr double MARGIN = 1.0 / 64;        // of the reach: few more pairs, for some ten steps

}    // namespace

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
  far_.resize(spheres_.size());
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
  given.least = given.diameter * given.diameter;
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
  const double charged = spheres.diameter + FARTHEST_COULOMB / spheres.kappa;
  spheres.near = std::max(spheres.joint, spheres.diameter);
  if (spheres.charge > 0) spheres.near = std::max(spheres.near, std::min(charged, spheres.cutoff));
  if (spheres.viscosity > 0)
    spheres.near = std::max(spheres.near, spheres.diameter + spheres.farthest);
  spheres.far = spheres.hamaker > 0 ? std::max(spheres.cutoff, spheres.near) : spheres.near;
  of(j, i) = spheres;
  return std::max(spheres.cutoff, spheres.diameter + spheres.farthest);
}

// (1); so far out that it is no more than a rounding of the strength, nothing.
inline double PairDLVO::Spheres::coulomb(double r, double inverse) const
{
  const double exponent = kappa * (r - diameter);
  return exponent < FARTHEST_COULOMB
      ? charge * diameter * diameter * inverse * mpc::exponential(-exponent)
      : 0.0;
}

// (1) and (2).
double PairDLVO::Spheres::dlvo_energy(double r) const
{
  if (hamaker == 0) return coulomb(r, 1 / r);
  const double ratio = diameter * diameter / (r * r);
  return coulomb(r, 1 / r) - hamaker / 12 * (ratio / (1 - ratio) + ratio + 2 * std::log1p(-ratio));
}

inline double PairDLVO::Spheres::dlvo_force(double r) const
{
  return coulomb(r, 1 / r) * (1 / r + kappa) + r * attraction(r * r);
}

// The force (2) over the distance.
inline double PairDLVO::Spheres::attraction(double square) const
{
  const double d2 = diameter * diameter, gap = square - d2, both = square * gap;
  return -hamaker / 6 * d2 * d2 * d2 / (both * both);
}

// With the parabola -depth + stiffness (r - d)^2 / 2 from contact to the joint, and (3) below contact.
double PairDLVO::Spheres::energy(double r) const
{
  const double gap = std::max(r - diameter, 0.0), overlap = std::max(diameter - r, 0.0);
  const double outer = hamaker > 0 && r < joint ? -depth + 0.5 * stiffness * gap * gap
                                                : dlvo_energy(r);
  return outer + hertz * overlap * overlap * std::sqrt(overlap) - shift;
}

// The force over the distance, without branches, for loops over many. It has one division, as
// divisions take longer than the rest.
inline double PairDLVO::Spheres::pull(double square) const
{
  const double d2 = diameter * diameter, r = std::sqrt(square);
  const double gap = std::max(square - d2, least), gap2 = gap * gap;
  const double both = 1 / (square * gap2), inverse_square = gap2 * both, inverse = r * inverse_square;
  const double outer = coulomb(r, inverse) * (inverse + kappa) * inverse -
      hamaker / 6 * d2 * d2 * d2 * inverse_square * both;
  const double overlap = r < diameter ? diameter - r : 0, beyond = r < diameter ? 0 : r - diameter;
  const double inner = r < joint ? -stiffness * beyond * inverse : outer;
  return inner + 2.5 * hertz * overlap * std::sqrt(overlap) * inverse;
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
  least = joint * joint - diameter * diameter;
  stiffness = -dlvo_force(joint) / outer;
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
  if (neighbor->ago == 0 || moved()) sort();
  for (std::size_t types = 0; types < spheres_.size(); ++types) {
    act(spheres_[types], near_[types], true, eflag);
    act(spheres_[types], far_[types], false, eflag);
  }
  if (vflag_fdotr) virial_fdotr_compute();
}

// Whether pairs may have come in reach since they were sorted: two atoms by half the margin each.
[[gnu::noinline]] bool PairDLVO::moved() const
{
  const double *x = atom->x[0], *places = places_.data();
  const double most = margin_ / (2 * std::sqrt(3.0));    // along each axis
  const int count = static_cast<int>(places_.size());
  int moved = 0;
  for (int k = 0; k < count; ++k) moved |= std::abs(x[k] - places[k]) > most;
  return moved;
}

// Pairs that are in reach, or may come there soon, by what they need.
void PairDLVO::sort()
{
  double **x = atom->x;
  const int *type = atom->type, atoms = atom->nlocal + atom->nghost;
  places_.assign(x[0], x[0] + 3 * atoms);
  double reach = 0;
  for (const auto &spheres : spheres_) reach = std::max(reach, spheres.far);
  margin_ = MARGIN * reach;
  for (auto *ranges : {&near_, &far_})
    for (auto &listed : *ranges) {
      listed.i.clear();
      listed.j.clear();
    }
  for (int ii = 0; ii < list->inum; ++ii) {
    const int i = list->ilist[ii], *neighbors = list->firstneigh[i], count = list->numneigh[i];
    const auto types = static_cast<std::size_t>(type[i]) * (types_ + 1);
    for (int jj = 0; jj < count; ++jj) {
      const int j = neighbors[jj] & NEIGHMASK;
      const auto &spheres = spheres_[types + type[j]];
      double square = 0;
      for (int a = 0; a < 3; ++a) square += (x[i][a] - x[j][a]) * (x[i][a] - x[j][a]);
      const double near = spheres.near + margin_, far = spheres.far + margin_;
      if (!(square < far * far)) continue;
      auto &listed = (square < near * near ? near_ : far_)[types + type[j]];
      listed.i.push_back(i);
      listed.j.push_back(j);
    }
  }
}

// All that the pairs of a range do, some at a time.
void PairDLVO::act(const Spheres &spheres, const Listed &listed, bool near, int eflag)
{
  const int all = static_cast<int>(listed.i.size());
  for (int first = 0; first < all; first += Pairs::MOST) {
    gather(listed, first, std::min(all - first, Pairs::MOST));
    if (near)
      repel(spheres);
    else
      attract(spheres);
    if (near && dissipates_) dissipate(spheres);
    if (evflag)
      tally(spheres, eflag);
    else
      push();
  }
}

void PairDLVO::gather(const Listed &listed, int first, int count)
{
  const double *x = atom->x[0];
  pairs_.count = count;
  pairs_.i = listed.i.data() + first;
  pairs_.j = listed.j.data() + first;
  for (int k = 0; k < count; ++k) {
    const double *xi = x + 3 * pairs_.i[k], *xj = x + 3 * pairs_.j[k];
    pairs_.x[k] = xi[0] - xj[0];
    pairs_.y[k] = xi[1] - xj[1];
    pairs_.z[k] = xi[2] - xj[2];
  }
}

// (1) to (3). This and the next are functions of their own: inlined, GCC 12 leaves the vector
// registers' upper halves in use (no vzeroupper), and LAMMPS's own styles, of older instructions,
// then take twice as long.
[[gnu::noinline]] void PairDLVO::repel(const Spheres &given)
{
  const Spheres spheres = given;
  const double most = spheres.cutoff * spheres.cutoff;
  for (int k = 0; k < pairs_.count; ++k) {
    const double square = pairs_.square(k), pull = spheres.pull(square);
    pairs_.pull[k] = square < most ? pull : 0;
  }
}

// (2) alone.
[[gnu::noinline]] void PairDLVO::attract(const Spheres &given)
{
  const Spheres spheres = given;
  const double most = spheres.cutoff * spheres.cutoff;
  for (int k = 0; k < pairs_.count; ++k) {
    const double square = pairs_.square(k), pull = spheres.attraction(square);
    pairs_.pull[k] = square < most ? pull : 0;
  }
}

void PairDLVO::push()
{
  double *f = atom->f[0];
  const int count = pairs_.count, *i_of = pairs_.i, *j_of = pairs_.j;
  const int own = force->newton_pair ? atom->nlocal + atom->nghost : atom->nlocal;
  for (int k = 0; k < count;) {
    const int i = i_of[k];
    double fx = 0, fy = 0, fz = 0;
    for (; k < count && i_of[k] == i; ++k) {
      const double px = pairs_.pull[k] * pairs_.x[k], py = pairs_.pull[k] * pairs_.y[k],
                   pz = pairs_.pull[k] * pairs_.z[k];
      fx += px;
      fy += py;
      fz += pz;
      if (j_of[k] >= own) continue;
      double *fj = f + 3 * j_of[k];
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
void PairDLVO::tally(const Spheres &spheres, int eflag)
{
  for (int k = 0; k < pairs_.count; ++k) {
    const double r = std::sqrt(pairs_.square(k)), pull = pairs_.pull[k];
    const Vector from{pairs_.x[k], pairs_.y[k], pairs_.z[k]};
    const double energy = eflag && r < spheres.cutoff ? spheres.energy(r) : 0;
    push(pairs_.i[k], pairs_.j[k], {pull * from[0], pull * from[1], pull * from[2]}, from, energy);
  }
}

// Friction along the line of centres, and of surfaces in contact, with the noise that they demand.
void PairDLVO::dissipate(const Spheres &spheres)
{
  const int count = pairs_.count, *i_of = pairs_.i, *j_of = pairs_.j;
  normal_friction(spheres);
  const bool rough = spheres.friction > 0;
  Pairs::Each<int> near;
  int found = 0;
  for (int k = 0; k < count; ++k) {
    near[found] = k;
    found += (pairs_.friction[k] > 0) | (rough & (pairs_.r[k] < spheres.diameter));
  }

  const mpc::CounterRandom random{seed_, static_cast<std::uint64_t>(update->ntimestep)};
  const tagint *tag = atom->tag;
  Pairs::Each<mpc::Words> words;
  Pairs::Each<double> first, second, z;
  z.fill(0);
  if (temperature_ > 0) {
    for (int n = 0; n < found; ++n) {
      const auto [low, high] = std::minmax(tag[i_of[near[n]]], tag[j_of[near[n]]]);
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
    const double *vi = v[i_of[k]], *vj = v[j_of[k]], inverse = 1 / pairs_.r[k];
    const Vector e{inverse * pairs_.x[k], inverse * pairs_.y[k], inverse * pairs_.z[k]};
    const double approach =
        (vi[0] - vj[0]) * e[0] + (vi[1] - vj[1]) * e[1] + (vi[2] - vj[2]) * e[2];
    pairs_.pull[k] += inverse *
        (noise * std::sqrt(pairs_.friction[k]) * z[n] - pairs_.friction[k] * approach);
    if (rough && pairs_.r[k] < spheres.diameter)
      rub(spheres, k, e, temperature_ > 0 ? mpc::normals<4>(words[n]) : Normals{});
  }
}

// Of each pair, with its distance.
[[gnu::noinline]] void PairDLVO::normal_friction(const Spheres &given)
{
  const Spheres spheres = given;
  for (int k = 0; k < pairs_.count; ++k) {
    const double r = pairs_.r[k] = std::sqrt(pairs_.square(k));
    pairs_.friction[k] = spheres.normal_friction(r);
  }
}

// Friction of the surfaces where they touch, half way between the centres; of the noise the last
// three.
void PairDLVO::rub(const Spheres &spheres, int k, const Vector &e, const Normals &z)
{
  const int i = pairs_.i[k], j = pairs_.j[k];
  const double *vi = atom->v[i], *vj = atom->v[j], *oi = atom->omega[i], *oj = atom->omega[j];
  const double arm = 0.5 * pairs_.r[k];
  const Vector spin{arm * (oi[0] + oj[0]), arm * (oi[1] + oj[1]), arm * (oi[2] + oj[2])};
  const auto turn = mpc::cross(spin, e);
  const double noise = std::sqrt(2 * temperature_ / update->dt * spheres.friction);
  const double sign = atom->tag[i] < atom->tag[j] ? 1 : -1;    // along, e has it
  Vector pull;
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
  push(i, j, pull, {pairs_.x[k], pairs_.y[k], pairs_.z[k]}, 0);
}

inline void PairDLVO::push(int i, int j, const Vector &pull, const Vector &from, double energy)
{
  double **f = atom->f;
  const int newton = force->newton_pair;
  for (int a = 0; a < 3; ++a) {
    f[i][a] += pull[a];
    if (newton || j < atom->nlocal) f[j][a] -= pull[a];
  }
  if (evflag)
    ev_tally_xyz(i, j, atom->nlocal, newton, energy, 0.0, pull[0], pull[1], pull[2], from[0],
                 from[1], from[2]);
}

double PairDLVO::single(int, int, int itype, int jtype, double rsq, double, double, double &fforce)
{
  const auto &spheres = of(itype, jtype);
  const double r = std::sqrt(rsq);
  if (r >= spheres.cutoff) return fforce = 0;
  fforce = spheres.pull(rsq);
  return spheres.energy(r);
}

#include "pair_soft.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "force.h"
#include "memory.h"
#include "neigh_list.h"
#include "neighbor.h"
#include "utils.h"

#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;

template <class Potential> PairSoft<Potential>::PairSoft(LAMMPS *lmp) : PairSmooth(lmp)
{
  restartinfo = 1;
  single_enable = 1;
}

template <class Potential> PairSoft<Potential>::~PairSoft()
{
  if (copymode || !allocated) return;
  memory->destroy(setflag);
  memory->destroy(cutsq);
  memory->destroy(epsilon_);
  memory->destroy(sigma_);
  memory->destroy(cut_);
}

template <class Potential> void PairSoft<Potential>::allocate()
{
  allocated = 1;
  const int n = atom->ntypes + 1;
  memory->create(setflag, n, n, "pair:setflag");
  memory->create(cutsq, n, n, "pair:cutsq");
  memory->create(epsilon_, n, n, "pair:epsilon");
  memory->create(sigma_, n, n, "pair:sigma");
  memory->create(cut_, n, n, "pair:cut");
  for (int i = 0; i < n; ++i) std::fill(setflag[i], setflag[i] + n, 0);
}

template <class Potential> void PairSoft<Potential>::settings(int narg, char **arg)
{
  const int wanted = Potential::own_cutoff ? 0 : 1;
  if (narg != wanted)
    error->all(FLERR, "pair_style {}: takes {}", Potential::name,
               wanted ? "one argument, the cutoff" : "no arguments");
  if (!wanted) return;
  cut_global_ = utils::numeric(FLERR, arg[0], false, lmp);
  if (!(cut_global_ > 0))
    error->all(FLERR, "pair_style {}: cutoff {}: must be positive", Potential::name, arg[0]);
  if (!allocated) return;
  for (int i = 1; i <= atom->ntypes; ++i)
    for (int j = i; j <= atom->ntypes; ++j)
      if (setflag[i][j]) cut_[i][j] = cut_global_;
}

template <class Potential> void PairSoft<Potential>::coeff(int narg, char **arg)
{
  const int most = Potential::own_cutoff ? 4 : 5;
  if (narg < 4 || narg > most)
    error->all(FLERR, "pair_coeff of {}: takes two types, epsilon, sigma{}", Potential::name,
               Potential::own_cutoff ? "" : " and perhaps a cutoff");
  if (!allocated) allocate();
  int ilo, ihi, jlo, jhi;
  utils::bounds(FLERR, arg[0], 1, atom->ntypes, ilo, ihi, error);
  utils::bounds(FLERR, arg[1], 1, atom->ntypes, jlo, jhi, error);
  const double epsilon = utils::numeric(FLERR, arg[2], false, lmp);
  const double sigma = utils::numeric(FLERR, arg[3], false, lmp);
  double cutoff = Potential::own_cutoff ? Potential::cutoff(sigma) : cut_global_;
  if (narg == 5) cutoff = utils::numeric(FLERR, arg[4], false, lmp);
  if (!(epsilon >= 0))
    error->all(FLERR, "pair_coeff of {}: epsilon {}: must not be negative", Potential::name, arg[2]);
  if (!(sigma > 0))
    error->all(FLERR, "pair_coeff of {}: sigma {}: must be positive", Potential::name, arg[3]);
  if (!(cutoff > 0))
    error->all(FLERR, "pair_coeff of {}: cutoff {}: must be positive", Potential::name, arg[4]);
  int count = 0;
  for (int i = ilo; i <= ihi; ++i)
    for (int j = std::max(jlo, i); j <= jhi; ++j, ++count) {
      epsilon_[i][j] = epsilon;
      sigma_[i][j] = sigma;
      cut_[i][j] = cutoff;
      setflag[i][j] = 1;
    }
  if (count == 0)
    error->all(FLERR, "pair_coeff of {}: types {} {}: none, give them as I <= J", Potential::name,
               arg[0], arg[1]);
}

template <class Potential> void PairSoft<Potential>::init_style()
{
  if (atom->molecular != Atom::ATOMIC)
    error->all(FLERR, "pair_style {}: atom_style {}: must be atomic, without bonds",
               Potential::name, atom->atom_style);
  neighbor->add_request(this);
  fast_.assign(static_cast<std::size_t>(atom->ntypes) * atom->ntypes, Fast{});
}

template <class Potential> double PairSoft<Potential>::init_one(int i, int j)
{
  if (!setflag[i][j]) {
    epsilon_[i][j] = mix_energy(epsilon_[i][i], epsilon_[j][j], sigma_[i][i], sigma_[j][j]);
    sigma_[i][j] = mix_distance(sigma_[i][i], sigma_[j][j]);
    cut_[i][j] = Potential::own_cutoff ? Potential::cutoff(sigma_[i][j])
                                       : mix_distance(cut_[i][i], cut_[j][j]);
    did_mix = true;
  }
  epsilon_[j][i] = epsilon_[i][j];
  sigma_[j][i] = sigma_[i][j];
  cut_[j][i] = cut_[i][j];

  Fast fast;
  fast.cutsq = cut_[i][j] * cut_[i][j];
  fast.potential = Potential::make(epsilon_[i][j], sigma_[i][j]);
  if (offset_flag && !Potential::own_cutoff) fast.shift = fast.potential.series(fast.cutsq).u;
  fast_[(i - 1) * atom->ntypes + j - 1] = fast_[(j - 1) * atom->ntypes + i - 1] = fast;
  return cut_[i][j];
}

template <class Potential> void PairSoft<Potential>::compute(int eflag, int vflag)
{
  ev_init(eflag, vflag);
  auto *force = reinterpret_cast<double (*)[3]>(atom->f[0]);
  if (curvature_) curvature_->clear(atom->nlocal + atom->nghost);
  if (evflag)
    curvature_ ? pass<true, true>(force, curvature_) : pass<true, false>(force, nullptr);
  else
    curvature_ ? pass<false, true>(force, curvature_) : pass<false, false>(force, nullptr);
  if (vflag_fdotr) virial_fdotr_compute();
}

template <class Potential>
void PairSoft<Potential>::survey(double (*force)[3], Curvature &curvature)
{
  curvature.clear(atom->nlocal + atom->nghost);
  pass<false, true>(force, &curvature);
}

// One pass over the neighbour list: forces, with energy and virial, with curvature.
template <class Potential>
template <bool tally, bool curved>
void PairSoft<Potential>::pass(double (*f)[3], Curvature *curvature)
{
  const auto *x = reinterpret_cast<const double (*)[3]>(atom->x[0]);
  const int *type = atom->type;
  const int types = atom->ntypes;
  const int nlocal = atom->nlocal;
  const int newton = force->newton_pair;
  const int dimension = domain->dimension;
  double laplacian = 0;

  for (int ii = 0; ii < list->inum; ++ii) {
    const int i = list->ilist[ii];
    const int *neighbours = list->firstneigh[i];
    const int count = list->numneigh[i];
    const Fast *fast = &fast_[(type[i] - 1) * types] - 1;    // types begin with 1
    const double xi = x[i][0], yi = x[i][1], zi = x[i][2];
    double fx = 0, fy = 0, fz = 0;
    double gx = 0, gy = 0, gz = 0;
    for (int n = 0; n < count; ++n) {
      const int j = neighbours[n];    // no special bonds: init_style() saw to that
      const double dx = xi - x[j][0], dy = yi - x[j][1], dz = zi - x[j][2];
      const double w = dx * dx + dy * dy + dz * dz;
      const Fast &pair = fast[type[j]];
      if (w >= pair.cutsq) continue;

      double slope, energy = 0;
      if constexpr (tally || curved) {
        const auto s = pair.potential.series(w);
        slope = 2 * s.u1;
        energy = s.u - pair.shift;
        if constexpr (curved) {
          const double third = (8 + 4 * dimension) * s.u2 + 8 * w * s.u3;
          laplacian += 8 * w * s.u2 + 4 * dimension * s.u1;    // of both atoms
          gx += 2 * third * dx;
          gy += 2 * third * dy;
          gz += 2 * third * dz;
          auto &other = curvature->gradient[j];
          other[0] -= 2 * third * dx;
          other[1] -= 2 * third * dy;
          other[2] -= 2 * third * dz;
          curvature->contacts.push_back({i, j, {dx, dy, dz}, slope, 4 * s.u2});
        }
      } else
        slope = 2 * pair.potential.slope(w);
      const double px = slope * dx, py = slope * dy, pz = slope * dz;
      fx -= px;
      fy -= py;
      fz -= pz;
      if (newton || j < nlocal) {
        f[j][0] += px;
        f[j][1] += py;
        f[j][2] += pz;
      }
      if constexpr (tally) ev_tally(i, j, nlocal, newton, energy, 0.0, -slope, dx, dy, dz);
    }
    f[i][0] += fx;
    f[i][1] += fy;
    f[i][2] += fz;
    if constexpr (curved) {
      auto &own = curvature->gradient[i];
      own[0] += gx;
      own[1] += gy;
      own[2] += gz;
    }
  }
  if constexpr (curved) curvature->laplacian = laplacian;
}

template <class Potential>
double PairSoft<Potential>::single(int, int, int itype, int jtype, double rsq, double, double,
                                   double &fforce)
{
  const auto &pair = fast_[(itype - 1) * atom->ntypes + jtype - 1];
  const auto s = pair.potential.series(rsq);
  fforce = -2 * s.u1;
  return s.u - pair.shift;
}

template <class Potential> void PairSoft<Potential>::write_restart(FILE *fp)
{
  write_restart_settings(fp);
  for (int i = 1; i <= atom->ntypes; ++i)
    for (int j = i; j <= atom->ntypes; ++j) {
      fwrite(&setflag[i][j], sizeof(int), 1, fp);
      if (!setflag[i][j]) continue;
      const Coefficients c{epsilon_[i][j], sigma_[i][j], cut_[i][j]};
      fwrite(&c, sizeof c, 1, fp);
    }
}

template <class Potential> void PairSoft<Potential>::read_restart(FILE *fp)
{
  read_restart_settings(fp);
  allocate();
  for (int i = 1; i <= atom->ntypes; ++i)
    for (int j = i; j <= atom->ntypes; ++j) {
      if (comm->me == 0)
        utils::sfread(FLERR, &setflag[i][j], sizeof(int), 1, fp, nullptr, error);
      MPI_Bcast(&setflag[i][j], 1, MPI_INT, 0, world);
      if (!setflag[i][j]) continue;
      Coefficients c;
      if (comm->me == 0) utils::sfread(FLERR, &c, sizeof c, 1, fp, nullptr, error);
      MPI_Bcast(&c, sizeof c, MPI_BYTE, 0, world);
      epsilon_[i][j] = c.epsilon;
      sigma_[i][j] = c.sigma;
      cut_[i][j] = c.cutoff;
    }
}

template <class Potential> void PairSoft<Potential>::write_restart_settings(FILE *fp)
{
  fwrite(&cut_global_, sizeof cut_global_, 1, fp);
  fwrite(&offset_flag, sizeof offset_flag, 1, fp);
  fwrite(&mix_flag, sizeof mix_flag, 1, fp);
}

template <class Potential> void PairSoft<Potential>::read_restart_settings(FILE *fp)
{
  if (comm->me == 0) {
    utils::sfread(FLERR, &cut_global_, sizeof cut_global_, 1, fp, nullptr, error);
    utils::sfread(FLERR, &offset_flag, sizeof offset_flag, 1, fp, nullptr, error);
    utils::sfread(FLERR, &mix_flag, sizeof mix_flag, 1, fp, nullptr, error);
  }
  MPI_Bcast(&cut_global_, 1, MPI_DOUBLE, 0, world);
  MPI_Bcast(&offset_flag, 1, MPI_INT, 0, world);
  MPI_Bcast(&mix_flag, 1, MPI_INT, 0, world);
}

template <class Potential> void *PairSoft<Potential>::extract(const char *name, int &dimension)
{
  dimension = 2;
  if (!std::strcmp(name, "epsilon")) return epsilon_;
  if (!std::strcmp(name, "sigma")) return sigma_;
  return nullptr;
}

template class LAMMPS_NS::PairSoft<soft::InverseTwelve>;
template class LAMMPS_NS::PairSoft<soft::WeeksChandlerAndersen>;

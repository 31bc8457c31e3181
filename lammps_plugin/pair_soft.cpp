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

#include <algorithm>
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
  if (!force->newton_pair)
    error->all(FLERR, "pair_style {}: newton: must be on, pairs are computed once", Potential::name);
  neighbor->add_request(this);
  alike_ = true;
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
  alike_ = alike_ && epsilon_[i][j] == epsilon_[1][1] && sigma_[i][j] == sigma_[1][1] &&
      cut_[i][j] == cut_[1][1];
  return cut_[i][j];
}

template <class Potential> void PairSoft<Potential>::compute(int eflag, int vflag)
{
  ev_init(eflag, vflag);
  auto *force = reinterpret_cast<double (*)[3]>(atom->f[0]);
  if (neighbor->ago == 0) flatten();
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

template <class Potential>
template <bool tally, bool curved>
void PairSoft<Potential>::pass(double (*force)[3], Curvature *curvature)
{
  if (domain->dimension == 2)
    alike_ ? pass<2, true, tally, curved>(force, curvature)
           : pass<2, false, tally, curved>(force, curvature);
  else
    alike_ ? pass<3, true, tally, curved>(force, curvature)
           : pass<3, false, tally, curved>(force, curvature);
}

// The neighbour list as pairs. Those of one atom do not follow each other, so that sums of forces on
// it do not wait for each other.
template <class Potential> void PairSoft<Potential>::flatten()
{
  constexpr int together = 8;
  pairs_.clear();
  for (int first = 0; first < list->inum; first += together) {
    const int last = std::min(first + together, list->inum);
    bool more = true;
    for (int n = 0; more; ++n) {
      more = false;
      for (int ii = first; ii < last; ++ii) {
        const int i = list->ilist[ii];
        if (n >= list->numneigh[i]) continue;
        pairs_.push_back({i, list->firstneigh[i][n]});    // no special bonds: see init_style()
        more = true;
      }
    }
  }
}

// One pass over the pairs: forces, with energy and virial, with curvature. Of a few hundred pairs
// those within the cutoff are gathered first, without a branch to mispredict; then their
// derivatives are computed, in vectors; then these are added up.
template <class Potential>
template <int D, bool alike, bool tally, bool curved>
void PairSoft<Potential>::pass(double (*__restrict f)[3], Curvature *curvature)
{
  constexpr int chunk = 256;
  struct {
    alignas(64) double r[chunk + 1][D], w[chunk + 1], slope[chunk], bend[chunk], third[chunk],
        laplacian[chunk], energy[chunk];
    Couple couple[chunk + 1];
  } near;

  const auto *__restrict x = reinterpret_cast<const double (*)[3]>(atom->x[0]);
  const int *__restrict type = atom->type;
  const int types = atom->ntypes, nlocal = atom->nlocal;
  const Fast common = fast_[0];
  const Fast *__restrict by_types = fast_.data();
  const auto of = [=](const Couple &c) {
    return alike ? common : by_types[(type[c.i] - 1) * types + type[c.j] - 1];
  };
  const auto add = [](double *on_i, double *on_j, double factor, const double *r) {
    double a[D], b[D];    // loaded before anything is stored: i and j differ
    for (int k = 0; k < D; ++k) {
      a[k] = on_i[k] + factor * r[k];
      b[k] = on_j[k] - factor * r[k];
    }
    for (int k = 0; k < D; ++k) on_i[k] = a[k];
    for (int k = 0; k < D; ++k) on_j[k] = b[k];
  };

  const int all = static_cast<int>(pairs_.size());
  for (int start = 0; start < all; start += chunk) {
    const int end = std::min(start + chunk, all);
    int hits = 0;
    for (int p = start; p < end; ++p) {
      const Couple c = pairs_[p];
      double w = 0;
      for (int a = 0; a < D; ++a) {
        near.r[hits][a] = x[c.i][a] - x[c.j][a];
        w += near.r[hits][a] * near.r[hits][a];
      }
      near.couple[hits] = c;
      near.w[hits] = w;
      hits += w < of(c).cutsq;
    }

    for (int n = 0; n < hits; ++n) {
      const Fast pair = of(near.couple[n]);
      const double w = near.w[n];
      if constexpr (tally || curved) {
        const auto s = pair.potential.series(w);
        near.slope[n] = 2 * s.u1;
        near.energy[n] = s.u - pair.shift;
        near.bend[n] = 4 * s.u2;
        near.third[n] = (16 + 8 * D) * s.u2 + 16 * w * s.u3;    // of both atoms, as the next
        near.laplacian[n] = 8 * w * s.u2 + 4 * D * s.u1;
      } else
        near.slope[n] = 2 * pair.potential.slope(w);
    }

    for (int n = 0; n < hits; ++n) {
      const auto [i, j] = near.couple[n];
      add(f[i], f[j], -near.slope[n], near.r[n]);
      if constexpr (tally)
        ev_tally(i, j, nlocal, 1, near.energy[n], 0.0, -near.slope[n], near.r[n][0], near.r[n][1],
                 D == 3 ? near.r[n][2] : 0.0);
    }

    if constexpr (curved) {
      Triple *__restrict gradient = curvature->gradient.data();
      const std::size_t before = curvature->contacts.size();
      curvature->contacts.resize(before + hits);
      Contact *__restrict contact = curvature->contacts.data() + before;
      for (int n = 0; n < hits; ++n) {
        const auto [i, j] = near.couple[n];
        add(gradient[i].data(), gradient[j].data(), near.third[n], near.r[n]);
        curvature->laplacian += near.laplacian[n];
        contact[n] = {i, j, near.slope[n], near.bend[n]};
      }
    }
  }
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

// T_conf = sum F_i^2 / sum Laplacian_i of the potential energy, and its gradient by the positions
// (delhommelle-2005, 4). For a fix or a compute that passes values of atoms and ghosts on.

#pragma once

#include "curvature.h"
#include "pair_soft.h"

#include "atom.h"
#include "comm.h"
#include "error.h"
#include "force.h"

#include <mpi.h>
#include <vector>

namespace LAMMPS_NS {

class ConfigurationalTemperature {
 public:
  Curvature curvature;
  std::vector<Triple> force;       // of the potential energy alone; atoms, then ghosts
  std::vector<Triple> gradient;    // of the temperature
  double force_squares = 0, laplacian = 0;

  // With `within`, also a pair style that pair_style hybrid/overlay has once.
  static PairSmooth &pair_of(Force &force, Error &error, const char *user, bool within = false)
  {
    auto *pair = dynamic_cast<PairSmooth *>(force.pair);
    for (const char *name : {"soft/disk", "wca"})
      if (!pair && within) pair = dynamic_cast<PairSmooth *>(force.pair_match(name, 1));
    if (!pair)
      error.all(FLERR, "{}: pair_style {}: must be soft/disk or wca, which give their derivatives",
                user, force.pair_style ? force.pair_style : "none");
    return *pair;
  }

  double temperature() const { return force_squares / laplacian; }

  // Forces and curvature, as the pair left them with shares on ghosts, summed on their atoms.
  template <class Owner> void sum(Comm &comm, MPI_Comm world, Owner *owner, int atoms)
  {
    stage_ = Stage::sums;
    comm.reverse_comm(owner, 6);
    double mine[2] = {0, curvature.laplacian}, all[2];
    for (int i = 0; i < atoms; ++i)
      mine[0] += force[i][0] * force[i][0] + force[i][1] * force[i][1] + force[i][2] * force[i][2];
    MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_SUM, world);
    force_squares = all[0];
    laplacian = all[1];
  }

  // dT/dr_k = (dG/dr_k - T dL/dr_k) / L, G the sum of F^2, L of the Laplacians, after sum().
  // dG/dr_k = -2 sum_i H_ki F_i, H the Hessian: of each contact, -2 h (F_i - F_j) on i, + on j. Positions x as at sum().
  template <class Owner>
  void differentiate(Comm &comm, Owner *owner, int atoms, int ghosts, int dimension,
                     const double (*x)[3])
  {
    stage_ = Stage::forces;
    comm.forward_comm(owner, 3);
    gradient.assign(atoms + ghosts, Triple{});
    dimension == 2 ? multiply<2>(x) : multiply<3>(x);
    stage_ = Stage::gradients;
    comm.reverse_comm(owner, 3);
    const double t = temperature();
    for (int i = 0; i < atoms; ++i)
      for (int a = 0; a < 3; ++a)
        gradient[i][a] = (gradient[i][a] - t * curvature.gradient[i][a]) / laplacian;
  }

  int pack_forward(int n, const int *list, double *buffer) const
  {
    for (int k = 0; k < n; ++k)
      for (int a = 0; a < 3; ++a) *buffer++ = force[list[k]][a];
    return 3 * n;
  }
  void unpack_forward(int n, int first, const double *buffer)
  {
    for (int k = first; k < first + n; ++k)
      for (int a = 0; a < 3; ++a) force[k][a] = *buffer++;
  }
  int pack_reverse(int n, int first, double *buffer) const
  {
    const double *start = buffer;
    for (int k = first; k < first + n; ++k) {
      const auto &sent = stage_ == Stage::sums ? force[k] : gradient[k];
      for (int a = 0; a < 3; ++a) *buffer++ = sent[a];
      if (stage_ == Stage::sums)
        for (int a = 0; a < 3; ++a) *buffer++ = curvature.gradient[k][a];
    }
    return static_cast<int>(buffer - start);
  }
  void unpack_reverse(int n, const int *list, const double *buffer)
  {
    for (int k = 0; k < n; ++k) {
      auto &sum = stage_ == Stage::sums ? force[list[k]] : gradient[list[k]];
      for (int a = 0; a < 3; ++a) sum[a] += *buffer++;
      if (stage_ == Stage::sums)
        for (int a = 0; a < 3; ++a) curvature.gradient[list[k]][a] += *buffer++;
    }
  }

 private:
  enum class Stage { sums, forces, gradients } stage_ = Stage::sums;

  template <int D> void multiply(const double (*__restrict x)[3])
  {
    const Triple *__restrict f = force.data();
    Triple *__restrict g = gradient.data();
    for (const auto &[i, j, slope, bend] : curvature.contacts) {
      double r[D], d[D], along = 0;
      for (int a = 0; a < D; ++a) {
        r[a] = x[i][a] - x[j][a];
        d[a] = f[i][a] - f[j][a];
        along += r[a] * d[a];
      }
      double on_i[D], on_j[D];    // loaded before anything is stored: i and j differ
      for (int a = 0; a < D; ++a) {
        const double share = 2 * (slope * d[a] + bend * along * r[a]);
        on_i[a] = g[i][a] - share;
        on_j[a] = g[j][a] + share;
      }
      for (int a = 0; a < D; ++a) g[i][a] = on_i[a];
      for (int a = 0; a < D; ++a) g[j][a] = on_j[a];
    }
  }
};

}    // namespace LAMMPS_NS

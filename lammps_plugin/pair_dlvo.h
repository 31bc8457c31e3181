// pair_style dlvo: charged spheres with van der Waals attraction, contact and lubrication, in one
// pass over the neighbours (docs/pair_dlvo.md; hecht-2005, section II).

#pragma once

#include "pair.h"

#include <array>
#include <cstdint>
#include <vector>

namespace LAMMPS_NS {

class PairDLVO : public Pair {
 public:
  explicit PairDLVO(LAMMPS *);
  ~PairDLVO() override;
  void compute(int, int) override;
  void settings(int, char **) override;
  void coeff(int, char **) override;
  void init_style() override;
  double init_one(int, int) override;
  double single(int, int, int, int, double, double, double, double &) override;

 private:
  using Normals = std::array<double, 4>;

  struct Spheres {
    double diameter = 0;
    double charge = 0, kappa = 0;     // of (1): V = charge d^2 / r exp(-kappa (r - d))
    double hamaker = 0;               // A_H of (2)
    double hertz = 0;                 // K of (3)
    double depth = 0;                 // of the parabola in place of the primary minimum
    double damping = 0;               // beta of (6)
    double friction = 0;              // of the surfaces, transverse
    double viscosity = 0, closest = 0, farthest = 0;    // of (4): eta, and gaps
    double cutoff = 0;

    double joint = 0, stiffness = 0;    // where the parabola ends, derived
    double shift = 0;                   // energy at the cutoff, with pair_modify shift yes

    double energy(double r) const;
    double force(double r, double inverse) const;
    double coulomb(double r, double inverse) const;
    double dlvo_energy(double r) const;
    double dlvo_force(double r, double inverse) const;
    void join();
    double normal_friction(double r) const;
  };

  // Pairs of two types, component by component: loops over them are vectorised.
  struct Pairs {
    static constexpr int MOST = 512;    // their state stays in the caches
    template <class Value> using Each = std::array<Value, MOST>;

    int count = 0;
    Each<int> i, j;
    Each<double> x, y, z, r;    // from j to i: the way, then its direction and length
    Each<double> along;         // force on i in that direction
    Each<double> friction;      // of the relative velocity along it
  };

  void allocate();
  void gather(std::size_t types, int i, const int *neighbors, int count, int eflag);
  void act(const Spheres &, Pairs &, int eflag);
  void repel(const Spheres &, Pairs &);
  void dissipate(const Spheres &, Pairs &);
  void rub(const Spheres &, const Pairs &, int k, const Normals &z);
  void push(const Pairs &);
  void tally(const Spheres &, const Pairs &, int eflag);
  void push(int i, int j, const std::array<double, 3> &pull, const double *e, double r,
            double energy);
  Spheres &of(int itype, int jtype) { return spheres_[itype * (types_ + 1) + jtype]; }

  int types_ = 0;
  std::vector<Spheres> spheres_;
  std::vector<Pairs> near_;    // of each two types
  double cutoff_ = 0, temperature_ = 0;
  std::uint64_t seed_ = 0;
  bool dissipates_ = false, rubs_ = false;
};

}    // namespace LAMMPS_NS

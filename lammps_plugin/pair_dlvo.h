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
  using Vector = std::array<double, 3>;

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
    double least = 0;                   // r^2 - d^2 there
    double shift = 0;                   // energy at the cutoff, with pair_modify shift yes
    double near = 0, far = 0;    // up to where there is more than attraction, and up to where that

    double energy(double r) const;
    double pull(double square) const;
    double attraction(double square) const;
    double coulomb(double r, double inverse) const;
    double dlvo_energy(double r) const;
    double dlvo_force(double r) const;
    void join();
    double normal_friction(double r) const;
  };

  // Pairs of two types; those of an atom follow each other.
  struct Listed {
    std::vector<int> i, j;
  };

  // Some of them, component by component: loops over them are vectorised.
  struct Pairs {
    static constexpr int MOST = 512;    // their state stays in the caches
    template <class Value> using Each = std::array<Value, MOST>;

    int count;
    const int *i, *j;
    Each<double> x, y, z;     // from j to i
    Each<double> pull;        // force on i over the distance
    Each<double> friction;    // of the relative velocity along the line of centres
    Each<double> r;

    double square(int k) const { return x[k] * x[k] + y[k] * y[k] + z[k] * z[k]; }
  };

  void allocate();
  bool moved() const;
  void sort();
  void act(const Spheres &, const Listed &, bool near, int eflag);
  void gather(const Listed &, int first, int count);
  void repel(const Spheres &);
  void attract(const Spheres &);
  void dissipate(const Spheres &);
  void normal_friction(const Spheres &);
  void rub(const Spheres &, int k, const Vector &e, const Normals &z);
  void push();
  void tally(const Spheres &, int eflag);
  void push(int i, int j, const Vector &pull, const Vector &from, double energy);
  Spheres &of(int itype, int jtype) { return spheres_[itype * (types_ + 1) + jtype]; }

  int types_ = 0;
  std::vector<Spheres> spheres_;
  std::vector<Listed> near_, far_;    // of each two types, sorted out of the neighbour list
  std::vector<double> places_;        // of all atoms then
  double margin_ = 0;                 // distance that pairs in reach were then allowed beyond it
  Pairs pairs_;
  double cutoff_ = 0, temperature_ = 0;
  std::uint64_t seed_ = 0;
  bool dissipates_ = false, rubs_ = false;
};

}    // namespace LAMMPS_NS

// pair soft/disk and wca: short repulsions that know their first three derivatives
// (docs/pair_soft_disk.md, docs/pair_wca.md).

#pragma once

#include "pair.h"

#include "curvature.h"
#include "soft_potentials.h"

#include <vector>

namespace LAMMPS_NS {

// A pair style from which temperatures of configurations can be computed.
class PairSmooth : public Pair {
 public:
  using Pair::Pair;
  // Collected by every compute() from now on; nullptr: no longer.
  void collect(Curvature *curvature) { curvature_ = curvature; }
  // Forces (with ghosts, added) and curvature at the positions of the moment.
  virtual void survey(double (*force)[3], Curvature &) = 0;

 protected:
  Curvature *curvature_ = nullptr;
};

template <class Potential> class PairSoft : public PairSmooth {
 public:
  PairSoft(LAMMPS *);
  ~PairSoft() override;
  void compute(int, int) override;
  void survey(double (*)[3], Curvature &) override;
  void settings(int, char **) override;
  void coeff(int, char **) override;
  void init_style() override;
  double init_one(int, int) override;
  double single(int, int, int, int, double, double, double, double &) override;
  void write_restart(FILE *) override;
  void read_restart(FILE *) override;
  void write_restart_settings(FILE *) override;
  void read_restart_settings(FILE *) override;
  void *extract(const char *, int &) override;

 private:
  struct Coefficients {
    double epsilon = 0, sigma = 0, cutoff = 0;
  };
  struct Fast {
    double cutsq = 0, shift = 0;
    Potential potential;
  };

  double cut_global_ = 0;
  double **epsilon_ = nullptr, **sigma_ = nullptr, **cut_ = nullptr;
  std::vector<Fast> fast_;    // by pair of types from 0
  bool alike_ = true;         // all types interact alike, as colours do

  struct Couple {
    int i, j;
  };
  std::vector<Couple> pairs_;    // of the neighbour list

  void allocate();
  void flatten();
  template <bool tally, bool curved> void pass(double (*)[3], Curvature *);
  template <int D, bool alike, bool tally, bool curved> void pass(double (*)[3], Curvature *);
};

}    // namespace LAMMPS_NS

// fix isokinetic and isokinetic/sllod: Gaussian thermostats (docs/fix_isokinetic.md).

#pragma once

#include "fix.h"

#include "shear_flow.h"

#include <vector>

namespace LAMMPS_NS {

class FixIsokinetic : public Fix {
 public:
  FixIsokinetic(LAMMPS *, int, char **);
  int setmask() override;
  void init() override;
  void setup(int) override;
  void initial_integrate(int) override;
  void final_integrate() override;
  void reset_dt() override;
  double compute_scalar() override;

 private:
  const bool sllod_;
  double temperature_;
  bool held_[3];           // directions of which the kinetic energy is fixed
  double squares_ = 0;     // the fixed sum of m c^2, c the velocity relative to the flow
  double friction_ = 0;    // the multiplier of (3)
  double step_ = 0;
  ShearFlow flow_;

  std::vector<double> inverse_;    // masses of the types

  struct Kick {
    double velocity[3], force[3];    // c' = velocity c + force F / m, c relative to the flow
  };
  double mass(int i) const;
  double inverse_mass(int i) const;
  Kick kick();
  template <bool flies> double apply(const Kick &);
  double drift_with_flow();
  void stop(double);
};

}    // namespace LAMMPS_NS

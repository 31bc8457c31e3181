// fix configurational and configurational/sllod: a thermostat that fixes the temperature of the
// configurations and leaves the velocities alone (docs/fix_configurational.md).

#pragma once

#include "fix.h"

#include "configurational_temperature.h"
#include "shear_flow.h"

namespace LAMMPS_NS {

class FixConfigurational : public Fix {
 public:
  FixConfigurational(LAMMPS *, int, char **);
  ~FixConfigurational() override;
  int setmask() override;
  void init() override;
  void setup(int) override;
  void setup_pre_reverse(int, int) override;
  void initial_integrate(int) override;
  void pre_reverse(int, int) override;
  void final_integrate() override;
  void reset_dt() override;

  double compute_scalar() override;
  double compute_vector(int) override;
  double memory_usage() override;
  void write_restart(FILE *) override;
  void restart(char *) override;

  void grow_arrays(int) override;
  void copy_arrays(int, int, int) override;
  void set_arrays(int) override;
  int pack_exchange(int, double *) override;
  int unpack_exchange(int, double *) override;
  int pack_restart(int, double *) override;
  void unpack_restart(int, int) override;
  int size_restart(int) override;
  int maxsize_restart() override;

  int pack_forward_comm(int, int *, double *, int, int *) override;
  void unpack_forward_comm(int, int, double *) override;
  int pack_reverse_comm(int, int, double *) override;
  void unpack_reverse_comm(int, int *, double *) override;

 private:
  const bool sllod_;
  double temperature_, damping_;
  double multiplier_ = 0;    // s of (5)
  bool begun_ = false;       // there is a gradient of the step before
  double step_ = 0;
  ShearFlow flow_;
  PairSmooth *pair_ = nullptr;
  ConfigurationalTemperature now_;
  double **before_ = nullptr;    // the gradient one step ago

  double mass(int i) const;
  void kick();
  void turn_multiplier();
};

}    // namespace LAMMPS_NS

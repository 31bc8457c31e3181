// compute temp/configurational (docs/compute_temp_configurational.md).

#pragma once

#include "compute.h"

#include "configurational_temperature.h"

namespace LAMMPS_NS {

class ComputeTempConfigurational : public Compute {
 public:
  ComputeTempConfigurational(LAMMPS *, int, char **);
  ~ComputeTempConfigurational() override;
  void init() override;
  double compute_scalar() override;
  void compute_vector() override;
  int pack_reverse_comm(int, int, double *) override;
  void unpack_reverse_comm(int, int *, double *) override;

 private:
  PairSmooth *pair_ = nullptr;
  ConfigurationalTemperature now_;
};

}    // namespace LAMMPS_NS

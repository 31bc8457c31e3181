// fix wall/lj115: the repulsion of a wall made of lines of 12-6 particles (docs/fix_wall_lj115.md).

#pragma once

#include "fix.h"

#include <vector>

namespace LAMMPS_NS {

class FixWallLJ115 : public Fix {
 public:
  FixWallLJ115(LAMMPS *, int, char **);
  int setmask() override;
  void setup(int) override;
  void post_force(int) override;
  double compute_scalar() override;
  double compute_vector(int) override;

 private:
  struct Wall {
    int axis;
    bool upper;
    double epsilon, sigma;
  };
  std::vector<Wall> walls_;
  std::vector<double> sums_;    // energy, then the force on each wall; of this process
  double sum(int index);
};

}    // namespace LAMMPS_NS

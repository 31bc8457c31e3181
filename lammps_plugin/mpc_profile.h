// The profile of the fluid as a file of fix ave/chunk with chunks of bin/1d y.

#pragma once

#include "core/profile.h"

#include "pointers.h"

#include <cstdio>
#include <string>
#include <vector>

namespace LAMMPS_NS {

class MpcProfile : protected Pointers {
 public:
  // Opens the file on the first process.
  MpcProfile(LAMMPS *, const std::string &file, bool append, const char *fix);
  ~MpcProfile() override;

  // Add the layers as they are now.
  void look(const std::vector<mpc::Layer> &);

  // The mean of the looks since the last time, all particles counted.
  void write(double particles);

 private:
  FILE *file_ = nullptr;
  std::vector<mpc::Layer> sums_;
  int looks_ = 0;
};

}    // namespace LAMMPS_NS

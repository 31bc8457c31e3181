// The fluid in files of its own, of which each process reads and writes its part: those that are saved
// and loaded, and those beside restart files (docs/fix_mpc.md).

#pragma once

#include "core/fluid_file.h"
#include "core/solver.h"
#include "mpc_state.h"
#include "mpi_processes.h"

#include "pointers.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

template <int D> class MpcFluidFile : protected Pointers {
 public:
  MpcFluidFile(LAMMPS *, mpc::AnySolver<D> &, MpcState<D> &, MpiProcesses &);

  // How many particles a file has that is to be loaded.
  static double particles_in(LAMMPS *, const std::string &file);

  void load(const std::string &file);
  void save(const std::string &file);

  // The header of a file, which the first process looks at; `why` it is read.
  static mpc::FluidHeader read_header(LAMMPS *, const std::string &file, const char *why,
                                      const char (&magic)[8]);

  // Bring the particles of a file to the processes that have their cells; visit this one's share.
  void read(const std::string &file, const char *why, std::int64_t particles,
            const typename MpcState<D>::Fill &visit);

  // The particles of each process after those of the one before, seen from an origin; `why` they are
  // written. The checksum of all.
  std::uint64_t write(const std::string &file, const char *why, const char (&magic)[8],
                      const double *origin);

 private:
  mpc::FluidHeader fluid_header(const char (&magic)[8]) const;
  void check(const mpc::Particle<D> &, std::int64_t particles, const std::string &file) const;
  void check_each_once(std::vector<double> numbers, std::int64_t particles,
                       const std::string &file);

  mpc::AnySolver<D> &solver_;
  MpcState<D> &state_;
  MpiProcesses &processes_;
};

}    // namespace LAMMPS_NS

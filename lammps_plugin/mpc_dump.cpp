#include "mpc_dump.h"

#include "comm.h"
#include "domain.h"
#include "error.h"
#include "update.h"

#include <mpi.h>

#include <algorithm>
#include <vector>

using namespace LAMMPS_NS;
using mpc::Particle;

template <int D>
MpcDump<D>::MpcDump(LAMMPS *lmp, const DumpArguments &given) : Pointers(lmp), given_(given)
{
  if (comm->me != 0) return;
  file_ = std::fopen(given.file.c_str(), given.append ? "a" : "w");
  if (!file_) error->one(FLERR, "fix mpc: dump: cannot write {}", given.file);
}

template <int D> MpcDump<D>::~MpcDump()
{
  if (file_) std::fclose(file_);
}

// The particles to write, of all processes, on the first.
template <int D>
std::vector<Particle<D>> MpcDump<D>::chosen(const mpc::AnySolver<D> &solver) const
{
  std::vector<Particle<D>> mine;
  for (int i = 0; i < solver.size(); ++i)
    if (solver.number(i) % given_.one_in == 0) mine.push_back(solver.particle(i));
  if (comm->nprocs == 1) return mine;
  constexpr int record = sizeof(Particle<D>) / sizeof(double);
  bigint values = static_cast<bigint>(mine.size()) * record, all_values = 0;
  MPI_Allreduce(&values, &all_values, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  if (all_values > MAXSMALLINT)
    error->all(FLERR, "fix mpc: dump M {}: {} particles are too many for one process to write",
               given_.one_in, all_values / record);
  const int size = static_cast<int>(values);
  std::vector<int> sizes(comm->nprocs), starts(comm->nprocs);
  MPI_Gather(&size, 1, MPI_INT, sizes.data(), 1, MPI_INT, 0, world);
  for (int p = 1; p < comm->nprocs; ++p) starts[p] = starts[p - 1] + sizes[p - 1];
  std::vector<Particle<D>> all((starts.back() + sizes.back()) / record);
  MPI_Gatherv(mine.data(), size, MPI_DOUBLE, all.data(), sizes.data(), starts.data(), MPI_DOUBLE,
              0, world);
  return all;
}

template <int D> void MpcDump<D>::write(const mpc::AnySolver<D> &solver)
{
  auto particles = chosen(solver);
  if (comm->me != 0) return;
  std::sort(particles.begin(), particles.end(),
            [](const auto &a, const auto &b) { return a.id < b.id; });
  std::fprintf(file_, "ITEM: TIMESTEP\n" BIGINT_FORMAT "\nITEM: NUMBER OF ATOMS\n%zu\n",
               update->ntimestep, particles.size());
  char boundary[9];    // as "pp ff pp"
  domain->boundary_string(boundary);
  std::fprintf(file_, "ITEM: BOX BOUNDS %s\n", boundary);
  for (int a = 0; a < 3; ++a)
    std::fprintf(file_, "%-1.16e %-1.16e\n", domain->boxlo[a], domain->boxhi[a]);
  std::fprintf(file_, "ITEM: ATOMS id type x y z vx vy vz\n");
  for (const auto &particle : particles) {
    std::fprintf(file_, "%.0f 1", particle.id + 1);
    for (int a = 0; a < 3; ++a)
      std::fprintf(file_, " %g", a < D ? particle.x[a] + domain->boxlo[a] : 0.0);
    for (int a = 0; a < 3; ++a) std::fprintf(file_, " %g", a < D ? particle.v[a] : 0.0);
    std::fputc('\n', file_);
  }
  if (std::fflush(file_) || std::ferror(file_))
    error->one(FLERR, "fix mpc: dump: cannot write {}", given_.file);
}

template class LAMMPS_NS::MpcDump<2>;
template class LAMMPS_NS::MpcDump<3>;

// The processes of LAMMPS, and their neighbours in its grid of sub-domains.

#pragma once

#include "core/processes.h"

#include "comm.h"

#include <mpi.h>

#include <functional>
#include <vector>

namespace LAMMPS_NS {

class MpiProcesses : public mpc::Processes {
 public:
  MpiProcesses(const Comm &comm, MPI_Comm world) : comm_(comm), world_(world) {}

  int along(int axis) const override { return comm_.procgrid[axis]; }

  void sum(double *values, int count) override
  {
    if (comm_.nprocs > 1) MPI_Allreduce(MPI_IN_PLACE, values, count, MPI_DOUBLE, MPI_SUM, world_);
  }

  bool any(bool mine) override
  {
    int answer = mine;
    if (comm_.nprocs > 1) MPI_Allreduce(MPI_IN_PLACE, &answer, 1, MPI_INT, MPI_MAX, world_);
    return answer;
  }

  std::vector<double> trade(int axis, const std::vector<double> &to_lower,
                            const std::vector<double> &to_upper) override
  {
    std::vector<double> received;
    const int *neighbours = comm_.procneigh[axis];
    pass(to_lower, neighbours[0], neighbours[1], received);
    pass(to_upper, neighbours[1], neighbours[0], received);
    return received;
  }

  void sum_images(std::vector<double> &values, int width) override { images(values, width); }

  // How the host sums over images.
  std::function<void(std::vector<double> &, int)> images;

 protected:
  std::vector<char> gather(const std::vector<char> &mine) override
  {
    const int size = static_cast<int>(mine.size());
    std::vector<int> sizes(comm_.nprocs), starts(comm_.nprocs);
    MPI_Allgather(&size, 1, MPI_INT, sizes.data(), 1, MPI_INT, world_);
    for (int p = 1; p < comm_.nprocs; ++p) starts[p] = starts[p - 1] + sizes[p - 1];
    std::vector<char> all(starts.back() + sizes.back());
    MPI_Allgatherv(mine.data(), size, MPI_BYTE, all.data(), sizes.data(), starts.data(), MPI_BYTE,
                   world_);
    return all;
  }

 private:
  void pass(const std::vector<double> &values, int to, int from, std::vector<double> &received)
  {
    const int size = static_cast<int>(values.size());
    const auto before = received.size();
    int arriving = 0;
    MPI_Sendrecv(&size, 1, MPI_INT, to, 0, &arriving, 1, MPI_INT, from, 0, world_,
                 MPI_STATUS_IGNORE);
    received.resize(before + arriving);
    MPI_Sendrecv(values.data(), size, MPI_DOUBLE, to, 0, received.data() + before, arriving,
                 MPI_DOUBLE, from, 0, world_, MPI_STATUS_IGNORE);
  }

  const Comm &comm_;
  MPI_Comm world_;
};

}    // namespace LAMMPS_NS

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

  // Hand each record to the process that is its home; those of this process, in the order of the
  // processes that had them.
  template <class Record, class Home>
  std::vector<Record> deliver(std::vector<Record> records, const Home &home)
  {
    if (comm_.nprocs == 1) return records;
    std::vector<int> leaving(comm_.nprocs), arriving(comm_.nprocs);
    for (const auto &record : records) ++leaving[home(record)];
    MPI_Alltoall(leaving.data(), 1, MPI_INT, arriving.data(), 1, MPI_INT, world_);
    const auto to = starts(leaving), from = starts(arriving);
    auto next = to;
    std::vector<Record> sorted(records.size());
    for (const auto &record : records) sorted[next[home(record)]++] = record;
    std::vector<Record>().swap(records);
    std::vector<Record> arrived(from.back());
    MPI_Datatype type;    // counts of bytes would not fit an int
    MPI_Type_contiguous(sizeof(Record), MPI_BYTE, &type);
    MPI_Type_commit(&type);
    MPI_Alltoallv(sorted.data(), leaving.data(), to.data(), type, arrived.data(), arriving.data(),
                  from.data(), type, world_);
    MPI_Type_free(&type);
    return arrived;
  }

  void sum_images(std::vector<double> &values, int width) override { images(values, width); }

  // How the host sums over images.
  std::function<void(std::vector<double> &, int)> images;

 protected:
  std::vector<char> gather(const std::vector<char> &mine) override
  {
    const int size = static_cast<int>(mine.size());
    std::vector<int> sizes(comm_.nprocs);
    MPI_Allgather(&size, 1, MPI_INT, sizes.data(), 1, MPI_INT, world_);
    const auto from = starts(sizes);
    std::vector<char> all(from.back());
    MPI_Allgatherv(mine.data(), size, MPI_BYTE, all.data(), sizes.data(), from.data(), MPI_BYTE,
                   world_);
    return all;
  }

 private:
  // Where parts of these sizes begin, one after the other, and where the last ends.
  static std::vector<int> starts(const std::vector<int> &sizes)
  {
    std::vector<int> starts(sizes.size() + 1);
    for (std::size_t p = 0; p < sizes.size(); ++p) starts[p + 1] = starts[p] + sizes[p];
    return starts;
  }

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

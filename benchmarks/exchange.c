/* Counts what each process sends through MPI, for benchmarks/exchange.py: loaded before MPI, it passes
 * every call on. At the end process 0 prints a line for each function and whether LAMMPS or the
 * plugin called it: calls and bytes of the process that sent most. */

#define _GNU_SOURCE
#include <dlfcn.h>
#include <mpi.h>
#include <stdio.h>
#include <string.h>

enum { SENDRECV, SEND, ALLREDUCE, BCAST, ALLGATHER, ALLTOALL, REDUCE, BARRIER, FUNCTIONS };
static const char *const names[FUNCTIONS] = {"sendrecv",  "send",     "allreduce", "bcast",
                                             "allgather", "alltoall", "reduce",    "barrier"};
static double counts[FUNCTIONS][2][2]; /* by the plugin or not; calls, bytes */

static void count(int function, const void *caller, long values, MPI_Datatype type)
{
  Dl_info info;
  int bytes = 0;
  if (type != MPI_DATATYPE_NULL) PMPI_Type_size(type, &bytes);
  const int plugin = dladdr(caller, &info) && strstr(info.dli_fname, "narrowsplugin") != NULL;
  counts[function][plugin][0] += 1;
  counts[function][plugin][1] += (double) values * bytes;
}
#define COUNT(function, values, type) count(function, __builtin_return_address(0), values, type)

int MPI_Sendrecv(const void *out, int n, MPI_Datatype type, int to, int tag, void *in, int m,
                 MPI_Datatype type_in, int from, int tag_in, MPI_Comm comm, MPI_Status *status)
{
  COUNT(SENDRECV, n, type);
  return PMPI_Sendrecv(out, n, type, to, tag, in, m, type_in, from, tag_in, comm, status);
}

int MPI_Send(const void *out, int n, MPI_Datatype type, int to, int tag, MPI_Comm comm)
{
  COUNT(SEND, n, type);
  return PMPI_Send(out, n, type, to, tag, comm);
}

int MPI_Allreduce(const void *out, void *in, int n, MPI_Datatype type, MPI_Op op, MPI_Comm comm)
{
  COUNT(ALLREDUCE, n, type);
  return PMPI_Allreduce(out, in, n, type, op, comm);
}

int MPI_Bcast(void *values, int n, MPI_Datatype type, int root, MPI_Comm comm)
{
  COUNT(BCAST, n, type);
  return PMPI_Bcast(values, n, type, root, comm);
}

int MPI_Allgather(const void *out, int n, MPI_Datatype type, void *in, int m, MPI_Datatype type_in,
                  MPI_Comm comm)
{
  COUNT(ALLGATHER, n, type);
  return PMPI_Allgather(out, n, type, in, m, type_in, comm);
}

int MPI_Allgatherv(const void *out, int n, MPI_Datatype type, void *in, const int *m,
                   const int *places, MPI_Datatype type_in, MPI_Comm comm)
{
  COUNT(ALLGATHER, n, type);
  return PMPI_Allgatherv(out, n, type, in, m, places, type_in, comm);
}

int MPI_Alltoallv(const void *out, const int *n, const int *places, MPI_Datatype type, void *in,
                  const int *m, const int *places_in, MPI_Datatype type_in, MPI_Comm comm)
{
  int size;
  long values = 0;
  PMPI_Comm_size(comm, &size);
  for (int p = 0; p < size; ++p) values += n[p];
  COUNT(ALLTOALL, values, type);
  return PMPI_Alltoallv(out, n, places, type, in, m, places_in, type_in, comm);
}

int MPI_Reduce(const void *out, void *in, int n, MPI_Datatype type, MPI_Op op, int root,
               MPI_Comm comm)
{
  COUNT(REDUCE, n, type);
  return PMPI_Reduce(out, in, n, type, op, root, comm);
}

int MPI_Barrier(MPI_Comm comm)
{
  COUNT(BARRIER, 0, MPI_DATATYPE_NULL);
  return PMPI_Barrier(comm);
}

int MPI_Finalize(void)
{
  double most[FUNCTIONS][2][2];
  int rank;
  PMPI_Comm_rank(MPI_COMM_WORLD, &rank);
  PMPI_Reduce(counts, most, FUNCTIONS * 4, MPI_DOUBLE, MPI_MAX, 0, MPI_COMM_WORLD);
  for (int f = 0; f < FUNCTIONS && rank == 0; ++f)
    for (int plugin = 0; plugin < 2; ++plugin)
      if (most[f][plugin][0] > 0)
        printf("exchange %s %s %.17g %.17g\n", plugin ? "plugin" : "lammps", names[f],
               most[f][plugin][0], most[f][plugin][1]);
  fflush(stdout);
  return PMPI_Finalize();
}

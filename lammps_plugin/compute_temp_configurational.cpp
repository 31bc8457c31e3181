#include "compute_temp_configurational.h"

#include "update.h"

using namespace LAMMPS_NS;

ComputeTempConfigurational::ComputeTempConfigurational(LAMMPS *lmp, int narg, char **arg) :
    Compute(lmp, narg, arg)
{
  if (narg != 3) error->all(FLERR, "compute {}: takes no arguments", style);
  if (igroup != 0) error->all(FLERR, "compute {}: the group must be all", style);
  scalar_flag = vector_flag = 1;
  size_vector = 2;
  extscalar = 0;
  extvector = 1;
  comm_reverse = 6;
  vector = new double[2];
}

ComputeTempConfigurational::~ComputeTempConfigurational()
{
  delete[] vector;
}

void ComputeTempConfigurational::init()
{
  pair_ = &ConfigurationalTemperature::pair_of(*force, *error, style, true);
}

void ComputeTempConfigurational::compute_vector()
{
  invoked_vector = update->ntimestep;
  now_.force.assign(atom->nlocal + atom->nghost, Triple{});
  pair_->survey(reinterpret_cast<double (*)[3]>(now_.force.data()), now_.curvature);
  now_.sum(*comm, world, this, atom->nlocal);
  vector[0] = now_.force_squares;
  vector[1] = now_.laplacian;
}

double ComputeTempConfigurational::compute_scalar()
{
  invoked_scalar = update->ntimestep;
  if (invoked_vector != update->ntimestep) compute_vector();
  scalar = vector[1] > 0 ? vector[0] / vector[1] : 0;
  return scalar;
}

int ComputeTempConfigurational::pack_reverse_comm(int n, int first, double *buffer)
{
  return now_.pack_reverse(n, first, buffer);
}

void ComputeTempConfigurational::unpack_reverse_comm(int n, int *list, double *buffer)
{
  now_.unpack_reverse(n, list, buffer);
}

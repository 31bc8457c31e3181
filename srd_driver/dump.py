"""Frames of a trajectory, as LAMMPS writes them, for engines that are not LAMMPS."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lammps_inputs.system import SPINNING_TRAJECTORY, TRAJECTORY, System

Vectors = NDArray[Any]  # (N, d)


def write_frame(
    path: Path,
    step: int,
    system: System,
    vectors: tuple[Vectors, Vectors, Vectors],
    spins: Vectors | None = None,
) -> None:
    """Append a frame.

    Args:
        vectors: positions, wrapped [a0]; velocities [a0/t0]; image counts.
        spins: angular velocities [1/t0]; None: not to be written.
    """
    count, dimensions = vectors[0].shape
    names, form = TRAJECTORY.columns, "%d %d " + 6 * "%.10g " + "%d %d %d"
    if spins is not None:
        names, form = SPINNING_TRAJECTORY.columns, form + 3 * " %.10g"
    columns = np.zeros((count, len(names)))
    columns[:, 0] = np.arange(1, count + 1)
    columns[:, 1] = system.atom_types()
    for first, values in zip((2, 5, 8), vectors, strict=True):
        columns[:, first : first + dimensions] = values
    if spins is not None:
        columns[:, 11:] = spins
    ends = [(0.0, size) for size in system.box.sizes] + [(-0.5, 0.5)] * (3 - dimensions)
    periodic = (*system.box.periodic, True)[:3]
    with path.open("a", encoding="utf-8") as file:
        file.write(
            f"ITEM: TIMESTEP\n{step}\nITEM: NUMBER OF ATOMS\n{count}\n"
            f"ITEM: BOX BOUNDS {' '.join('pp' if way else 'ff' for way in periodic)}\n"
        )
        file.writelines(f"{low:g} {high!r}\n" for low, high in ends)
        file.write(f"ITEM: ATOMS {' '.join(names)}\n")
        np.savetxt(file, columns, fmt=form)

"""Trajectories as LAMMPS writes them."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray


def frames(file: Path) -> dict[int, NDArray[np.float64]]:
    """Rows of each frame of a dump, by step."""
    read: dict[int, NDArray[np.float64]] = {}
    for text in file.read_text().split("ITEM: TIMESTEP\n")[1:]:
        step, _, rows = text.partition("\n")
        values = rows.partition("ITEM: ATOMS ")[2].partition("\n")[2]
        read[int(step)] = np.loadtxt(values.splitlines(), ndmin=2)
    return read

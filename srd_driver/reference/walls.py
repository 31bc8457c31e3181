"""Virtual wall particles: what fills the cells that a wall cuts (tabatabaei-2009, 3.2.5)."""

import numpy as np
from numpy.typing import NDArray

from lammps_inputs.system import Array
from srd_driver.reference.collision import Cells
from srd_driver.reference.counter_random import CounterRandom, Stream


def cut_cells(cells: Cells, shift: Array, width: float) -> NDArray[np.bool_]:
    """Which cells reach beyond y = 0 or y = width, (cells,). Row iy starts at y = iy - shift."""
    lower = np.arange(cells.shape[1]) - shift[1]
    cut: NDArray[np.bool_] = ((lower < 0) | (lower + 1 > width))[cells.rows]
    return cut


def mean_with_virtual_particles(
    velocities: Array,
    cells: Cells,
    cut: NDArray[np.bool_],
    density: float,
    random: CounterRandom,
) -> Array:
    """v_cm of each cell, (d, cells), with virtual particles in the cut ones (3.14).

    A cut cell with n < n_f particles gets n_f - n more, at rest on average and at kBT = 1. Only
    the sum zeta of their velocities matters: a normal of variance n_f - n in each component,
    v_cm = (sum v + zeta) / n_f.

    Args:
        velocities: of the fluid (d, N).
        cells: the sorted particles.
        cut: from `cut_cells`.
        density: n_f, the mean number of particles in a bulk cell.
        random: of this collision.
    """
    filled = np.flatnonzero(cut & (cells.occupation < density))
    normals = random.normal(Stream.WALL, cells.count)[: len(velocities), filled]
    missing = density - cells.occupation[filled]
    total = cells.sum(velocities)
    mean = total / np.maximum(cells.occupation, 1)
    mean[:, filled] = (total[:, filled] + np.sqrt(missing) * normals) / density
    return mean

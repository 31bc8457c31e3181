"""The flow of the fluid on a grid: averages by bins, as fix mpc writes them."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Self

import numpy as np
from numpy.typing import NDArray

from analysis.arrays import Array
from analysis.averages_file import AveragesFile
from run_files.reading import refuse


@dataclass(frozen=True)
class FlowField:
    """The fluid on a grid, each an average over the time up to its step.

    Attributes:
        steps: last engine step of each average, (K,).
        axes: middles of the bins along each axis; about a particle, distances from it along
            periodic axes [a0].
        counts: particles in each bin, (K, nx, ny) or (K, nx, ny, nz).
        velocity: their mean velocity in the laboratory, (K, nx, ny, ..., d) [a0/t0].
        temperature: mean square velocity per dimension, the flow left in, (K, nx, ny, ...) [kBT].
    """

    steps: NDArray[np.int64]
    axes: tuple[Array, ...]
    counts: Array
    velocity: Array
    temperature: Array

    def mean(self, used: NDArray[np.bool_] | None = None) -> Self:
        """The average of those averages, every particle with the same weight; K is then 1.

        Args:
            used: which of them, (K,); default: all.
        """
        chosen = np.full(len(self.steps), True) if used is None else used
        counts = self.counts[chosen]
        total = np.maximum(counts.sum(axis=0), 1e-300)
        velocity = (counts[..., None] * self.velocity[chosen]).sum(axis=0) / total[..., None]
        temperature = (counts * self.temperature[chosen]).sum(axis=0) / total
        return type(self)(
            self.steps[chosen][-1:],
            self.axes,
            counts.mean(axis=0)[None],
            velocity[None],
            temperature[None],
        )

    @classmethod
    def of_table(cls, steps: NDArray[np.int64], table: Array, bins: Sequence[int]) -> Self:
        """From the columns that `flow_columns` names, (K, bins, columns), the last axis fastest."""
        axes = len(bins)
        table = table.reshape(len(steps), *bins, table.shape[-1])
        places = [np.moveaxis(table[0, ..., a], a, 0).reshape(bins[a], -1) for a in range(axes)]
        return cls(
            steps,
            tuple(place[:, 0] for place in places),
            table[..., axes],
            table[..., axes + 1 : 2 * axes + 1],
            table[..., -1],
        )


def flow_columns(dimensions: int) -> list[str]:
    """The columns of a file of fix mpc that a flow field needs, in order."""
    return [
        *(f"Coord{axis + 1}" for axis in range(dimensions)),
        "Ncount",
        *(f"v{axis}" for axis in "xyz"[:dimensions]),
        "temp",
    ]


def read_flow(path: str | Path) -> FlowField:
    """The flow that `flow` of fix mpc wrote, of a deck of one's own; the last, cut, is left out.

    Raises:
        RunDirectoryError: when it is missing or no such file, or has no complete average.
    """
    path = Path(path)
    file = AveragesFile.read(path, "Chunk Coord1")
    dimensions = 3 if "Coord3" in file.names else 2
    wanted = flow_columns(dimensions)
    if not set(wanted) <= set(file.names):
        refuse(path, "not a flow field of fix mpc: no columns " + " ".join(wanted))
    steps, table = file.bins(wanted)
    shape = [len(np.unique(table[0, :, axis])) for axis in range(dimensions)]
    if math.prod(shape) != table.shape[1]:
        refuse(path, "its bins are no grid")
    return FlowField.of_table(steps.astype(np.int64), table, shape)

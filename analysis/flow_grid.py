"""The flow of the fluid on a grid: averages by bins, as fix mpc writes them."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Self

import numpy as np
from numpy.typing import NDArray

from analysis.arrays import Array
from run_files.reading import read_text, refuse


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
    lines = read_text(path, largest=math.inf).splitlines()
    names = next((line.split()[1:] for line in lines if line.startswith("# Chunk Coord1")), [])
    dimensions = 3 if "Coord3" in names else 2
    wanted = flow_columns(dimensions)
    if not set(wanted) <= set(names):
        refuse(path, "not a flow field of fix mpc: no columns " + " ".join(wanted))
    words = " ".join(line for line in lines if not line.startswith("#")).split()
    try:
        numbers = np.array(words, dtype=float)
    except ValueError:
        refuse(path, "holds text among numbers")
    bins = int(numbers[1]) if len(numbers) > 1 and numbers[1] >= 1 else 0
    width = 3 + bins * len(names)
    count = len(numbers) // width
    if not bins or not count:
        refuse(path, "no complete average yet")
    rows = numbers[: count * width].reshape(count, width)
    table = rows[:, 3:].reshape(count, bins, len(names))[..., [names.index(n) for n in wanted]]
    shape = [len(np.unique(table[0, :, axis])) for axis in range(dimensions)]
    if np.any(rows[:, 1] != bins) or math.prod(shape) != bins or not np.isfinite(rows).all():
        refuse(path, "its bins are no grid, not the same everywhere, or not finite")
    return FlowField.of_table(rows[:, 0].astype(np.int64), table, shape)

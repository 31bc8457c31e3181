"""Where particles are at the start."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lammps_inputs.system import Box, Species

Array = NDArray[np.float64]

PLACEMENT_STREAM = 91  # Philox key of random placements


@dataclass(frozen=True)
class Row:
    """A row along x through the middle of the box, the lowest number leftmost.

    Attributes:
        spacing: of neighbouring centres, the first half of it from the lower end [a0].
    """

    spacing: float

    def positions(self, box: Box, species: tuple[Species, ...], seed: int) -> Array:
        """Centres (N, d) [a0]; no use is made of the seed."""
        count = sum(each.count for each in species)
        x = self.spacing * (np.arange(count) + 0.5)
        middle = np.array(box.sizes[1:]) / 2
        return np.column_stack([x, np.broadcast_to(middle, (count, len(middle)))])


@dataclass(frozen=True)
class Lattice:
    """A square or cubic lattice as coarse as the number allows, its sites taken at random.

    So that species are mixed. Sites are half a spacing from the ends of the box.
    """

    def positions(self, box: Box, species: tuple[Species, ...], seed: int) -> Array:
        """Centres (N, d) [a0], a function of the seed."""
        count = sum(each.count for each in species)
        cells = lattice_cells(box.sizes, count)
        axes = [
            (np.arange(cells_along) + 0.5) * size / cells_along
            for cells_along, size in zip(cells, box.sizes, strict=True)
        ]
        sites = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(cells))
        random = np.random.Generator(np.random.Philox(key=[seed, PLACEMENT_STREAM]))
        return np.asarray(random.permutation(sites)[:count])


def lattice_cells(sizes: tuple[float, ...], count: int) -> list[int]:
    """Cells along each axis of the coarsest nearly cubic lattice with at least `count` sites."""
    spacing = (math.prod(sizes) / count) ** (1 / len(sizes))
    cells = [max(1, int(size / spacing + 1e-9)) for size in sizes]
    while math.prod(cells) < count:
        widest = max(range(len(sizes)), key=lambda axis: sizes[axis] / cells[axis])
        cells[widest] += 1
    return cells

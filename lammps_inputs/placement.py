"""Where particles are at the start."""

import json
import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from lammps_inputs.system import Array, Box, Species

PLACEMENT_STREAM = 91  # Philox key of random placements
LONGEST_ROW = 300  # bytes of a dump's row
MANIFEST = "manifest.json"  # of the run that one begins from


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


@dataclass(frozen=True)
class Hexagonal:
    """A triangular lattice of two disks a cell, its sites taken at random: species are mixed.

    Attributes:
        columns, rows: cells along x and y.
    """

    columns: int
    rows: int

    def positions(self, box: Box, species: tuple[Species, ...], seed: int) -> Array:
        """Centres (N, 2) [a0], a function of the seed."""
        cell = np.array(box.sizes) / (self.columns, self.rows)
        corners = np.stack(
            np.meshgrid(np.arange(self.columns), np.arange(self.rows), indexing="ij"), axis=-1
        ).reshape(-1, 1, 2)
        sites = ((corners + np.array([[0.25, 0.25], [0.75, 0.75]])) * cell).reshape(-1, 2)
        random = np.random.Generator(np.random.Philox(key=[seed, PLACEMENT_STREAM]))
        return np.asarray(random.permutation(sites))


@dataclass(frozen=True)
class Random:
    """Anywhere, one after the other, but no two nearer than a distance.

    Attributes:
        distance: [a0].
    """

    distance: float

    def positions(self, box: Box, species: tuple[Species, ...], seed: int) -> Array:
        """Centres (N, d) [a0], a function of the seed."""
        count = sum(each.count for each in species)
        random = np.random.Generator(np.random.Philox(key=[seed, PLACEMENT_STREAM]))
        accepted = np.empty((count, box.dimensions))
        number = 0
        while number < count:
            trial = random.random(box.dimensions) * np.array(box.sizes)
            apart = box.nearest_image(accepted[:number] - trial)
            if np.all(np.einsum("ij,ij->i", apart, apart) > self.distance**2):
                accepted[number] = trial
                number += 1
        return accepted


@dataclass(frozen=True)
class LastFrame:
    """As another run left the same particles in the same box, with their velocities.

    Attributes:
        trajectory: that run's dump of them, with the columns of `TRAJECTORY`.
    """

    trajectory: str

    def positions(self, box: Box, species: tuple[Species, ...], seed: int) -> Array:
        """Centres (N, d) [a0]; no use is made of the seed."""
        return self._columns(box, species)[:, 0:3][:, : box.dimensions]

    def velocities(self, box: Box, species: tuple[Species, ...]) -> Array:
        """Velocities (N, d) relative to the flow where that run was sheared [a0/t0]."""
        columns = self._columns(box, species)
        velocities = columns[:, 3:6][:, : box.dimensions].copy()
        velocities[:, 0] -= self._shear_rate() * columns[:, 1]
        return velocities

    def tilt(self, box: Box, species: tuple[Species, ...]) -> float:
        """How far along x the image above the box was ahead [a0]."""
        return _tilt(self._last_frame(species))

    def problems(self, box: Box, species: tuple[Species, ...]) -> Iterator[str]:
        """Why it cannot be started from, in one line."""
        try:
            self.velocities(box, species)
        except OSError as error:
            yield f"{error.filename or self.trajectory}: {error.strerror or error}"
        except (ValueError, IndexError, LookupError, AttributeError, TypeError) as error:
            yield f"{self.trajectory}: {error}"

    def _columns(self, box: Box, species: tuple[Species, ...]) -> Array:
        """x y z vx vy vz of the last whole frame, sorted by number, (N, 6).

        Raises:
            OSError: when there is no such file.
            ValueError: when its frames are of other particles or another box.
        """
        last = self._last_frame(species)
        bounds = np.array([line.split()[:2] for line in last[4 : 4 + box.dimensions]], dtype=float)
        edges = bounds[:, 1] - bounds[:, 0]
        edges[0] -= abs(_tilt(last))  # of the parallelepiped, not of what bounds it
        if not np.allclose(edges, box.sizes, rtol=1e-9):
            wanted = " x ".join(f"{size:.6g}" for size in box.sizes)
            raise ValueError(
                f"its box is {' x '.join(f'{edge:.6g}' for edge in edges)}, not {wanted}"
            )
        table = np.array([line.split() for line in last[8:]], dtype=float)
        types = np.repeat(np.arange(1, len(species) + 1), [each.count for each in species])
        if table.shape[1] < 8 or not np.array_equal(table[:, 1], types):
            raise ValueError("its particles are of other species")
        return np.asarray(table[:, 2:8])

    def _last_frame(self, species: tuple[Species, ...]) -> list[str]:
        """The lines after its first.

        Raises:
            OSError: when there is no such file.
            ValueError: when it ends without a whole frame of so many particles.
        """
        count = sum(each.count for each in species)
        with Path(self.trajectory).open("rb") as file:
            file.seek(0, 2)
            file.seek(max(0, file.tell() - 2 * LONGEST_ROW * (count + 9)))
            frames = file.read().decode(errors="replace").split("ITEM: TIMESTEP\n")[1:]
        rows = [frame.splitlines() for frame in frames if frame.endswith("\n")]
        whole = [lines for lines in rows if len(lines) == count + 8]
        if not whole:
            raise ValueError(f"no whole frame of {count} particles at its end")
        return whole[-1]

    def _shear_rate(self) -> float:
        """Of the flow in that run, as its manifest tells; 0 without one [1/t0]."""
        manifest = json.loads(Path(self.trajectory).with_name(MANIFEST).read_text(encoding="utf-8"))
        return float(manifest["system"]["motion"].get("shear_rate", 0.0))


def _tilt(frame: list[str]) -> float:
    """The third number of the bounds along x, where a box has it."""
    bounds = frame[4].split()
    return float(bounds[2]) if len(bounds) == 3 else 0.0


def lattice_cells(sizes: tuple[float, ...], count: int) -> list[int]:
    """Cells along each axis of the coarsest nearly cubic lattice with at least `count` sites."""
    spacing = (math.prod(sizes) / count) ** (1 / len(sizes))
    cells = [max(1, int(size / spacing + 1e-9)) for size in sizes]
    while math.prod(cells) < count:
        widest = max(range(len(sizes)), key=lambda axis: sizes[axis] / cells[axis])
        cells[widest] += 1
    return cells

"""The collision: particles sorted into cells of a shifted grid, relative velocities rotated.

Equations of tabatabaei-2009, 3.2.1 to 3.2.4; rotations about the coordinate axes of hecht-2005,
section III. Arrays hold the components first, (d, N).
"""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lammps_inputs.system import Array, Rotation
from srd_driver.reference.counter_random import CounterRandom, Stream, uniform

Indices = NDArray[np.intp]


def grid_shape(box: tuple[float, ...], periodic: tuple[bool, ...]) -> tuple[int, ...]:
    """Number of cells along each axis; across walls one more row than the width holds."""
    return tuple(
        round(size) if wraps else math.ceil(size) + 1
        for size, wraps in zip(box, periodic, strict=True)
    )


def grid_shift(random: CounterRandom, dimensions: int) -> Array:
    """The shift of this collision, uniform in [0, 1) along each axis, shape (d,) (3.2.4)."""
    return random.uniform(Stream.SHIFT, 1)[:dimensions, 0]


@dataclass(frozen=True)
class Cells:
    """The collision cells, of edge a0 = 1, and who is in them.

    Attributes:
        shape: cells along each axis (nx, ny[, nz]).
        numbers: cell ix + nx (iy + ny iz) of each particle (N,).
    """

    shape: tuple[int, ...]
    numbers: Indices

    @classmethod
    def sort(
        cls, positions: Array, shift: Array, shape: tuple[int, ...], periodic: tuple[bool, ...]
    ) -> "Cells":
        """The cell floor(r + shift) of each particle along each axis, wrapped where periodic."""
        numbers = np.zeros(positions.shape[1], dtype=np.intp)
        for axis in reversed(range(len(shape))):
            row = (positions[axis] + shift[axis]).astype(np.intp)
            if periodic[axis]:
                row[row >= shape[axis]] -= shape[axis]
            else:
                np.minimum(row, shape[axis] - 1, out=row)  # a sum rounded up to the outer edge
            numbers *= shape[axis]
            numbers += row
        return cls(shape, numbers)

    @property
    def count(self) -> int:
        """Number of cells."""
        return math.prod(self.shape)

    @cached_property
    def occupation(self) -> Array:
        """Particles in each cell, n (cells,)."""
        return np.bincount(self.numbers, minlength=self.count).astype(float)

    @cached_property
    def rows(self) -> Indices:
        """The row iy of each cell, its layer parallel to the walls (cells,)."""
        return (np.arange(self.count) // self.shape[0]) % self.shape[1]

    def sum(self, values: Array) -> Array:
        """Sum over the particles of each cell: (N,) to (cells,), (d, N) to (d, cells)."""
        if values.ndim == 1:
            total: Array = np.bincount(self.numbers, values, self.count).astype(float, copy=False)
            return total
        return np.stack([self.sum(component) for component in values])

    def mean_velocity(self, velocities: Array) -> Array:
        """Velocity of the centre of mass of each cell (3.5), 0 where empty: (d, cells)."""
        return self.sum(velocities) / np.maximum(self.occupation, 1)

    def of_particles(self, values: Array) -> Array:
        """What each particle's cell has: (cells,) to (N,), (d, cells) to (d, N)."""
        taken: Array = np.take(values, self.numbers, axis=-1)
        return taken


def collide(
    velocities: Array,
    cells: Cells,
    mean: Array,
    angle: float,
    rotation: Rotation,
    random: CounterRandom,
) -> None:
    """Rotate, in place, the velocities about the mean of their cell (3.4).

    Args:
        velocities: (d, N).
        cells: the sorted particles.
        mean: v_cm of each cell, virtual wall particles included (d, cells).
        angle: alpha [degrees].
        rotation: how the axis is drawn in 3D.
        random: of this collision.
    """
    centre = cells.of_particles(mean)
    relative = velocities - centre
    alpha = math.radians(angle)
    if len(velocities) == 2:
        sine = cells.of_particles(math.sin(alpha) * signs(random, cells.count))
        velocities[0] = centre[0] + math.cos(alpha) * relative[0] - sine * relative[1]
        velocities[1] = centre[1] + sine * relative[0] + math.cos(alpha) * relative[1]
    else:
        draw = coordinate_axes if rotation == "coordinate_axes" else random_axes
        axis = cells.of_particles(draw(random, cells.count))
        velocities[:] = centre + rotate(relative, axis, alpha)


def signs(random: CounterRandom, cells: int) -> Array:
    """2D: +1 (counter-clockwise) or -1 for each cell, as its first uniform is below 1/2."""
    return np.where(uniform(random.mixed(Stream.ROTATION, cells))[0] < 0.5, 1.0, -1.0)


def random_axes(random: CounterRandom, cells: int) -> Array:
    """A unit vector for each cell, uniform on the sphere (3.8), from its first two uniforms."""
    s1, s2 = uniform(random.mixed(Stream.ROTATION, cells))[:2]
    theta1, theta2 = 2 * s1 - 1, 2 * np.pi * s2
    equator = np.sqrt(1 - theta1**2)
    return np.stack([equator * np.cos(theta2), equator * np.sin(theta2), theta1])


def coordinate_axes(random: CounterRandom, cells: int) -> Array:
    """One of +x, -x, +y, -y, +z, -z for each cell: number floor(6 u) of that list.

    Turning by 90 degrees about them gives the six rotations of hecht-2005.
    """
    choice = (6 * uniform(random.mixed(Stream.ROTATION, cells))[0]).astype(np.intp)
    axes = np.array([[1.0, -1, 0, 0, 0, 0], [0, 0, 1, -1, 0, 0], [0, 0, 0, 0, 1, -1]])
    drawn: Array = np.take(axes, choice, axis=1)
    return drawn


def rotate(vectors: Array, axes: Array, angle: float) -> Array:
    """Vectors (3, N) turned about unit axes (3, N) by an angle [rad], right-handed."""
    x, y, z = vectors
    nx, ny, nz = axes
    along = (1 - math.cos(angle)) * (nx * x + ny * y + nz * z)
    cross = np.stack([ny * z - nz * y, nz * x - nx * z, nx * y - ny * x])
    turned: Array = math.cos(angle) * vectors + math.sin(angle) * cross + along * axes
    return turned

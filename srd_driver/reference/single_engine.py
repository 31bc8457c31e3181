"""The reference engine in single precision: as `fix mpc ... precision single` keeps its fluid.

Velocities are single. Positions are whole places, 2^20 to a cell: as fine in any box. What all
particles of a cell share (sums, rotation, thermostat) is computed in double, and rounded once, to
the map v -> offset + matrix v of the cell. Arrays hold the components first, (d, N).
"""

import math

import numpy as np

from lammps_inputs import InitialState, Scene, initial_state
from lammps_inputs.system import Array
from srd_driver.reference import thermostats
from srd_driver.reference.collision import (
    Cells,
    coordinate_axes,
    grid_shift,
    random_axes,
    rotate,
    signs,
)
from srd_driver.reference.colloids import ColloidForces
from srd_driver.reference.counter_random import CounterRandom, Stream, Words
from srd_driver.reference.engine import ReferenceEngine
from srd_driver.reference.streaming import bounce_back
from srd_driver.reference.walls import cut_cells, mean_with_virtual_particles

PLACES = 2.0**20  # in a cell, of edge a0 = 1
GOLDEN = 0.6180339887498949
UNSCALED = ("none", "andersen")  # thermostats that leave the cells' maps alone
FINER = np.uint64(2**29 - 1)  # the binary digits that a single number lacks
NEAREST = np.uint64(2**28)  # half of the last that it has


class SingleEngine(ReferenceEngine):
    """A pure fluid, or one with force-coupled colloids, in single precision; no random solvents.

    The velocities are kept in arrays of doubles, which hold single numbers.
    """

    def __init__(self, scene: Scene, state: InitialState | None = None) -> None:
        super().__init__(scene, state or initial_state(scene.system, scene.seed))
        self._round()

    def _round(self) -> None:
        """The state to the nearest places and single velocities."""
        self._fluid_positions[:] = np.rint(self._fluid_positions * PLACES) / PLACES
        self._fluid_velocities[:] = self._fluid_velocities.astype(np.float32)
        if self._width is not None:
            last = np.floor(self._width * PLACES) / PLACES
            np.clip(self._fluid_positions[1], 0, last, out=self._fluid_positions[1])

    def _stream(self) -> None:
        """Free flight for tau_c: to the nearest place, with the dithered kick of the field."""
        self._step += 1
        time, field = self._solvent.collision_time, self._field
        x, v = self._fluid_positions, self._fluid_velocities.astype(np.float32)
        flown = v * np.float32(time * PLACES) + (0.5 * time * field * time * PLACES).astype(
            np.float32
        )
        end = x + np.trunc(flown + np.copysign(np.float32(0.5), flown)).astype(float) / PLACES
        kicked = v + self._kick().astype(np.float32)
        if self._width is not None:
            last = np.floor(self._width * PLACES) / PLACES
            crossing = np.flatnonzero((end[1] < 0) | (end[1] > last))
            end[:, crossing], kicked[:, crossing] = bounce_back(
                x[:, crossing],
                self._fluid_velocities[:, crossing],
                np.broadcast_to(field, x.shape)[:, crossing],
                time,
                self._width,
                crossing,
            )
        self._fluid_positions[:], self._fluid_velocities[:] = end, kicked
        self._round()

    def _kick(self) -> Array:
        """What the field adds to velocities in an interval (d, 1).

        It goes up and down by the last digit of 16 thermal speeds, in a sequence of even
        distribution: so that of a field however small the particles gain on average what it gives.
        """
        kick = self._solvent.collision_time * self._field
        part = self.collisions * GOLDEN
        dithered = kick + 2.0**-20 * (part - np.floor(part) - 0.5)
        result: Array = np.where(kick == 0, 0.0, dithered)
        return result

    def _molecular_dynamics(self, coupling: ColloidForces) -> None:
        super()._molecular_dynamics(coupling)
        self._round()

    def _collide(self) -> None:
        solvent, random = self._solvent, CounterRandom(self.scene.seed, self.collisions)
        dimensions, velocities = self._box.dimensions, self._fluid_velocities
        shift = np.floor(grid_shift(random, dimensions) * PLACES) / PLACES
        cells = Cells.sort(self._fluid_positions, shift, self._shape, self._box.periodic)
        mean = cells.mean_velocity(velocities)
        if self._width is not None:
            cut = cut_cells(cells, shift, self._width)
            mean = mean_with_virtual_particles(velocities, cells, cut, solvent.density, random)
        matrices = self._matrices(cells, random)
        offsets = mean - np.einsum("abc,bc->ac", matrices, mean)
        digits = random.mixed(Stream.ROTATION, cells.count)[3] & FINER
        if solvent.thermostat not in UNSCALED:
            digits = np.full_like(digits, NEAREST)
            factors, centre = self._factors(velocities, cells, matrices, offsets, random)
            matrices, offsets = matrices * factors, offsets * factors + (1 - factors) * centre
        _apply(velocities, cells, _rounded(matrices, digits), offsets)
        if solvent.thermostat == "andersen":
            thermostats.andersen(velocities, solvent.collision_time, random)
            velocities[:] = velocities.astype(np.float32)

    def _matrices(self, cells: Cells, random: CounterRandom) -> Array:
        """The rotation of each cell (d, d, cells)."""
        alpha = math.radians(self._solvent.angle)
        if self._box.dimensions == 2:
            sine = signs(random, cells.count) * math.sin(alpha)
            cosine = np.full(cells.count, math.cos(alpha))
            return np.array([[cosine, -sine], [sine, cosine]])
        draw = coordinate_axes if self._solvent.rotation == "coordinate_axes" else random_axes
        axes = draw(random, cells.count)
        units = np.broadcast_to(np.eye(3)[:, :, None], (3, 3, cells.count))
        return np.stack([rotate(units[:, b], axes, alpha) for b in range(3)], axis=1)

    def _factors(
        self,
        velocities: Array,
        cells: Cells,
        matrices: Array,
        offsets: Array,
        random: CounterRandom,
    ) -> tuple[Array, Array]:
        """By what the thermostat stretches velocities (cells,), and about which (d, cells).

        From the thermostat itself: what it makes of the turned velocities, in double.
        """
        centre = np.einsum("abc,bc->ac", matrices, cells.mean_velocity(velocities)) + offsets
        turned = np.einsum("abi,bi->ai", cells.of_particles(matrices), velocities)
        turned += cells.of_particles(offsets)
        relative = turned - cells.of_particles(centre)
        before = cells.sum((relative**2).sum(axis=0))
        name = self._solvent.thermostat
        if name == "layer":
            thermostats.layer(turned, cells)
        elif name == "monte_carlo":
            thermostats.monte_carlo(turned, cells, random)
        elif name == "maxwell_boltzmann":
            thermostats.maxwell_boltzmann(turned, cells, random)
        else:
            squares = np.sum(turned**2)
            thermostats.rescale(turned)
            factor = np.sqrt(np.sum(turned**2) / squares)
            return np.full(cells.count, factor), np.zeros_like(centre)
        relative = turned - cells.of_particles(centre)
        after = cells.sum((relative**2).sum(axis=0))
        return np.sqrt(np.where(before > 0, after, 1.0) / np.where(before > 0, before, 1.0)), centre


def _apply(velocities: Array, cells: Cells, matrices: Array, offsets: Array) -> None:
    """v becomes offset + matrix v, each in single precision, in place."""
    v = velocities.astype(np.float32)
    matrix = cells.of_particles(matrices.astype(np.float32))
    offset = cells.of_particles(offsets.astype(np.float32))
    for a in range(len(v)):
        turned = matrix[a, 0] * v[0] + matrix[a, 1] * v[1]
        if len(v) == 3:
            turned += matrix[a, 2] * v[2]
        velocities[a] = offset[a] + turned


def _rounded(matrices: Array, digits: Words) -> Array:
    """In single precision: the nearest, or of random digits on average the same.

    The nearest to a matrix that is always the same would multiply all energies by the same number,
    up to 3e-8 from 1, at each collision.
    """
    bits = np.ascontiguousarray(matrices).view(np.uint64) + digits
    rounded: Array = (bits & ~FINER).view(float)
    return rounded

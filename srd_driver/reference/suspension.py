"""Rotating spheres in a fluid, from one collision to the next (hecht-2005).

Between two collisions the fluid flies freely and the spheres move by molecular dynamics. At the
collision they either reflect the fluid (IV) or are particles of their cells (V). Arrays hold the
components first: fluid (d, N), spheres (d, N_c), spins as in `rotation`.
"""

from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from lammps_inputs.system import Array, Rotation, Thermostat
from srd_driver.reference import cell_coupling, thermostats
from srd_driver.reference.boundaries import (
    Boundaries,
    cut_cells,
    stream,
    take_from_cells,
    virtual_particles,
)
from srd_driver.reference.collision import Cells, collide, grid_shape, grid_shift
from srd_driver.reference.counter_random import CounterRandom
from srd_driver.reference.reflection import Spheres, reflect
from srd_driver.reference.rotation import kick
from srd_driver.reference.sphere_forces import SphereForces


@dataclass
class Suspension:
    """A fluid of kBT = m_f = 1 and spheres in it; all arrays are changed in place.

    Attributes:
        boundaries: the box and its walls.
        seed: of the random numbers.
        interval: between collisions [t0].
        steps: of molecular dynamics in it.
        fluid_positions, fluid_velocities: (d, N).
        spheres: the colloids; positions are not wrapped.
        coupling: reflection at the point of `entry` or the `nearest`; in the collision `cell`.
        acceleration: of the spheres (d, 1) [a0/t0^2].
        compensated: whether the fluid balances their weight.
        forces: between spheres, and of walls on them; None: there are none.
        angle, rotation: of the collision.
        thermostat: none, monte_carlo, or layer: that one across y.
        drift_interval: collisions between removals of the total momentum; 0: never.
        collisions: done so far.
    """

    boundaries: Boundaries
    seed: int
    interval: float
    steps: int
    fluid_positions: Array
    fluid_velocities: Array
    spheres: Spheres
    coupling: Literal["none", "entry", "nearest", "cell"]
    acceleration: Array
    compensated: bool = False
    forces: SphereForces | None = None
    angle: float = 90.0
    rotation: Rotation = "coordinate_axes"
    thermostat: Thermostat = "none"
    drift_interval: int = 0
    collisions: int = 0
    _pull: tuple[Array, Array] | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        self.field = np.zeros_like(self.acceleration)
        if self.compensated:
            weight = self.acceleration * self.spheres.masses.sum()
            self.field = -weight / self.fluid_positions.shape[1]

    def advance(self) -> None:
        """One interval, and the collision at its end."""
        self.boundaries.taken.clear()
        fluid = (self.fluid_positions, self.fluid_velocities)
        stream(*fluid, self.field, self.interval, self.boundaries)
        self.boundaries.wrap(self.fluid_positions)
        start = self.spheres.positions.copy()
        self._move_spheres()
        means = (self.spheres.positions - start) / self.interval
        random = CounterRandom(self.seed, self.collisions)
        if self.coupling in ("entry", "nearest"):
            self._reflect(random, means)
        self._collide(random)
        self.collisions += 1
        if self.drift_interval and self.collisions % self.drift_interval == 0:
            drift = self.momentum() / (self.fluid_positions.shape[1] + self.spheres.masses.sum())
            self.fluid_velocities -= drift[:, None]
            self.spheres.velocities[:] -= drift[:, None]

    def momentum(self) -> Array:
        """Of everything (d,)."""
        of_spheres = (self.spheres.masses * self.spheres.velocities).sum(axis=1)
        total: Array = self.fluid_velocities.sum(axis=1) + of_spheres
        return total

    @property
    def pull(self) -> tuple[Array, Array]:
        """Forces and torques on the spheres at the last step, weight aside."""
        if self._pull is None:
            self._pull = self._forces(self.collisions * self.steps)
        return self._pull

    @pull.setter
    def pull(self, pull: tuple[Array, Array]) -> None:
        self._pull = pull

    def _forces(self, step: int) -> tuple[Array, Array]:
        if self.forces is None:
            return np.zeros_like(self.spheres.velocities), np.zeros_like(self.spheres.spins)
        return self.forces(self.spheres, CounterRandom(self.seed, step))

    def _move_spheres(self) -> None:
        """Velocity Verlet (7, 8, 9 corrected); friction sees velocities of the half step."""
        spheres, time = self.spheres, self.interval / self.steps
        forces, torques = self.pull
        for step in range(self.steps):
            self._kick(forces, torques, 0.5 * time)
            spheres.positions[:] += time * spheres.velocities
            forces, torques = self._forces(self.collisions * self.steps + step + 1)
            self._kick(forces, torques, 0.5 * time)
        self.pull = forces, torques

    def _kick(self, forces: Array, torques: Array, time: float) -> None:
        spheres = self.spheres
        spheres.velocities[:] += time * (self.acceleration + forces / spheres.masses)
        kick(spheres.spins, torques, spheres.inertias, time)

    def _reflect(self, random: CounterRandom, means: Array) -> None:
        fluid = (self.fluid_positions, self.fluid_velocities)
        spheres = replace(self.spheres, mean_velocities=means)
        placement: Literal["entry", "nearest"] = "entry" if self.coupling == "entry" else "nearest"
        momentum, angular = reflect(
            *(*fluid, spheres, placement, self.interval, 1.0, self.field, self.boundaries),
            random,
        )
        spheres.velocities[:] += momentum / spheres.masses
        spheres.spins[:] += angular / spheres.inertias

    def _collide(self, random: CounterRandom) -> None:
        """On one shifted grid; spheres take part where the coupling says so."""
        positions, velocities, boundaries = (
            self.fluid_positions,
            self.fluid_velocities,
            self.boundaries,
        )
        count = positions.shape[1]
        masses = np.ones(count)
        if self.coupling == "cell":
            wrapped = self.spheres.positions.copy()
            boundaries.wrap(wrapped)
            positions = np.hstack([positions, wrapped])
            velocities = np.hstack([velocities, self.spheres.velocities])
            masses = np.concatenate([masses, self.spheres.masses])
        shift = grid_shift(random, len(positions))
        shape = grid_shape(boundaries.box, boundaries.periodic)
        cells = Cells.sort(positions, shift, shape, boundaries.periodic)
        fluid = np.bincount(cells.numbers[:count], minlength=cells.count).astype(float)
        cut = cut_cells(boundaries, cells, shift)
        filled = virtual_particles(boundaries, cut, fluid, 1.0, random)
        before = masses * velocities
        mean = cell_coupling.mean_velocity(velocities, masses, cells, *filled)
        collide(velocities, cells, mean, self.angle, self.rotation, random)
        if self.thermostat == "monte_carlo":
            cell_coupling.monte_carlo(velocities, masses, cells, 1.0, random)
        elif self.thermostat == "layer":
            thermostats.layer(velocities, cells)
        lost = before - masses * velocities
        in_cells = [np.bincount(cells.numbers, each, cells.count) for each in lost]
        take_from_cells(boundaries, cut, np.array(in_cells))
        if self.coupling == "cell":
            self.fluid_velocities[:] = velocities[:, :count]
            self.spheres.velocities[:] = velocities[:, count:]

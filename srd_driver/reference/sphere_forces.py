"""Forces and torques on spheres: their interaction, friction with its noise, and walls.

Equations of hecht-2005, section II; `pair_style dlvo` draws the same random numbers.
"""

from dataclasses import dataclass

import numpy as np

from lammps_inputs.potentials.dlvo import Dlvo
from lammps_inputs.system import Array, Wall
from srd_driver.reference.boundaries import Boundaries
from srd_driver.reference.counter_random import CounterRandom, Stream, box_muller, uniform
from srd_driver.reference.reflection import Spheres
from srd_driver.reference.rotation import torque


@dataclass(frozen=True)
class SphereForces:
    """Between spheres of one species, three-dimensional, and of walls on them.

    Attributes:
        boundaries: the box.
        time_step: of molecular dynamics, by which the noise goes [t0].
        between: the interaction of two spheres, or None.
        walls: each with potentials, for `species`.
        species: name of the spheres.
    """

    boundaries: Boundaries
    time_step: float
    between: Dlvo | None = None
    walls: tuple[Wall, ...] = ()
    species: str = ""

    def __call__(self, spheres: Spheres, random: CounterRandom) -> tuple[Array, Array]:
        """Forces (3, N_c) and torques (3, N_c); `random` is of the step."""
        forces, torques = np.zeros_like(spheres.positions), np.zeros_like(spheres.spins)
        if self.between is not None:
            self._add_pairs(self.between, spheres, random, forces, torques)
        for wall in self.walls:
            outwards = 1.0 if wall.side == "upper" else -1.0
            place = self.boundaries.box[wall.axis] if wall.side == "upper" else 0.0
            distance = outwards * (place - spheres.positions[wall.axis])
            for species, potential in wall.potentials:
                if species == self.species:
                    forces[wall.axis] -= outwards * potential.force(distance)
        return forces, torques

    def _add_pairs(
        self, between: Dlvo, spheres: Spheres, random: CounterRandom, forces: Array, torques: Array
    ) -> None:
        first, second = np.triu_indices(spheres.positions.shape[1], 1)
        apart = spheres.positions[:, first] - spheres.positions[:, second]
        for axis, size in enumerate(self.boundaries.box):
            if self.boundaries.periodic[axis]:
                apart[axis] -= size * np.rint(apart[axis] / size)
        r = np.sqrt((apart**2).sum(axis=0))
        near = r < between.reach
        first, second, apart, r = first[near], second[near], apart[:, near], r[near]
        e = apart / r  # from the second to the first
        along = np.where(r < between.cutoff, between.force(r), 0.0)
        friction = between.normal_friction(r)
        rough = np.where(r < between.diameter, between.friction, 0.0)
        relative = spheres.velocities[:, first] - spheres.velocities[:, second]
        spins = spheres.spins[:, first] + spheres.spins[:, second]
        noise = (
            np.sqrt(2 / self.time_step)
            * np.array(
                [
                    _normals(random, i, j) if any_friction else np.zeros(4)
                    for i, j, any_friction in zip(first, second, friction + rough > 0, strict=True)
                ]
            )
            .reshape(-1, 4)
            .T
        )
        along += noise[0] * np.sqrt(friction) - friction * (relative * e).sum(axis=0)
        surface = relative - np.cross(0.5 * r * spins, e, axis=0)
        across = noise[1:] * np.sqrt(rough) - rough * surface
        across -= (across * e).sum(axis=0) * e
        pull = along * e + across
        twist = -0.5 * r * torque(e, across)
        for axis in range(3):
            np.add.at(forces[axis], first, pull[axis])
            np.add.at(forces[axis], second, -pull[axis])
            np.add.at(torques[axis], first, twist[axis])
            np.add.at(torques[axis], second, twist[axis])


def _normals(random: CounterRandom, first: int, second: int) -> Array:
    """Of a pair (4,), along the line of centres and across: the block of their atom numbers."""
    words = random.block(Stream.PAIR, int(first) + 1, int(second) + 1)
    return box_muller(uniform(words)[:, None])[:, 0]

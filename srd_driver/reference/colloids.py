"""Colloids in the fluid: the forces of (3.42), (3.43) and (3.49), and who may feel them.

Arrays hold the components first: fluid (2, N_f), colloids (2, N_c). Positions may leave the
periodic box between two collisions; a pair keeps the image that was nearest when it was found.
Equations of tabatabaei-2009, 3.4.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lammps_inputs import Channel
from srd_driver.reference.faults import SimulationFault

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

CORE = 0.5  # of sigma: no closer approach, 1.6e4 kBT of the 12-6 repulsion


@dataclass(frozen=True)
class Pairs:
    """Pairs that may come within a cutoff, the first minus the second being their separation.

    Attributes:
        first, second: particle numbers (pairs,).
        image: added to the x of the separation (pairs,) [a0].
    """

    first: Indices
    second: Indices
    image: Array

    def separations(self, first: Array, second: Array) -> Array:
        """(2, pairs) from positions (2, N) of both kinds."""
        separation = first[:, self.first] - second[:, self.second]
        separation[0] += self.image
        return separation

    def within(self, reach: float | Array, first: Array, second: Array) -> "Pairs":
        """Those closer than a reach, one for all or each its own."""
        separation = self.separations(first, second)
        near = (separation**2).sum(axis=0) < np.square(reach)
        return Pairs(self.first[near], self.second[near], self.image[near])


class ColloidForces:
    """Forces between colloids and fluid, among colloids, and of the walls on colloids.

    The pairs are found once per collision. A fluid particle is paired with every colloid that
    could come within the cutoff if neither moved further than an allowance: speed times tau_c,
    the speed being the present one plus a margin of one thermal speed. What is in no pair flies
    free and keeps its speed. The displacement of everything in a pair is checked at every force
    evaluation, and the pairs are found anew in time when an allowance is used up: no force is
    ever missed.
    """

    def __init__(self, scene: Channel) -> None:
        self._scene = scene
        self._fluid_margin = 1.0
        self._colloid_margin = 1 / np.sqrt(scene.colloid_mass)

    def find_pairs(
        self,
        fluid_positions: Array,
        fluid_velocities: Array,
        colloid_positions: Array,
        colloid_velocities: Array,
    ) -> None:
        """Find the pairs that may interact before tau_c has passed."""
        time = self._scene.collision_time
        speed = np.hypot(*fluid_velocities) + self._fluid_margin
        colloid_speed = np.hypot(*colloid_velocities).max() + self._colloid_margin
        self._colloid_allowance = time * colloid_speed
        reach = self._scene.colloid_fluid.cutoff + time * (speed + colloid_speed)
        fluid = _columns_near(fluid_positions, colloid_positions, reach.max(), self._scene.length)
        self._fluid_pairs = fluid.within(reach[fluid.first], fluid_positions, colloid_positions)

        first, second = np.triu_indices(self._scene.colloids, k=1)
        image = _image(
            colloid_positions[0, first] - colloid_positions[0, second], self._scene.length
        )
        self._colloid_pairs = Pairs(first, second, image).within(
            self._scene.colloid_colloid.cutoff + 2 * self._colloid_allowance,
            colloid_positions,
            colloid_positions,
        )

        self._near = np.unique(self._fluid_pairs.first)
        self._near_allowance = time * speed[self._near]
        self._near_start = fluid_positions[:, self._near]
        self._colloid_start = colloid_positions.copy()

    def pairs_hold(self, fluid_positions: Array, colloid_positions: Array) -> bool:
        """Whether nothing has moved further than the pairs allow."""
        moved = np.hypot(*(fluid_positions[:, self._near] - self._near_start))
        colloids_moved = np.hypot(*(colloid_positions - self._colloid_start))
        return bool(
            (moved <= self._near_allowance).all()
            and (colloids_moved <= self._colloid_allowance).all()
        )

    def forces(self, fluid_positions: Array, colloid_positions: Array) -> tuple[Array, Array]:
        """Forces on the fluid (2, N_f) and on the colloids (2, N_c), gravity left out (3.50).

        Raises:
            SimulationFault: for a particle deep in a colloid, or a colloid not between the walls.
        """
        scene = self._scene
        pairs = self._fluid_pairs
        separation = pairs.separations(fluid_positions, colloid_positions)
        r_squared = (separation**2).sum(axis=0)
        self._check_cores(pairs, r_squared, scene.colloid_fluid.sigma, "fluid particle")
        force = separation * scene.colloid_fluid.force_over_distance(r_squared)
        on_fluid = _sums(pairs.first, force, scene.fluid_particles)
        on_colloids = -_sums(pairs.second, force, scene.colloids)

        pairs = self._colloid_pairs
        if pairs.first.size:
            separation = pairs.separations(colloid_positions, colloid_positions)
            r_squared = (separation**2).sum(axis=0)
            self._check_cores(pairs, r_squared, scene.colloid_colloid.sigma, "colloid")
            force = separation * scene.colloid_colloid.force_over_distance(r_squared)
            on_colloids += _sums(pairs.first, force, scene.colloids)
            on_colloids -= _sums(pairs.second, force, scene.colloids)

        lower, upper = colloid_positions[1], scene.width - colloid_positions[1]
        outside = np.flatnonzero(~((lower > 0) & (upper > 0)))
        if outside.size:
            y = colloid_positions[1, outside[0]]
            raise SimulationFault(
                f"colloid {outside[0]} is at y = {y}, through a wall: the time step "
                f"{scene.time_step:g} is too long for its wall potential, or the walls too weak"
            )
        from_lower, from_upper = scene.colloid_wall.force([lower, upper])
        on_colloids[1] += from_lower - from_upper
        return on_fluid, on_colloids

    def energy(self, fluid_positions: Array, colloid_positions: Array) -> float:
        """Potential energy of everything that `forces` has [kBT]."""
        scene = self._scene
        fluid = self._fluid_pairs.separations(fluid_positions, colloid_positions)
        colloids = self._colloid_pairs.separations(colloid_positions, colloid_positions)
        lower, upper = colloid_positions[1], scene.width - colloid_positions[1]
        return float(
            scene.colloid_fluid.energy(np.hypot(*fluid)).sum()
            + scene.colloid_colloid.energy(np.hypot(*colloids)).sum()
            + scene.colloid_wall.energy(lower).sum()
            + scene.colloid_wall.energy(upper).sum()
        )

    def _check_cores(self, pairs: Pairs, r_squared: Array, sigma: float, kind: str) -> None:
        deep = ~(r_squared > (CORE * sigma) ** 2)  # true for NaN
        if deep.any():
            i = np.flatnonzero(deep)[0]
            raise SimulationFault(
                f"{kind} {pairs.first[i]} is {np.sqrt(r_squared[i]):.4g} from the centre of "
                f"colloid {pairs.second[i]}, inside its core: the time step "
                f"{self._scene.time_step:g} is too long"
            )


def _sums(indices: Indices, forces: Array, count: int) -> Array:
    """Forces (2, pairs) summed for each particle (2, count)."""
    sums = np.empty((2, count))
    for axis, force in enumerate(forces):
        sums[axis] = np.bincount(indices, weights=force, minlength=count)
    return sums


def _image(separation: Array, length: float) -> Array:
    """What to add to separations along x to make them those of the nearest images."""
    image: Array = -length * np.round(separation / length)
    return image


def _columns_near(fluid: Array, colloids: Array, reach: float, length: float) -> Pairs:
    """Pairs of each colloid with all the fluid in the columns of width a0 within reach of it."""
    columns = round(length)
    half = int(np.ceil(reach))
    of_fluid = np.floor(fluid[0]).astype(np.intp) % columns
    by_column = np.argsort(of_fluid, kind="stable")
    occupation = np.bincount(of_fluid, minlength=columns)
    start = np.cumsum(occupation) - occupation

    offsets = np.arange(min(2 * half + 1, columns)) - half
    near = (np.floor(colloids[0]).astype(np.intp)[:, None] + offsets) % columns
    counts = occupation[near].ravel()
    second = np.repeat(np.repeat(np.arange(colloids.shape[1]), len(offsets)), counts)
    within = np.arange(len(second)) - np.repeat(np.cumsum(counts) - counts, counts)
    first = by_column[np.repeat(start[near].ravel(), counts) + within]
    return Pairs(first, second, _image(fluid[0, first] - colloids[0, second], length))

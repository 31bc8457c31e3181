"""Particles of all species in the fluid: their forces, and who may feel them.

Arrays hold the components first: fluid (d, N_f), colloids (d, N_c), which are the particles of all
species in their order. Positions may leave the periodic box between two collisions; a pair keeps
the image that was nearest when it was found. Equations of tabatabaei-2009, 3.4: (3.42), (3.43) and
(3.49).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lammps_inputs.potentials.repulsive_mie import RepulsiveMie
from lammps_inputs.system import Array, Box, PairPotential, Solvent, System
from srd_driver.reference.faults import SimulationFault

Indices = NDArray[np.intp]

CORE = 0.5  # of sigma: no closer approach, 1.6e4 kBT of the 12-6 repulsion


@dataclass(frozen=True)
class Pairs:
    """Pairs that may come within a cutoff, the first minus the second being their separation.

    Attributes:
        first, second: particle numbers (pairs,).
        image: added to the separation (d, pairs) [a0].
    """

    first: Indices
    second: Indices
    image: Array

    def separations(self, first: Array, second: Array) -> Array:
        """(d, pairs) from positions (d, N) of both kinds."""
        return first[:, self.first] - second[:, self.second] + self.image

    def within(self, reach: float | Array, first: Array, second: Array) -> "Pairs":
        """Those closer than a reach, one for all or each its own."""
        separation = self.separations(first, second)
        near = (separation**2).sum(axis=0) < np.square(reach)
        return Pairs(self.first[near], self.second[near], self.image[:, near])


class ColloidForces:
    """Forces between species and fluid, among species, and of the walls on species.

    The pairs are found once per collision. A fluid particle is paired with every colloid that
    could come within the cutoff if neither moved further than an allowance: speed times tau_c,
    the speed being the present one plus a margin of one thermal speed. What is in no pair flies
    free and keeps its speed. The displacement of everything in a pair is checked at every force
    evaluation, and the pairs are found anew in time when an allowance is used up: no force is
    ever missed.
    """

    def __init__(self, system: System, solvent: Solvent) -> None:
        self._system = system
        self._box = system.box
        self._time = solvent.collision_time
        self._fluid_particles = solvent.particles
        self._fluid_margin = 1.0
        self._colloid_margin = 1 / np.sqrt(system.masses.min())
        names = [species.name for species in system.species]
        counts = [species.count for species in system.species]
        self._species = np.repeat(np.arange(len(names)), counts)  # of each colloid
        with_fluid = system.fluid_interactions()
        self._with_fluid = [
            (s, with_fluid[name]) for s, name in enumerate(names) if name in with_fluid
        ]
        self._fluid_cutoff = np.zeros(system.particles)
        for species, potential in self._with_fluid:
            self._fluid_cutoff[self._species == species] = potential.cutoff
        self._among = [
            (names.index(i.first), names.index(i.second), i.potential)
            for i in system.particle_interactions()
        ]
        self._longest_cutoff = max((p.cutoff for *_, p in self._among), default=0.0)

    def find_pairs(
        self,
        fluid_positions: Array,
        fluid_velocities: Array,
        colloid_positions: Array,
        colloid_velocities: Array,
    ) -> None:
        """Find the pairs that may interact before tau_c has passed."""
        time = self._time
        speed = _length(fluid_velocities) + self._fluid_margin
        colloid_speed = _length(colloid_velocities).max() + self._colloid_margin
        self._colloid_allowance = time * colloid_speed
        flight = time * (speed + colloid_speed)
        coupled = np.flatnonzero(self._fluid_cutoff)
        reach = self._fluid_cutoff.max() + flight.max()
        near = _columns_near(fluid_positions, colloid_positions, coupled, reach, self._box)
        self._fluid_pairs = near.within(
            self._fluid_cutoff[near.second] + flight[near.first], fluid_positions, colloid_positions
        )

        first, second = np.triu_indices(colloid_positions.shape[1], k=1)
        image = _image(colloid_positions[:, first] - colloid_positions[:, second], self._box)
        self._colloid_pairs = Pairs(first, second, image).within(
            self._longest_cutoff + 2 * self._colloid_allowance,
            colloid_positions,
            colloid_positions,
        )

        self._near = np.unique(self._fluid_pairs.first)
        self._near_allowance = time * speed[self._near]
        self._near_start = fluid_positions[:, self._near]
        self._colloid_start = colloid_positions.copy()

    def pairs_hold(self, fluid_positions: Array, colloid_positions: Array) -> bool:
        """Whether nothing has moved further than the pairs allow."""
        moved = _length(fluid_positions[:, self._near] - self._near_start)
        colloids_moved = _length(colloid_positions - self._colloid_start)
        return bool(
            (moved <= self._near_allowance).all()
            and (colloids_moved <= self._colloid_allowance).all()
        )

    def forces(self, fluid_positions: Array, colloid_positions: Array) -> tuple[Array, Array]:
        """Forces on the fluid (d, N_f) and on the colloids (d, N_c), drives left out (3.50).

        Raises:
            SimulationFault: for a particle deep in a colloid, or a colloid not between the walls.
        """
        dimensions, colloids = colloid_positions.shape
        on_fluid = np.zeros((dimensions, self._fluid_particles))
        on_colloids = np.zeros((dimensions, colloids))
        pairs = self._fluid_pairs
        separation = pairs.separations(fluid_positions, colloid_positions)
        for species, potential in self._with_fluid:
            own = self._species[pairs.second] == species
            force = self._force(pairs, separation, own, potential, "fluid particle")
            on_fluid += _sums(pairs.first[own], force, self._fluid_particles)
            on_colloids -= _sums(pairs.second[own], force, colloids)

        pairs = self._colloid_pairs
        separation = pairs.separations(colloid_positions, colloid_positions)
        for a, b, potential in self._among:
            own = self._between(pairs, a, b)
            if own.any():
                force = self._force(pairs, separation, own, potential, "colloid")
                on_colloids += _sums(pairs.first[own], force, colloids)
                on_colloids -= _sums(pairs.second[own], force, colloids)
        self._add_walls(colloid_positions, on_colloids)
        return on_fluid, on_colloids

    def energy(self, fluid_positions: Array, colloid_positions: Array) -> float:
        """Potential energy of everything that `forces` has [kBT]."""
        energy = 0.0
        pairs = self._fluid_pairs
        distance = _length(pairs.separations(fluid_positions, colloid_positions))
        for species, potential in self._with_fluid:
            energy += float(
                potential.energy(distance[self._species[pairs.second] == species]).sum()
            )
        pairs = self._colloid_pairs
        distance = _length(pairs.separations(colloid_positions, colloid_positions))
        for a, b, potential in self._among:
            energy += float(potential.energy(distance[self._between(pairs, a, b)]).sum())
        for wall in self._system.walls:
            for name, repulsion in wall.potentials:
                own = self._of(name)
                x, size = colloid_positions[wall.axis, own], self._box.sizes[wall.axis]
                energy += float(repulsion.energy(x if wall.side == "lower" else size - x).sum())
        return energy

    def _add_walls(self, colloid_positions: Array, on_colloids: Array) -> None:
        for axis, (size, periodic) in enumerate(
            zip(self._box.sizes, self._box.periodic, strict=True)
        ):
            x = colloid_positions[axis]
            outside = np.flatnonzero(~((x > 0) & (x < size)))
            if not periodic and outside.size:
                raise SimulationFault(
                    f"colloid {outside[0]} is at {'xyz'[axis]} = {x[outside[0]]}, through a wall: "
                    f"the time step {self._system.clock.time_step:g} is too long for its wall "
                    "potential, or the walls too weak"
                )
        for wall in self._system.walls:
            for name, potential in wall.potentials:
                own = self._of(name)
                x, size = colloid_positions[wall.axis, own], self._box.sizes[wall.axis]
                if wall.side == "lower":
                    on_colloids[wall.axis, own] += potential.force(x)
                else:
                    on_colloids[wall.axis, own] -= potential.force(size - x)

    def _of(self, name: str) -> NDArray[np.bool_]:
        """Which colloids are of a species."""
        names = [species.name for species in self._system.species]
        return np.asarray(self._species == names.index(name))

    def _between(self, pairs: Pairs, a: int, b: int) -> NDArray[np.bool_]:
        """Which pairs are of these two species."""
        first, second = self._species[pairs.first], self._species[pairs.second]
        return np.asarray(((first == a) & (second == b)) | ((first == b) & (second == a)))

    def _force(
        self,
        pairs: Pairs,
        separation: Array,
        own: NDArray[np.bool_],
        potential: PairPotential,
        kind: str,
    ) -> Array:
        """Forces (d, own pairs) on the first of each pair."""
        assert isinstance(potential, RepulsiveMie), "the engine's problems() has checked it"
        separation = separation[:, own]
        r_squared = (separation**2).sum(axis=0)
        deep = ~(r_squared > (CORE * potential.sigma) ** 2)  # true for NaN
        if deep.any():
            i = np.flatnonzero(deep)[0]
            raise SimulationFault(
                f"{kind} {pairs.first[own][i]} is {np.sqrt(r_squared[i]):.4g} from the centre of "
                f"colloid {pairs.second[own][i]}, inside its core: the time step "
                f"{self._system.clock.time_step:g} is too long"
            )
        return separation * potential.force_over_distance(r_squared)


def _length(vectors: Array) -> Array:
    """Lengths (N,) of vectors (d, N)."""
    return np.asarray(np.sqrt((vectors**2).sum(axis=0)))


def _sums(indices: Indices, forces: Array, count: int) -> Array:
    """Forces (d, pairs) summed for each particle (d, count)."""
    sums = np.empty((len(forces), count))
    for axis, force in enumerate(forces):
        sums[axis] = np.bincount(indices, weights=force, minlength=count)
    return sums


def _image(separation: Array, box: Box) -> Array:
    """What to add to separations (d, pairs) to make them those of the nearest images."""
    return np.asarray(box.nearest_image(separation.T).T - separation)


def _columns_near(fluid: Array, colloids: Array, coupled: Indices, reach: float, box: Box) -> Pairs:
    """Pairs of each coupled colloid with all the fluid in slabs of width a0 within reach in x."""
    columns = round(box.sizes[0])
    half = int(np.ceil(reach))
    of_fluid = np.floor(fluid[0]).astype(np.intp) % columns
    by_column = np.argsort(of_fluid, kind="stable")
    occupation = np.bincount(of_fluid, minlength=columns)
    start = np.cumsum(occupation) - occupation

    offsets = np.arange(min(2 * half + 1, columns)) - half
    near = (np.floor(colloids[0, coupled]).astype(np.intp)[:, None] + offsets) % columns
    counts = occupation[near].ravel()
    second = np.repeat(np.repeat(coupled, len(offsets)), counts)
    within = np.arange(len(second)) - np.repeat(np.cumsum(counts) - counts, counts)
    first = by_column[np.repeat(start[near].ravel(), counts) + within]
    return Pairs(first, second, _image(fluid[:, first] - colloids[:, second], box))

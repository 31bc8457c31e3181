"""The reference engine: MPC fluid, force-coupled colloids, one collision interval after another.

Equations of tabatabaei-2009, chapter 3. docs/reference.md states the order of operations and the
random numbers, exactly enough to write another engine that gives the same particles.
"""

from os import PathLike
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from lammps_inputs import InitialState, Scene, initial_state
from lammps_inputs.system import FLUID, Array
from srd_driver.reference import random_solvent, thermostats
from srd_driver.reference.collision import Cells, collide, grid_shape, grid_shift
from srd_driver.reference.colloids import ColloidForces
from srd_driver.reference.counter_random import CounterRandom
from srd_driver.reference.faults import SimulationFault
from srd_driver.reference.streaming import stream
from srd_driver.reference.walls import cut_cells, mean_with_virtual_particles


class ReferenceEngine:
    """A scene in motion, in numpy.

    Args:
        scene: what to simulate.
        state: where to start; by default the scene's own initial state.

    Attributes:
        scene: what is simulated.
        collisions: collisions done so far.
        colloid_images: box lengths to add to the wrapped colloid positions (N_c, d).

    Colloids are the particles of all species, in their order.
    """

    def __init__(self, scene: Scene, state: InitialState | None = None) -> None:
        system, solvent = scene.system, scene.system.solvent
        assert solvent is not None, "the engine's problems() has checked it"
        state = state or initial_state(system, scene.seed)
        self.scene = scene
        self.collisions = 0
        self._step = 0
        self._fluid_positions = np.array(state.fluid_positions.T, order="C")
        self._fluid_velocities = np.array(state.fluid_velocities.T, order="C")
        self._colloid_positions = np.array(state.colloid_positions.T, order="C")
        self._colloid_velocities = np.array(state.colloid_velocities.T, order="C")
        self.colloid_images = np.zeros((system.particles, system.box.dimensions), dtype=np.int64)

        self._system, self._solvent, self._box = system, solvent, system.box
        self._shape = grid_shape(self._box.sizes, self._box.periodic)
        self._width = self._box.sizes[1] if system.walls else None
        dimensions = self._box.dimensions
        self._field = np.zeros((dimensions, 1))
        for drive in system.drives_on(FLUID):
            self._field[:, 0] += drive.acceleration[:dimensions]
        self._masses = system.masses
        self._colloid_field = np.zeros((dimensions, system.particles))
        first = 0
        for species in system.species:
            for drive in system.drives_on(species.name):
                own = slice(first, first + species.count)
                self._colloid_field[:, own] += drive.acceleration[:dimensions, np.newaxis]
            first += species.count
        by_force = solvent.coupling == "force" and system.particles
        self._coupling = ColloidForces(system, solvent) if by_force else None

    @property
    def time(self) -> float:
        """Simulated time [t0]."""
        return self.collisions * self._solvent.collision_time

    @property
    def fluid_positions(self) -> Array:
        """(N_f, d) wrapped into the box, live [a0]."""
        return self._fluid_positions.T

    @property
    def fluid_velocities(self) -> Array:
        """(N_f, d) live [a0/t0]."""
        return self._fluid_velocities.T

    @property
    def colloid_positions(self) -> Array:
        """(N_c, d) wrapped into the box, live [a0]."""
        return self._colloid_positions.T

    @property
    def colloid_velocities(self) -> Array:
        """(N_c, d) live [a0/t0]."""
        return self._colloid_velocities.T

    def advance(self, collisions: int) -> None:
        """Simulate so many collision intervals, each motion for tau_c and then one collision.

        Raises:
            SimulationFault: naming the particle and the step, when the state is broken.
        """
        self._step = self.collisions * self._system.clock.steps_per_collision
        try:
            self._check()
            for _ in range(collisions):
                if self._coupling is None:
                    self._stream()
                else:
                    self._molecular_dynamics(self._coupling)
                self._wrap()
                self._check()
                self._collide()
                self.collisions += 1
        except SimulationFault as fault:
            raise SimulationFault(f"step {self._step}: {fault}") from None

    def mean_velocity(self) -> Array:
        """P_t / M_t of all particles (4.8, 4.9), shape (d,) [a0/t0]."""
        momentum = self._fluid_velocities.sum(axis=1)
        momentum = momentum + (self._masses * self._colloid_velocities).sum(axis=1)
        mean: Array = momentum / (self._fluid_velocities.shape[1] + self._masses.sum())
        return mean

    def averages(self) -> dict[str, float]:
        """What tables average, by column."""
        return {
            "fluid_temperature": self.fluid_temperature(),
            "mean_velocity_x": float(self.mean_velocity()[0]),
        }

    def fluid_temperature(self) -> float:
        """kBT of the fluid about its mean velocity in bins of half a cell along y [kBT].

        0 where each particle is alone in its bin: there is no motion about the mean then.
        """
        bins = np.floor(2 * self._fluid_positions[1]).astype(np.intp)
        occupation = np.bincount(bins)
        energy = 0.0
        for component in self._fluid_velocities:
            mean = np.bincount(bins, component) / np.maximum(occupation, 1)
            energy += float(np.sum((component - mean[bins]) ** 2))
        free = len(self._fluid_velocities) * (len(bins) - int(np.count_nonzero(occupation)))
        return energy / free if free else 0.0

    def energy(self) -> float:
        """Kinetic energy and the potential energy of the colloids' interactions [kBT]."""
        energy = 0.5 * float(np.sum(self._fluid_velocities**2))
        if self._coupling is not None:
            energy += 0.5 * float(np.sum(self._masses * self._colloid_velocities**2))
            self._find_pairs(self._coupling)
            energy += self._coupling.energy(self._fluid_positions, self._colloid_positions)
        return energy

    def save(self, file: str | PathLike[str]) -> None:
        """Write the state as npz; `load` continues from it bit for bit."""
        with open(file, "wb") as output:
            np.savez(output, collisions=self.collisions, **self._parts())

    def _parts(self) -> dict[str, Any]:
        """The arrays of the state."""
        return {
            "fluid_positions": self._fluid_positions,
            "fluid_velocities": self._fluid_velocities,
            "colloid_positions": self._colloid_positions,
            "colloid_velocities": self._colloid_velocities,
            "colloid_images": self.colloid_images,
        }

    @classmethod
    def load(cls, scene: Scene, file: str | PathLike[str]) -> Self:
        """The engine that `save` wrote, of the same scene."""
        with np.load(file) as saved:
            engine = cls(
                scene,
                InitialState(
                    saved["fluid_positions"].T,
                    saved["fluid_velocities"].T,
                    saved["colloid_positions"].T,
                    saved["colloid_velocities"].T,
                    saved["spins"].T if "spins" in saved else np.empty((0, 3)),
                ),
            )
            engine.collisions = int(saved["collisions"])
            engine.colloid_images = saved["colloid_images"]
        return engine

    def _find_pairs(self, coupling: ColloidForces) -> None:
        coupling.find_pairs(
            self._fluid_positions,
            self._fluid_velocities,
            self._colloid_positions,
            self._colloid_velocities,
        )

    def _stream(self) -> None:
        """Free flight of the fluid for tau_c (3.3)."""
        self._step += 1
        stream(
            self._fluid_positions,
            self._fluid_velocities,
            self._field,
            self._solvent.collision_time,
            self._width,
        )

    def _molecular_dynamics(self, coupling: ColloidForces) -> None:
        """Velocity Verlet of colloids and fluid through tau_c (3.45, 3.46, 3.51, 3.52)."""
        time = self._system.clock.time_step
        self._find_pairs(coupling)
        fluid, colloids = self._accelerations(coupling)
        for _ in range(self._system.clock.steps_per_collision):
            self._step += 1
            stream(self._fluid_positions, self._fluid_velocities, fluid, time, self._width)
            self._colloid_positions += time * (self._colloid_velocities + 0.5 * time * colloids)
            if not coupling.pairs_hold(self._fluid_positions, self._colloid_positions):
                self._find_pairs(coupling)
            old_fluid, old_colloids = fluid, colloids
            fluid, colloids = self._accelerations(coupling)
            # streaming, bounces included, has added the whole of the old acceleration
            self._fluid_velocities += 0.5 * time * (fluid - old_fluid)
            self._colloid_velocities += 0.5 * time * (old_colloids + colloids)

    def _accelerations(self, coupling: ColloidForces) -> tuple[Array, Array]:
        """Of the fluid (d, N_f) and of the colloids (d, N_c), drives included (3.50)."""
        on_fluid, on_colloids = coupling.forces(self._fluid_positions, self._colloid_positions)
        return on_fluid + self._field, on_colloids / self._masses + self._colloid_field

    def _wrap(self) -> None:
        """Bring everything back into the periodic box, and count the colloids' box lengths."""
        for axis, (size, periodic) in enumerate(
            zip(self._box.sizes, self._box.periodic, strict=True)
        ):
            if periodic:
                _wrap(self._fluid_positions[axis], size)
                self.colloid_images[:, axis] += _wrap(self._colloid_positions[axis], size)

    def _collide(self) -> None:
        """The collision, the thermostat and the random solvent, on one shifted grid."""
        solvent, velocities = self._solvent, self._fluid_velocities
        random = CounterRandom(self.scene.seed, self.collisions)
        if solvent.hydrodynamics == "bath":
            random_solvent.bath(velocities, random)
            return
        shift = grid_shift(random, self._box.dimensions)
        cells = Cells.sort(self._fluid_positions, shift, self._shape, self._box.periodic)
        if self._width is None:
            mean = cells.mean_velocity(velocities)
        else:
            cut = cut_cells(cells, shift, self._width)
            mean = mean_with_virtual_particles(velocities, cells, cut, solvent.density, random)
        collide(velocities, cells, mean, solvent.angle, solvent.rotation, random)

        if solvent.thermostat == "layer":
            thermostats.layer(velocities, cells)
        elif solvent.thermostat == "monte_carlo":
            thermostats.monte_carlo(velocities, cells, random)
        elif solvent.thermostat == "maxwell_boltzmann":
            thermostats.maxwell_boltzmann(velocities, cells, random)
        elif solvent.thermostat == "rescale":
            thermostats.rescale(velocities)
        elif solvent.thermostat == "andersen":
            thermostats.andersen(velocities, solvent.collision_time, random)
        if solvent.hydrodynamics == "shuffle":
            random_solvent.shuffle(velocities, random)

    def _check(self) -> None:
        """Stop at a particle that is nowhere, or a fluid particle not between the walls."""
        for kind, positions, velocities in (
            ("fluid particle", self._fluid_positions, self._fluid_velocities),
            ("colloid", self._colloid_positions, self._colloid_velocities),
        ):
            if not np.isfinite(positions.sum() + velocities.sum()):
                finite = np.isfinite(np.concatenate([positions, velocities])).all(axis=0)
                lost = np.flatnonzero(~finite)[0]
                raise SimulationFault(
                    f"{kind} {lost} has position {positions[:, lost]} and velocity "
                    f"{velocities[:, lost]}: not a number"
                )
        if self._width is not None:
            y = self._fluid_positions[1]
            if y.min() < 0 or y.max() > self._width:
                lost = np.flatnonzero((y < 0) | (y > self._width))[0]
                raise SimulationFault(
                    f"fluid particle {lost} is at y = {y[lost]}, beyond a wall (0 to {self._width})"
                )


def _wrap(coordinates: Array, size: float) -> NDArray[np.int64]:
    """Coordinates into [0, size) in place; the box lengths taken off each."""
    lengths = np.floor(coordinates / size)
    coordinates -= size * lengths
    coordinates[coordinates >= size] = 0.0  # a negative rounding error was rounded up to the size
    return lengths.astype(np.int64)

"""The reference engine of suspensions: spheres that reflect the fluid, or collide with it."""

from os import PathLike
from typing import Any, Self

import numpy as np

from lammps_inputs import InitialState, Scene, initial_state
from lammps_inputs.potentials.dlvo import Dlvo
from lammps_inputs.system import Array
from srd_driver.reference.boundaries import Boundaries
from srd_driver.reference.engine import ReferenceEngine
from srd_driver.reference.faults import SimulationFault
from srd_driver.reference.reflection import Spheres
from srd_driver.reference.sphere_forces import SphereForces
from srd_driver.reference.suspension import Suspension


class SuspensionEngine(ReferenceEngine):
    """A scene of one species of spheres in motion, in numpy; arguments as of `ReferenceEngine`."""

    def __init__(self, scene: Scene, state: InitialState | None = None) -> None:
        state = state or initial_state(scene.system, scene.seed)
        super().__init__(scene, state)
        system, solvent = self._system, self._solvent
        boundaries = Boundaries(
            self._box.sizes,
            self._box.periodic,
            {(wall.axis, wall.side == "upper"): wall.velocity for wall in system.walls},
            solvent.density,
        )
        self._spins = np.array(state.colloid_spins.T, order="C")
        (species,) = system.species
        potentials = [interaction.potential for interaction in system.interactions]
        between = [each for each in potentials if isinstance(each, Dlvo)]
        assert between == potentials, "problems() has checked it"
        self._suspension = Suspension(
            boundaries,
            scene.seed,
            solvent.collision_time,
            system.clock.steps_per_collision,
            self._fluid_positions,
            self._fluid_velocities,
            Spheres(
                *(self._colloid_positions, self._colloid_velocities, self._spins),
                *(system.radii, system.masses, system.inertias),
            ),
            "cell" if solvent.coupling == "cell" else "entry",
            self._colloid_field[:, :1].copy(),
            any(drive.balanced for drive in system.drives),
            SphereForces(
                boundaries,
                system.clock.time_step,
                between[0] if between else None,
                system.walls,
                species.name,
            ),
            solvent.angle,
            solvent.rotation,
            solvent.thermostat,
            solvent.drift_interval,
        )

    def advance(self, collisions: int) -> None:
        """Simulate so many collision intervals.

        Raises:
            SimulationFault: naming the particle and the step, when the state is broken.
        """
        for _ in range(collisions):
            self._step = (self.collisions + 1) * self._system.clock.steps_per_collision
            try:
                self._suspension.advance()
                self._wrap()
                self._check()
            except SimulationFault as fault:
                raise SimulationFault(f"step {self._step}: {fault}") from None
            self.collisions += 1

    @property
    def colloid_spins(self) -> Array:
        """Angular velocities (N, 3) [1/t0]."""
        return self._spins.T

    def averages(self) -> dict[str, float]:
        """What tables average, by column."""
        fluid, mean = self._fluid_velocities.mean(axis=1), self.mean_velocity()
        rotation = (self._system.inertias * self._spins**2).mean()
        moved = self._fluid_velocities - fluid[:, None]
        second, third, fourth = ((moved**power).mean(axis=1) for power in (2, 3, 4))
        skewness, kurtosis = third / second**1.5, fourth / second**2 - 3
        taken, interval = self._suspension.boundaries.taken, self._solvent.collision_time
        nothing = np.zeros(3)
        lower, upper = (taken.get((2, side), nothing) / interval for side in (False, True))
        return super().averages() | {
            "mean_velocity_z": float(mean[2]),
            "fluid_velocity_x": float(fluid[0]),
            "fluid_velocity_z": float(fluid[2]),
            "rotational_temperature": float(rotation),
            **{f"fluid_skewness_{axis}": float(skewness[k]) for k, axis in enumerate("xyz")},
            **{f"fluid_kurtosis_{axis}": float(kurtosis[k]) for k, axis in enumerate("xyz")},
            "lower_wall_force_x": float(lower[0]),
            "upper_wall_force_x": float(upper[0]),
        }

    def _parts(self) -> dict[str, Any]:
        forces, torques = self._suspension.pull
        return super()._parts() | {"spins": self._spins, "forces": forces, "torques": torques}

    @classmethod
    def load(cls, scene: Scene, file: str | PathLike[str]) -> Self:
        """The engine that `save` wrote, of the same scene."""
        engine = super().load(scene, file)
        with np.load(file) as saved:
            engine._suspension.collisions = engine.collisions
            engine._suspension.pull = saved["forces"], saved["torques"]
        return engine

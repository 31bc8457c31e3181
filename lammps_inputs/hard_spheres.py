"""What the scenes of hard spheres have in common."""

import math
from collections.abc import Iterator
from typing import Annotated

from pydantic import Field

from lammps_inputs.close_packing import sphere_volume
from lammps_inputs.scene import NonNegative, Positive, Scene
from lammps_inputs.system import Clock, Species

DIAMETER = 1.0  # the unit of length a0
LOOK = 0.1  # between two looks at the colours: velocities decorrelate in about that time [t0]
DENSEST = math.pi / math.sqrt(18)  # packing fraction of the closest packing

Probability = Annotated[float, Field(gt=0, le=1)]


class HardSphereScene(Scene):
    """Spheres of diameter and mass 1 at kBT = 1, with reacting colours."""

    particles: Annotated[int, Field(ge=1, le=10**7)] = Field(default=1000, description="spheres N")
    packing_fraction: Annotated[float, Field(gt=0, lt=DENSEST)] = Field(
        default=0.35, description="volume of the spheres over that of the box"
    )
    reaction_probabilities: tuple[Probability, ...] = Field(
        default=(0.01, 0.1, 1.0), min_length=1, max_length=20, description="p_r, a list"
    )
    trajectory: bool = Field(
        default=False, description="write the positions too, at every output (1: yes)"
    )
    sampling_interval: Positive = Field(default=20.0, description="time between two outputs [t0]")
    duration: Positive = Field(default=4000.0, description="time after equilibration [t0]")
    equilibration: NonNegative = Field(default=200.0, description="time left out [t0]")

    @property
    def volume(self) -> float:
        """Volume that the packing fraction refers to [a0^3]."""
        return self.particles * sphere_volume(DIAMETER, 3) / self.packing_fraction

    def species(self) -> Species:
        """The spheres."""
        return Species("spheres", self.particles, mass=1.0, radius=DIAMETER / 2)

    def clock(self) -> Clock:
        """An engine step is a look."""
        sample = max(2, round(self.sampling_interval / LOOK))
        time = (self.equilibration + self.duration) / LOOK
        return Clock(
            time_step=LOOK,
            steps_per_collision=1,
            sample_steps=sample,
            look_steps=1,
            equilibration_steps=round(self.equilibration / LOOK),
            total_steps=max(1, math.ceil(time / sample - 1e-9)) * sample,
        )

    def problems(self) -> Iterator[str]:
        given = self.reaction_probabilities
        if len(set(given)) < len(given):
            yield f"reaction_probabilities = {list(given)!r}: one stands there twice"
        if self.sampling_interval < 2 * LOOK:
            yield f"sampling_interval = {self.sampling_interval!r}: at least {2 * LOOK:g}"
        if self.duration < self.sampling_interval:
            yield (
                f"duration = {self.duration!r}: at least the sampling_interval, "
                f"{self.sampling_interval!r}"
            )
        yield from self.fit_problems()

    def fit_problems(self) -> Iterator[str]:
        """Where the spheres do not fit; asked of the placement itself."""
        system = self.system
        try:
            assert system.placement is not None
            system.placement.positions(system.box, system.species, self.seed)
        except ValueError as error:
            yield f"packing_fraction = {self.packing_fraction!r}: {error}"

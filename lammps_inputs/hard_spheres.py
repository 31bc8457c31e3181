"""What the scenes of hard spheres have in common, and of soft ones in their place."""

import math
from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field

from lammps_inputs.close_packing import sphere_volume
from lammps_inputs.potentials.pseudo_hard import PseudoHard
from lammps_inputs.potentials.repulsive_mie import RepulsiveMie
from lammps_inputs.scene import NonNegative, Positive, Scene
from lammps_inputs.system import (
    TRAJECTORY,
    Clock,
    Events,
    Interaction,
    Isokinetic,
    Motion,
    Output,
    Species,
)

DIAMETER = 1.0  # the unit of length a0
LOOK = 0.1  # between two looks at the colours: velocities decorrelate in about that time [t0]
LOOK_STEPS = 100  # between two looks at soft spheres, at most
FRAME = 1.0  # between two frames, at most, for colours to be laid on the paths of soft spheres [t0]
SPHERES = "spheres"
SOFT_AVERAGES = Output("observables.dat", "table", ("temperature", "potential_energy", "pressure"))
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
    spheres: Literal["hard", "pseudo_hard", "wca"] = Field(
        default="hard",
        description="hard; or soft, with paths only: pseudo_hard, the 50-49 repulsion of Jover et "
        "al., or wca, the 12-6 repulsion",
    )
    time_step: Annotated[float, Field(gt=0, le=0.01)] = Field(
        default=0.001, description="of soft spheres [t0]"
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
        return Species(SPHERES, self.particles, mass=1.0, radius=DIAMETER / 2)

    @property
    def soft(self) -> bool:
        """Whether they move by forces, not from event to event."""
        return self.spheres != "hard"

    def interactions(self) -> tuple[Interaction, ...]:
        """The potential of soft spheres."""
        if not self.soft:
            return ()
        potential = PseudoHard() if self.spheres == "pseudo_hard" else RepulsiveMie(DIAMETER, 6)
        return (Interaction(SPHERES, SPHERES, potential),)

    def motion(self) -> Motion:
        """Soft spheres keep kBT = 1 by Gauss's thermostat, as hard ones do by having no energy."""
        return Isokinetic(1.0) if self.soft else Events()

    def written(self, *outputs: Output) -> tuple[Output, ...]:
        """The trajectory, which soft spheres need, and what hard ones write besides."""
        if self.soft:
            return (TRAJECTORY, SOFT_AVERAGES)
        return (TRAJECTORY, *outputs) if self.trajectory else outputs

    def measured(self) -> tuple[str, ...]:
        """Of the paths where colours cannot react, or of the colours."""
        if self.soft:
            return (
                "path_diffusivity",
                "middle_displacement",
                "self_diffusion",
                "particle_averages",
            )
        of_paths = ("middle_displacement", "self_diffusion") if self.trajectory else ()
        return ("color_diffusivity", "reacted_speeds", "hard_sphere_averages", *of_paths)

    def clock(self) -> Clock:
        """An engine step is a look; of soft spheres, a time step."""
        if self.soft:
            return self._fine_clock()
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

    def _fine_clock(self) -> Clock:
        steps = max(2, round(self.sampling_interval / self.time_step))
        longest = min(LOOK_STEPS, steps // 2)
        outputs = (self.equilibration + self.duration) / self.time_step / steps
        return Clock(
            time_step=self.time_step,
            steps_per_collision=1,
            sample_steps=steps,
            look_steps=next(look for look in range(longest, 0, -1) if steps % look == 0),
            equilibration_steps=round(self.equilibration / self.time_step),
            total_steps=max(1, math.ceil(outputs - 1e-9)) * steps,
        )

    def problems(self) -> Iterator[str]:
        if self.soft and self.sampling_interval > FRAME:
            yield (
                f"sampling_interval = {self.sampling_interval!r}: too long to lay colours on the "
                f"paths of soft spheres; must be at most {FRAME:g}, 0.2 is good"
            )
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

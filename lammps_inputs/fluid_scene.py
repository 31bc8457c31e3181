"""What scenes with an MPC fluid have in common."""

import math
from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property
from typing import Annotated

from pydantic import Field

from lammps_inputs.limits import solvent_warnings
from lammps_inputs.scene import NonNegative, Positive, Scene
from lammps_inputs.system import (
    FLOW,
    SIZES,
    Box,
    Clock,
    FlowField,
    Hydrodynamics,
    Precision,
    Rotation,
    Solvent,
    System,
    Thermostat,
)

MOST_BINS = 1_000_000  # of a flow field: some 60 bytes each in every output


class FluidScene(Scene):
    """The fields of a box of fluid, and what is refused of them."""

    length: Positive = Field(description="box length along the periodic x axis [a0]")
    width: Positive = Field(description="box width along y [a0]")
    density: Annotated[float, Field(gt=0, le=1000)] = Field(
        default=10.0, description="fluid particles per collision cell n_f [1/a0^d]"
    )
    collision_time: Positive = Field(description="time between two collisions tau_c [t0]")
    angle: Annotated[float, Field(gt=0, le=180)] = Field(
        default=90.0, description="rotation angle alpha of the collision [degrees]"
    )
    hydrodynamics: Hydrodynamics = Field(
        default="on",
        description="on; or a random solvent: shuffle (velocities interchanged), bath (redrawn)",
    )
    thermostat: Thermostat = Field(default="layer", description="thermostat of the fluid")
    precision: Precision = Field(
        default="double", description="of the fluid's positions and velocities: double or single"
    )
    flow_interval: NonNegative = Field(
        default=0.0, description="time that each flow field is averaged over; 0: none [t0]"
    )
    flow_bin: Positive = Field(default=0.5, description="edge of the bins of the flow field [a0]")
    flow_around: Annotated[int, Field(ge=0)] = Field(
        default=0, description="number of the colloid that the flow field is about; 0: none"
    )

    def clock(self, md_steps: int = 1) -> Clock:
        """The clock of the scene's times, by so many steps of molecular dynamics a collision."""
        return Clock.of_times(
            beat=self.collision_time,
            sampling_interval=self.sampling_interval,
            equilibration=self.equilibration,
            duration=self.duration,
            steps_per_beat=md_steps,
        )

    def solvent(
        self, volume: float, rotation: Rotation = "coordinate_axes", shear_wave: float = 0.0
    ) -> Solvent:
        """The fluid of the scene, in a volume [a0^d]."""
        return Solvent(
            particles=round(self.density * volume),
            density=self.density,
            collision_time=self.collision_time,
            angle=self.angle,
            rotation=rotation,
            hydrodynamics=self.hydrodynamics,
            thermostat=self.thermostat,
            shear_wave=shear_wave,
            precision=self.precision,
        )

    @cached_property
    def system(self) -> System:
        """What the scene builds, and the flow field that is wanted of its fluid."""
        system = self.build()
        if not self.flow_interval:
            return system
        samples = max(1, round(self.flow_interval / self.sampling_interval))
        bins = tuple(max(1, round(size / self.flow_bin)) for size in system.box.sizes)
        return replace(
            system,
            flow=FlowField(bins, samples, self.flow_around),
            outputs=(*system.outputs, FLOW),
            measures=(*system.measures, "flow_field"),
        )

    def problems(self) -> Iterator[str]:
        yield from super().problems()
        system: System = self.system
        yield from self._flow_problems(system)
        yield from _box_problems(system.box)
        fluid = system.solvent
        if fluid and fluid.particles < 2:
            yield f"density = {self.density!r}: leaves {fluid.particles} fluid particles"

    def _flow_problems(self, system: System) -> Iterator[str]:
        if self.flow_around > system.particles:
            most = system.particles
            yield f"flow_around = {self.flow_around!r}: must be at most {most}, the last colloid"
        if system.flow and math.prod(system.flow.bins) > MOST_BINS:
            yield f"flow_bin = {self.flow_bin!r}: makes more than {MOST_BINS} bins"
        clock = system.clock
        if system.flow:
            every = system.flow.samples * clock.sample_steps
            first = math.ceil(clock.equilibration_steps / every)
            if clock.total_steps // every <= first:
                yield (
                    f"flow_interval = {self.flow_interval!r}: no whole average of the run's "
                    f"{clock.end:g} t0 begins after its equilibration of {self.equilibration:g}"
                )

    def warnings(self) -> Iterator[str]:
        yield from super().warnings()
        if self.system.solvent:
            yield from solvent_warnings(self.system.solvent, self.system.box)


def _box_problems(box: Box) -> Iterator[str]:
    for name, size, periodic in zip(SIZES, box.sizes, box.periodic, strict=False):
        if periodic and size != round(size):
            yield (
                f"{name} = {size!r}: a periodic length must be a whole number of "
                "collision cells (a0 = 1)"
            )
        if size < 2:
            yield f"{name} = {size!r}: at least 2 collision cells are needed"

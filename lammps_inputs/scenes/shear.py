"""Soft particles in a homogeneous shear flow (delhommelle-2005, V)."""

from collections.abc import Iterator
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from lammps_inputs.scene import NonNegative, Positive
from lammps_inputs.soft_scene import SoftScene
from lammps_inputs.system import (
    TRAJECTORY,
    Configurational,
    Interaction,
    Isokinetic,
    Output,
    Species,
    System,
)

STRAIN = 0.05  # of the box in a step, at most
SUDDEN = {"kinetic": 20.0, "configurational": 4.0}  # rates that runs of 1000 spheres have outlived


class Shear(SoftScene):
    """One species under SLLOD shear, v_x = rate y, in a box with Lees-Edwards boundaries.

    Spheres of Weeks, Chandler and Andersen in 3D, soft disks in 2D, at rest before the shear; units
    are sigma, epsilon and the mass of a particle.
    """

    name: ClassVar[str] = "shear"
    paper: ClassVar[str] = "delhommelle-2005"

    dimension: Literal[2, 3] = Field(
        default=3, description="2: soft disks, (sigma/r)^12; 3: Weeks-Chandler-Andersen spheres"
    )
    rate: Annotated[float, Field(gt=0, le=100)] = Field(
        default=1.0, description="shear rate dv_x/dy [1/t0]"
    )
    thermostat: Literal["kinetic", "configurational"] = Field(
        default="kinetic",
        description="kinetic energy relative to the flow fixed, or the configurational temperature",
    )
    sampling_interval: Positive = Field(
        default=1.0, description="time between two outputs, at least two steps [t0]"
    )
    duration: Positive = Field(default=100.0, description="time after equilibration [t0]")
    equilibration: NonNegative = Field(default=50.0, description="time left out [t0]")

    def build(self) -> System:
        motion: Isokinetic | Configurational
        if self.thermostat == "kinetic":
            motion = Isokinetic(self.set_temperature, shear_rate=self.rate)
            thermostat = "thermostat_friction"
        else:
            motion = Configurational(self.set_temperature, self.damping, self.rate)
            thermostat = "thermostat_multiplier"
        averages = (
            "kinetic_temperature",
            "potential_energy",
            "pressure",
            "pressure_xy",
            "force_squares",
            "laplacians",
            thermostat,
        )
        return System(
            box=self.box(),
            clock=self.clock(),
            species=(Species("particles", self.number, 1.0, 0.5),),
            placement=self.placement(),
            interactions=(Interaction("particles", "particles", self.potential),),
            motion=motion,
            rest=self.resting(),
            outputs=(
                TRAJECTORY,
                Output("observables.dat", "table", averages),
            ),
            measures=("soft_averages", "shear_viscosity", "density_fluctuations", "snapshot"),
        )

    def problems(self) -> Iterator[str]:
        yield from super().problems()
        if self.rate * self.time_step > STRAIN:
            yield (
                f"time_step = {self.time_step!r}: too long for a rate of {self.rate!r}; must be at "
                f"most {STRAIN / self.rate:.2g}"
            )
        if self.thermostat == "configurational" and self.begins_anew and not self.resting():
            yield (
                f"rest = {self.rest!r}: the configurational thermostat runs away from a lattice; "
                "let it melt at rest first, for about 20"
            )

    def warnings(self) -> Iterator[str]:
        yield from super().warnings()
        largest = SUDDEN[self.thermostat]
        if self.rate > largest and self.begins_anew:
            yield (
                f"rate = {self.rate!r}: the flow begins at once, and heats the particles faster "
                f"than the {self.thermostat} thermostat cools them; above {largest:g} runs have "
                "stopped, with steps down to 0.0001: go up a ladder of rates by `start`"
            )

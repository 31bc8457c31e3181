"""Two colours of particles in a field that drives them oppositely (delhommelle-2005)."""

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, ClassVar

from pydantic import Field

from lammps_inputs.placement import LastFrame
from lammps_inputs.scene import Positive
from lammps_inputs.soft_scene import SoftScene, Thermostat
from lammps_inputs.system import (
    TRAJECTORY,
    Configurational,
    DissipativePairs,
    Drive,
    Interaction,
    Isokinetic,
    Langevin,
    Output,
    Placement,
    Rest,
    Species,
    System,
    Thermostatted,
)

STARTS = ("crystal", "random")
TURN = 0.25  # of the velocities by the field in half a step, at most
KICK = 0.005  # of the field in a step, from which on a configurational run is likely to stop
LARGEST_SEED = 900_000_000  # of LAMMPS's noise


class Lanes(SoftScene):
    """A binary mixture in a colour field: half of the particles are driven along x, half against.

    Soft disks in 2D, Weeks-Chandler-Andersen spheres in 3D, at rest before the field, colours at
    random; units are sigma, epsilon and the mass of a particle.
    """

    name: ClassVar[str] = "lanes"
    paper: ClassVar[str] = "delhommelle-2005"

    field: Annotated[float, Field(ge=0, le=1000)] = Field(
        default=1.0, description="force on each particle, along x or against it [epsilon/sigma]"
    )
    thermostat: Thermostat = Field(
        default="kinetic",
        description="kinetic energy fixed, all or of one direction; configurational temperature "
        "fixed; langevin; dpd",
    )
    friction: Positive = Field(default=1.0, description="of langevin and dpd [1/t0]")
    dpd_cutoff: Positive = Field(default=1.5, description="range of the dpd friction [sigma]")
    start: str = Field(
        default="crystal",
        description="crystal, random, or the directory of a run that has gone before",
    )

    @property
    def motion(self) -> Thermostatted:
        """The thermostat."""
        temperature = self.set_temperature
        match self.thermostat:
            case "kinetic":
                return Isokinetic(temperature)
            case "kinetic_x":
                return Isokinetic(temperature, "x")
            case "kinetic_y":
                return Isokinetic(temperature, "y")
            case "configurational":
                return Configurational(temperature, self.damping)
            case "langevin":
                return Langevin(temperature, self.friction)
            case "dpd":
                return DissipativePairs(temperature, self.friction, self.dpd_cutoff)

    def placement(self, start: str) -> Placement:
        if start in STARTS:
            return super().placement(start)
        return LastFrame(str(Path(start) / TRAJECTORY.file))

    def resting(self) -> Rest | None:
        return super().resting() if self.start in STARTS else None

    def build(self) -> System:
        half = self.number // 2
        pairs = (("plus", "plus"), ("plus", "minus"), ("minus", "minus"))
        exact = {"kinetic_x", "kinetic_y", "kinetic"}
        thermostat = ("thermostat_friction",) if self.thermostat in exact else ()
        if self.thermostat == "configurational":
            thermostat = ("thermostat_multiplier",)
        averages = ("kinetic_temperature", "potential_energy", "pressure", "current")
        flat = ("bond_order",) if self.dimension == 2 else ()
        return System(
            box=self.box(),
            clock=self.clock(),
            species=(Species("plus", half, 1.0, 0.5), Species("minus", half, 1.0, 0.5)),
            placement=self.placement(self.start),
            interactions=tuple(Interaction(*pair, self.potential) for pair in pairs),
            drives=(
                Drive("plus", self.field, (1, 0, 0), variable="field"),
                Drive("minus", self.field, (-1, 0, 0), variable="field"),
            ),
            motion=self.motion,
            rest=self.resting(),
            outputs=(
                TRAJECTORY,
                Output(
                    "observables.dat",
                    "table",
                    (*averages, "force_squares", "laplacians", *thermostat),
                ),
            ),
            measures=(
                "soft_averages",
                "lane_order",
                *flat,
                "stream_temperature",
                "colour_flow",
                "density_fluctuations",
                "snapshot",
            ),
        )

    def problems(self) -> Iterator[str]:
        yield from super().problems()
        if self.number % 2:
            yield f"particles = {self.number!r}: must be even, half of each colour"
        turn = self.field * self.time_step / 2 / math.sqrt(self.dimension * self.set_temperature)
        if turn > TURN:
            yield (
                f"time_step = {self.time_step!r}: too long for a field of {self.field!r}, which "
                f"turns the velocities by {turn:.2g} in half a step; must be at most "
                f"{self.time_step * TURN / turn:.2g}"
            )
        if self.thermostat == "configurational" and self.start in STARTS and not self.resting():
            yield (
                f"rest = {self.rest!r}: the configurational thermostat runs away from a lattice; "
                "let it melt at rest first, for about 20"
            )
        if self.thermostat in ("langevin", "dpd") and self.seed > LARGEST_SEED:
            yield f"seed = {self.seed!r}: must be at most {LARGEST_SEED} for noise"
        if self.thermostat == "dpd" and self.dpd_cutoff > min(self.box().sizes) / 2:
            yield f"dpd_cutoff = {self.dpd_cutoff!r}: must be at most half of the box"

    def warnings(self) -> Iterator[str]:
        yield from super().warnings()
        if self.thermostat == "configurational" and self.field * self.time_step > KICK:
            yield (
                f"time_step = {self.time_step!r}: long for a field of {self.field!r} under the "
                "configurational thermostat, which does not limit the speed of particles; such "
                f"runs often stop, use {KICK / self.field:.1g}"
            )

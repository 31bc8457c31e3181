"""Gravity-driven flow of the pure fluid between walls (tabatabaei-2009, 3.2.6)."""

from collections.abc import Iterator
from typing import ClassVar

from pydantic import Field

from lammps_inputs.fluid_scene import FluidScene
from lammps_inputs.limits import SOUND
from lammps_inputs.scene import NonNegative, Positive
from lammps_inputs.system import FLUID, FLUID_AVERAGES, FLUID_PROFILE, Box, Drive, System, slit
from lammps_inputs.viscosity import viscosity

HEAT = 0.55  # temperature that friction adds, over the square of the speed on the mid-line
WARM = 0.02  # of the temperature: what is worth a word
REYNOLDS = 2600.0  # by half the width, above which waves live in a plane channel flow


class Poiseuille(FluidScene):
    """A 2D slit of pure fluid, periodic along x, gravity on the fluid; defaults of Fig. 3.6."""

    name: ClassVar[str] = "poiseuille"
    paper: ClassVar[str] = "tabatabaei-2009"

    length: Positive = Field(default=25.0, description="channel length along x [a0]")
    width: Positive = Field(default=25.0, description="distance between the walls [a0]")
    collision_time: Positive = Field(default=0.1, description="collision time tau_c [t0]")
    gravity: float = Field(default=0.001, description="acceleration of the fluid along x [a0/t0^2]")
    duration: Positive = Field(default=4000.0, description="time after equilibration [t0]")
    equilibration: NonNegative = Field(default=400.0, description="time left out [t0]")

    @property
    def expected_speed(self) -> float:
        """Mean over the slit, |g| L_y^2 / (12 nu), 2/3 of that on the mid-line (3.15) [a0/t0]."""
        nu = viscosity(self.density, self.collision_time, self.angle)
        return abs(self.gravity) * self.width**2 / (12 * nu)

    def build(self) -> System:
        return System(
            box=Box((self.length, self.width), periodic=(True, False)),
            clock=self.clock(),
            walls=slit(axis=1),
            drives=(Drive(FLUID, self.gravity),),
            solvent=self.solvent(self.length * self.width),
            outputs=(FLUID_PROFILE, FLUID_AVERAGES),
            measures=("fluid_temperature", "parabolic_flow"),
        )

    def problems(self) -> Iterator[str]:
        yield from super().problems()
        if self.hydrodynamics == "on" and self.expected_speed > SOUND:
            largest = abs(self.gravity) * SOUND / self.expected_speed
            yield (
                f"gravity = {self.gravity!r}: the fluid would flow at about "
                f"{self.expected_speed:.2g}, faster than its sound ({SOUND:g}); must be between "
                f"{-largest:.2g} and {largest:.2g}"
            )

    def warnings(self) -> Iterator[str]:
        yield from super().warnings()
        if self.hydrodynamics != "on":
            return
        fastest = 1.5 * self.expected_speed  # on the mid-line
        if fastest > SOUND:
            yield (
                f"gravity = {self.gravity!r}: on the mid-line the fluid would flow at about "
                f"{fastest:.2g}, faster than its sound ({SOUND:g})"
            )
        heat = HEAT * fastest**2
        if self.thermostat == "none" and heat > WARM:
            yield (
                f"gravity = {self.gravity!r}, thermostat = 'none': friction heats the fluid by "
                f"about {heat:.0%}; the viscosity is then another"
            )
        nu = viscosity(self.density, self.collision_time, self.angle)
        reynolds = fastest * self.width / 2 / nu
        if reynolds > REYNOLDS:
            yield (
                f"gravity = {self.gravity!r}: the Reynolds number of {reynolds:.2g} is above "
                f"{REYNOLDS:g}, where the flow need not be laminar"
            )

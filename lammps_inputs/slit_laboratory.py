"""A particle in a slit of liquid, and the 2D scene that keeps its Peclet number.

Lengths are scaled so that the colloid has the radius of the scene, and times so that it diffuses as
in the laboratory. The scene is two-dimensional and its colloid as heavy as the fluid it displaces:
forces are kept, over kBT / R, masses are not.
"""

import math
from typing import Annotated

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field

from lammps_inputs.comparison import WATER_MOLECULE, WATER_SELF_DIFFUSION, WATER_SOUND, Row
from lammps_inputs.limits import SOUND
from lammps_inputs.material import Suspension
from lammps_inputs.quantities import si


def _quantity(unit: str) -> BeforeValidator:
    return BeforeValidator(lambda value: si(value, unit))


class SlitLaboratory(BaseModel):
    """A liquid, a particle and a channel, in SI; defaults are a sphere of 1 um in water."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    particle_radius: Annotated[float, _quantity("m"), Field(gt=0)] = 1e-6
    channel_length: Annotated[float, _quantity("m"), Field(gt=0)] = 20e-6
    channel_width: Annotated[float, _quantity("m"), Field(gt=0)] = 5e-6
    temperature: Annotated[float, _quantity("K"), Field(gt=0)] = 300.0
    particle_density: Annotated[float, _quantity("kg/m^3"), Field(gt=0)] = 1050.0
    fluid_density: Annotated[float, _quantity("kg/m^3"), Field(gt=0)] = 1000.0
    viscosity: Annotated[float, _quantity("m^2/s"), Field(gt=0)] = 1e-6
    acceleration: Annotated[float, _quantity("m/s^2"), Field(ge=0)] = 9.81

    @property
    def suspension(self) -> Suspension:
        """The particle in its liquid."""
        return Suspension(
            radius=self.particle_radius,
            temperature=self.temperature,
            particle_density=self.particle_density,
            fluid_density=self.fluid_density,
            viscosity=self.viscosity,
            gravity=self.acceleration,
        )

    @property
    def peclet(self) -> float:
        """Pull times radius over kBT (21), buoyancy taken off."""
        return self.suspension.time_scales().peclet

    def time_unit(self, radius: float, mobility: float) -> float:
        """t0 such that a colloid diffuses by its diameter in the time of the laboratory [s].

        Args:
            radius: of the scene's colloid [a0].
            mobility: its speed over the force on it, which is D / kBT [t0/m_f].
        """
        return self.suspension.time_scales().diffusion / (2 * radius**2 / mobility)

    def rows(
        self,
        radius: float,
        mobility: float,
        viscosity: float,
        gravity: float,
        flight: float,
        self_diffusion: float,
    ) -> tuple[Row, ...]:
        """The table, of a scene with these numbers in reduced units.

        Args:
            radius, mobility: as in `time_unit`.
            viscosity: kinematic [a0^2/t0].
            gravity: force on a colloid [kBT/a0].
            flight: mean free path of the fluid [a0].
            self_diffusion: of its particles [a0^2/t0].
        """
        real, times = self.suspension, self.suspension.time_scales()
        unit, edge = self.time_unit(radius, mobility), self.particle_radius / radius
        speed = mobility * gravity
        settling = 2 * radius / speed * unit if speed else math.inf
        fluid = 2 * radius**2 / viscosity * unit
        nu = viscosity * edge**2 / unit
        return (
            Row("radius", "R", "m", self.particle_radius, radius * edge),
            Row("kinematic viscosity", "nu", "m^2/s", self.viscosity, nu),
            Row("diffusion", "tau_D", "s", times.diffusion, 2 * radius**2 / mobility * unit),
            Row("settling", "tau_S", "s", times.settling, settling),
            Row("momentum in the fluid", "tau_F", "s", times.fluid, fluid),
            Row("Peclet number (21)", "Pe", "", times.peclet, gravity * radius),
            Row("Reynolds number (25)", "Re", "", times.reynolds, fluid / settling),
            Row(
                "Schmidt number of a colloid",
                "nu / D",
                "",
                self.viscosity / real.diffusion_coefficient,
                viscosity / mobility,
            ),
            Row(
                "Schmidt number of water",
                "Sc",
                "",
                self.viscosity / WATER_SELF_DIFFUSION,
                viscosity / self_diffusion,
            ),
            Row("Mach number", "Ma", "", real.stokes_velocity / WATER_SOUND, speed / SOUND),
            Row("Knudsen number", "Kn", "", WATER_MOLECULE / self.particle_radius, flight / radius),
        )

"""Gravity-driven flow of the pure fluid between walls (tabatabaei-2009, 3.2.6)."""

from typing import ClassVar

from pydantic import Field

from lammps_inputs.scene import FluidScene, NonNegative, Positive


class Poiseuille(FluidScene):
    """A 2D slit of pure fluid, periodic along x, gravity on the fluid; defaults of Fig. 3.6."""

    name: ClassVar[str] = "poiseuille"
    walls: ClassVar[bool] = True
    colloids: ClassVar[int] = 0

    length: Positive = Field(default=25.0, description="channel length along x [a0]")
    width: Positive = Field(default=25.0, description="distance between the walls [a0]")
    collision_time: Positive = Field(default=0.1, description="collision time tau_c [t0]")
    gravity: float = Field(default=0.001, description="acceleration of the fluid along x [a0/t0^2]")
    duration: Positive = Field(default=4000.0, description="time after equilibration [t0]")
    equilibration: NonNegative = Field(default=400.0, description="time left out [t0]")

    @property
    def fluid_gravity(self) -> float:
        """Acceleration of the fluid along x [a0/t0^2]."""
        return self.gravity

"""Spheres that sediment in a periodic box of fluid, in three dimensions."""

import math
from typing import ClassVar

from pydantic import Field

from lammps_inputs.fluid_scene import FluidScene
from lammps_inputs.placement import Lattice
from lammps_inputs.potentials.repulsive_mie import RepulsiveMie
from lammps_inputs.scene import NonNegative, Positive
from lammps_inputs.system import (
    FLUID,
    FLUID_AVERAGES,
    FLUID_PROFILE,
    TRAJECTORY,
    Box,
    Drive,
    Interaction,
    Species,
    System,
)


class SedimentingSpheres(FluidScene):
    """Spheres pulled down along z in a periodic box of fluid."""

    name: ClassVar[str] = "sedimenting_spheres"

    length: Positive = Field(default=10.0, description="box along x [a0]")
    width: Positive = Field(default=9.0, description="box along y [a0]")
    height: Positive = Field(default=11.0, description="box along z [a0]")
    spheres: int = Field(default=4, ge=1, description="number of spheres")
    density: float = Field(default=4.0, gt=0, description="fluid particles in a cell [1/a0^3]")
    collision_time: Positive = Field(default=0.04, description="collision time [t0]")
    gravity: float = Field(default=0.2, description="acceleration of the spheres down z [a0/t0^2]")
    sampling_interval: Positive = Field(default=0.2, description="time between two outputs [t0]")
    duration: Positive = Field(default=2.0, description="time after equilibration [t0]")
    equilibration: NonNegative = Field(default=0.0, description="time left out [t0]")

    def build(self) -> System:
        radius = 1.5
        volume = 4 / 3 * math.pi * radius**3
        sizes = (self.length, self.width, self.height)
        return System(
            box=Box(sizes, periodic=(True, True, True)),
            clock=self.clock(md_steps=8),
            species=(Species("colloids", self.spheres, volume * self.density, radius),),
            placement=Lattice(),
            interactions=(
                Interaction("colloids", "colloids", RepulsiveMie(2 * radius, exponent=24)),
                Interaction("colloids", FLUID, RepulsiveMie(radius, exponent=6)),
            ),
            drives=(Drive("colloids", self.gravity, (0, 0, -1)),),
            solvent=self.solvent(math.prod(sizes) - self.spheres * volume),
            outputs=(TRAJECTORY, FLUID_PROFILE, FLUID_AVERAGES),
            measures=("fluid_temperature", "colloid_temperature", "overlaps"),
        )

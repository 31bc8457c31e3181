"""Scenes that only tests need: three dimensions, walls, and several species."""

import math
from typing import Any, ClassVar

from pydantic import Field

from lammps_inputs.fluid_scene import FluidScene
from lammps_inputs.placement import Lattice
from lammps_inputs.potentials.integrated_wall import IntegratedWall
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
    Rotation,
    Species,
    System,
    slit,
)

DIAGONAL = (0.6, 0.0, 0.8)


class Slit3D(FluidScene):
    """The pure fluid between walls in three dimensions, driven along x, or along x and z."""

    name: ClassVar[str] = "slit_3d"

    length: Positive = Field(default=6.0, description="box along x [a0]")
    width: Positive = Field(default=7.5, description="distance between the walls [a0]")
    height: Positive = Field(default=5.0, description="box along z [a0]")
    collision_time: Positive = Field(default=0.1, description="collision time [t0]")
    rotation: Rotation = Field(default="coordinate_axes", description="axis of the rotation")
    gravity: float = Field(default=0.05, description="acceleration of the fluid [a0/t0^2]")
    diagonal: bool = Field(default=False, description="whether the drive is along (0.6, 0, 0.8)")
    duration: Positive = Field(default=10.0, description="time after equilibration [t0]")
    equilibration: NonNegative = Field(default=0.0, description="time left out [t0]")

    def build(self) -> System:
        sizes = (self.length, self.width, self.height)
        direction = DIAGONAL if self.diagonal else (1.0, 0.0, 0.0)
        return System(
            box=Box(sizes, periodic=(True, False, True)),
            clock=self.clock(),
            walls=slit(axis=1),
            drives=(Drive(FLUID, self.gravity, direction),),
            solvent=self.solvent(math.prod(sizes), self.rotation),
            outputs=(FLUID_PROFILE, FLUID_AVERAGES),
            measures=("fluid_temperature", "parabolic_flow"),
        )


class Mixture3D(FluidScene):
    """Large and small colloids, crowded between two walls in three dimensions.

    The large ones and the fluid are driven against each other.
    """

    name: ClassVar[str] = "mixture_3d"

    length: Positive = Field(default=7.0, description="edge of the box along each axis [a0]")
    width: Positive = Field(default=7.0, description="distance between the walls [a0]")
    density: float = Field(default=4.0, gt=0, description="fluid particles in a cell [1/a0^3]")
    collision_time: Positive = Field(default=0.05, description="collision time [t0]")
    large: int = Field(default=2, ge=1, description="number of large colloids")
    small: int = Field(default=5, ge=1, description="number of small colloids")
    gravity: float = Field(default=0.5, description="acceleration of the large ones [a0/t0^2]")
    sampling_interval: Positive = Field(default=0.5, description="time between two outputs [t0]")
    duration: Positive = Field(default=10.0, description="time after equilibration [t0]")
    equilibration: NonNegative = Field(default=0.0, description="time left out [t0]")

    def build(self) -> System:
        sizes = (self.length, self.width, self.length)
        volumes = [4 / 3 * math.pi * radius**3 for radius in (1.5, 1.0)]
        masses = [volume * self.density for volume in volumes]
        free = math.prod(sizes) - self.large * volumes[0] - self.small * volumes[1]
        pairs: dict[tuple[str, str], Any] = {
            ("large", "large"): RepulsiveMie(3.0, exponent=24),
            ("large", "small"): RepulsiveMie(2.5, exponent=24, epsilon=2.0),
            ("small", "small"): RepulsiveMie(2.0, exponent=6),
            ("large", FLUID): RepulsiveMie(1.5, exponent=6),
            ("small", FLUID): RepulsiveMie(1.0, exponent=6, epsilon=1.5),
        }
        walls = (("large", IntegratedWall(1.5, 1.0)), ("small", IntegratedWall(1.0, 1.0)))
        return System(
            box=Box(sizes, periodic=(True, False, True)),
            clock=self.clock(md_steps=25),
            species=(
                Species("large", self.large, masses[0], 1.5),
                Species("small", self.small, masses[1], 1.0),
            ),
            placement=Lattice(),
            interactions=tuple(Interaction(*pair, potential) for pair, potential in pairs.items()),
            walls=slit(1, walls),
            drives=(
                Drive("large", self.gravity, DIAGONAL),
                Drive(FLUID, 0.1, (-1, 0, 0), variable="wind"),
            ),
            solvent=self.solvent(free),
            outputs=(TRAJECTORY, FLUID_PROFILE, FLUID_AVERAGES),
            measures=("fluid_temperature",),
        )

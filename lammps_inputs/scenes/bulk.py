"""The pure fluid in a periodic box, at rest or with one decaying shear wave."""

import math
from collections.abc import Iterator
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from lammps_inputs.fluid_scene import FluidScene
from lammps_inputs.scene import NonNegative, Positive
from lammps_inputs.system import FLUID_AVERAGES, FLUID_PROFILE, Box, Rotation, System


class Bulk(FluidScene):
    """A periodic box of pure fluid, in 2D or 3D.

    With `shear_wave` the fluid starts with v_x = shear_wave sin(2 pi y / width), which decays as
    exp(-nu k^2 t): its rate is the kinematic viscosity of the bulk fluid.
    """

    name: ClassVar[str] = "bulk"

    dimension: Literal[2, 3] = Field(default=2, description="space dimensions")
    length: Positive = Field(default=32.0, description="box length along x [a0]")
    width: Positive = Field(default=32.0, description="box width along y [a0]")
    height: Positive | None = Field(
        default=None, description="box height along z, 3D only [a0]; none: as the width"
    )
    rotation: Rotation = Field(
        default="coordinate_axes",
        description="axis of the 3D rotation: random_axis (3.8), or coordinate_axes (hecht-2005)",
    )
    collision_time: Positive = Field(default=0.1, description="collision time tau_c [t0]")
    shear_wave: Annotated[float, Field(ge=0, le=1)] = Field(
        default=0.0, description="initial amplitude of the shear wave [a0/t0]"
    )
    duration: Positive = Field(default=100.0, description="time after equilibration [t0]")
    equilibration: NonNegative = Field(default=0.0, description="time left out [t0]")

    def build(self) -> System:
        sizes: tuple[float, ...] = (self.length, self.width)
        if self.dimension == 3:
            sizes = (*sizes, self.height or self.width)
        wave = ("shear_wave",) if self.shear_wave else ()
        return System(
            box=Box(sizes, periodic=(True,) * self.dimension),
            clock=self.clock(),
            solvent=self.solvent(math.prod(sizes), self.rotation, self.shear_wave),
            outputs=(FLUID_PROFILE, FLUID_AVERAGES),
            measures=("fluid_temperature", *wave),
        )

    def problems(self) -> Iterator[str]:
        yield from super().problems()
        if self.dimension == 2 and self.height is not None:
            yield f"height = {self.height!r}: only for dimension = 3"
        if self.dimension == 3 and self.rotation == "coordinate_axes" and self.angle != 90:
            yield (
                f"angle = {self.angle!r}: rotations about the coordinate axes are by 90 degrees; "
                "use rotation = 'random_axis' for another angle"
            )

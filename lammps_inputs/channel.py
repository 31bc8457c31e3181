"""Colloids settling in a narrow channel (tabatabaei-2009, chapters 3 and 4)."""

import math
from collections.abc import Iterable
from typing import Annotated, Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, field_validator

from lammps_inputs.potentials import IntegratedWall, RepulsiveMie
from lammps_inputs.scene import FluidScene, NonNegative, Positive
from lammps_inputs.viscosity import viscosity

SOUND = 1.0  # speed in an ideal gas that a thermostat keeps at kBT = m_f = 1 [a0/t0]


class Channel(FluidScene):
    """A 2D slit, periodic along x, with colloids in an MPC fluid; gravity pulls the colloids.

    Defaults are the paper's parameters of Table 3.1 and section 4.4 for its smallest system.
    """

    name: ClassVar[str] = "channel"
    walls: ClassVar[bool] = True

    length: Positive = Field(default=40.0, description="channel length along x [a0]")
    width: Positive = Field(default=10.0, description="distance between the walls [a0]")
    collision_time: Positive = Field(default=0.015, description="collision time tau_c [t0]")
    md_steps_per_collision: Annotated[int, Field(ge=1, le=1000)] = Field(
        default=15, description="MD steps between two collisions tau_c / tau_MD"
    )
    colloids: Annotated[int, Field(ge=1)] = Field(default=3, description="colloids N_c")
    colloid_radius: Positive = Field(default=2.0, description="colloid radius r_c [a0]")
    wall_sigma: Positive = Field(
        default=2.0, description="colloid-wall collision diameter sigma_w [a0]"
    )
    wall_strength: NonNegative = Field(
        default=1.0, description="wall particles per sigma_w, q of (3.31), times the energy [kBT]"
    )
    gravity: float = Field(
        default=0.1, description="acceleration of the colloids along x [a0/t0^2]"
    )
    spacing: Positive | None = Field(
        default=None, description="initial distance of neighbouring centres [a0]; none: even"
    )
    sampling_interval: Positive = Field(
        default=0.75, description="time between two outputs, at least two collisions [t0]"
    )
    duration: Positive = Field(default=1000.0, description="time after equilibration [t0]")
    equilibration: NonNegative = Field(default=100.0, description="time left out [t0]")

    @field_validator("spacing", mode="before")
    @classmethod
    def _no_spacing(cls, value: Any) -> Any:
        return None if value == "none" else value

    @property
    def colloid_mass(self) -> float:
        """M_c = pi r_c^2 n_f, the mass of the fluid a colloid displaces (3.4.1) [m_f]."""
        return math.pi * self.colloid_radius**2 * self.density

    @property
    def fluid_particles(self) -> int:
        """N_f = n_f (L_x L_y - N_c pi r_c^2) (3.4.1): density counts per free cell."""
        free = self.length * self.width - self.colloids * math.pi * self.colloid_radius**2
        return round(self.density * free)

    @property
    def fluid_gravity(self) -> float:
        """Acceleration of the fluid along x: none, gravity pulls the colloids."""
        return 0.0

    @property
    def time_step(self) -> float:
        return self.collision_time / self.md_steps_per_collision

    @property
    def steps_per_collision(self) -> int:
        return self.md_steps_per_collision

    @property
    def expected_speed(self) -> float:
        """Settling speed by the measured drag, v_s n_f nu / (M_c g) = 0.13 at 40 x 10 [a0/t0].

        An estimate, within a factor of two for other sizes.
        """
        nu = viscosity(self.density, self.collision_time, min(self.angle, 179.0))
        return 0.13 * math.pi * self.colloid_radius**2 * abs(self.gravity) / nu

    @property
    def colloid_colloid(self) -> RepulsiveMie:
        """The 48-24 repulsion (3.43) with sigma_cc = 2 r_c."""
        return RepulsiveMie(sigma=2 * self.colloid_radius, exponent=24)

    @property
    def colloid_fluid(self) -> RepulsiveMie:
        """The 12-6 repulsion (3.42) with sigma_cf = r_c."""
        return RepulsiveMie(sigma=self.colloid_radius, exponent=6)

    @property
    def colloid_wall(self) -> IntegratedWall:
        """The 11-5 repulsion of each wall (3.49)."""
        return IntegratedWall(sigma=self.wall_sigma, strength=self.wall_strength)

    @property
    def initial_colloid_positions(self) -> NDArray[np.float64]:
        """Colloid centres at t = 0, on the mid-line, lowest number leftmost: (N_c, 2) [a0]."""
        spacing = self.spacing or self.length / self.colloids
        x = spacing * (np.arange(self.colloids) + 0.5)
        return np.column_stack([x, np.full(self.colloids, self.width / 2)])

    def problems(self) -> Iterable[str]:
        yield from super().problems()
        diameter = 2 * self.colloid_radius
        if self.width <= diameter:
            yield (
                f"width = {self.width!r}: colloids of radius {self.colloid_radius!r} touch the "
                f"walls; must be more than {diameter!r}"
            )
        if self.wall_strength > 0 and self.width < 2 * self.wall_sigma:
            yield (
                f"wall_sigma = {self.wall_sigma!r}: the walls overlap the colloids on the "
                f"mid-line; must be at most half the width, {self.width / 2!r}"
            )
        turn = self.time_step * math.sqrt(self.colloid_wall.stiffness / self.colloid_mass)
        if turn > 1:
            yield (
                f"wall_strength = {self.wall_strength!r}: too stiff for steps of "
                f"{self.time_step:.4g}; must be at most {self.wall_strength / turn**2:.2g}"
            )
        if self.spacing is None:
            if self.colloids * diameter > self.length:
                yield (
                    f"colloids = {self.colloids!r}: do not fit in a length of {self.length!r}; "
                    f"at most {int(self.length // diameter)} of diameter {diameter!r}"
                )
        elif self.colloids > 1 and self.spacing < diameter:
            yield f"spacing = {self.spacing!r}: colloids overlap; must be at least {diameter!r}"
        elif (self.colloids - 1) * self.spacing + diameter > self.length:
            yield (
                f"spacing = {self.spacing!r}: {self.colloids} colloids do not fit in a length of "
                f"{self.length!r}"
            )
        if self.hydrodynamics == "on" and self.expected_speed > SOUND:
            yield (
                f"gravity = {self.gravity!r}: colloids would fall at about "
                f"{self.expected_speed:.2g}, faster than sound in the fluid ({SOUND:g}); must be "
                f"less than {self.gravity * SOUND / self.expected_speed:.2g}"
            )
        if self.length < 2 * self.colloid_colloid.cutoff:
            yield (
                f"length = {self.length!r}: a colloid would meet its own periodic image; must be "
                f"at least {2 * self.colloid_colloid.cutoff:.4f}"
            )

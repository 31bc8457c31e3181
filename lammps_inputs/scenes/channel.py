"""Colloids settling in a narrow channel (tabatabaei-2009, chapters 3 and 4)."""

import math
from collections.abc import Iterator
from typing import Annotated, Any, ClassVar, Self

from pydantic import Field, ValidationError, field_validator

from lammps_inputs.comparison import Laboratory
from lammps_inputs.fluid_scene import FluidScene
from lammps_inputs.limits import SOUND
from lammps_inputs.placement import Row
from lammps_inputs.potentials.integrated_wall import IntegratedWall
from lammps_inputs.potentials.repulsive_mie import RepulsiveMie
from lammps_inputs.scene import NonNegative, Positive, SceneError
from lammps_inputs.slit_laboratory import SlitLaboratory
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
    slit,
)
from lammps_inputs.viscosity import self_diffusion_2d, viscosity

MOBILITY = 0.13  # speed over force, times n_f nu, at 40 x 10
MACH = 0.08  # at 0.1 colloids settle 10 % faster than in proportion to gravity


class Channel(FluidScene):
    """A 2D slit, periodic along x, with colloids in an MPC fluid; gravity pulls the colloids.

    Defaults are the paper's parameters of Table 3.1 and section 4.4 for its smallest system.
    """

    name: ClassVar[str] = "channel"
    paper: ClassVar[str] = "tabatabaei-2009"

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

    @classmethod
    def of_laboratory(cls, **fields: Any) -> tuple[Self, Laboratory]:
        """The channel of a `SlitLaboratory`; other fields are the scene's.

        Raises:
            SceneError: for wrong fields.
        """
        known = {name: fields.pop(name) for name in SlitLaboratory.model_fields if name in fields}
        try:
            real = SlitLaboratory(**known)
        except ValidationError as error:
            raise SceneError(cls._field_problems(error)) from None
        if real.particle_density <= real.fluid_density:
            raise SceneError.of_field(
                "particle_density", real.particle_density, "must be more than that of the fluid"
            )
        for field in ("length", "width", "gravity"):
            if field in fields:
                raise SceneError.of_field(field, fields[field], "follows from the laboratory")
        radius = cls.make(**fields).colloid_radius
        edge = real.particle_radius / radius
        size = {
            "length": float(round(real.channel_length / edge)),
            "width": real.channel_width / edge,
        }
        scene = cls.make(**fields, **size, gravity=0.0)
        pull = real.peclet / radius
        scene = cls.make(**fields, **size, gravity=pull / scene.colloid_mass)
        nu = viscosity(scene.density, scene.collision_time, scene.angle)
        mobility = MOBILITY / (scene.density * nu)
        self_diffusion = self_diffusion_2d(scene.density, scene.collision_time, scene.angle)
        flight = scene.collision_time  # at the thermal speed 1
        rows = real.rows(radius, mobility, nu, pull, flight, self_diffusion)
        unit, energy = real.time_unit(radius, mobility), real.suspension.thermal_energy
        units = {"a0": edge, "t0": unit, "kBT": energy, "m_f": energy * (unit / edge) ** 2}
        lost: tuple[str, ...] = ()
        if mobility * pull > nu / radius:
            lost = ("the Reynolds number is above 1: the fluid is no longer creeping",)
        return scene, Laboratory(rows, units, lost)

    @property
    def colloid_mass(self) -> float:
        """M_c = pi r_c^2 n_f, the mass of the fluid a colloid displaces (3.4.1) [m_f]."""
        return math.pi * self.colloid_radius**2 * self.density

    @property
    def expected_speed(self) -> float:
        """Settling speed by the measured drag, v_s n_f nu / (M_c g) = 0.13 at 40 x 10 [a0/t0].

        An estimate, within a factor of two for other sizes.
        """
        nu = viscosity(self.density, self.collision_time, self.angle)
        return MOBILITY * math.pi * self.colloid_radius**2 * abs(self.gravity) / nu

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

    def build(self) -> System:
        colloids = Species("colloids", self.colloids, self.colloid_mass, self.colloid_radius)
        free = self.length * self.width - self.colloids * math.pi * self.colloid_radius**2
        repulsion = (("colloids", self.colloid_wall),) if self.wall_strength > 0 else ()
        return System(
            box=Box((self.length, self.width), periodic=(True, False)),
            clock=self.clock(self.md_steps_per_collision),
            species=(colloids,),
            placement=Row(self.spacing or self.length / self.colloids),
            interactions=(
                Interaction("colloids", "colloids", self.colloid_colloid),
                Interaction("colloids", FLUID, self.colloid_fluid),
            ),
            walls=slit(axis=1, potentials=repulsion),
            drives=(Drive("colloids", self.gravity),),
            solvent=self.solvent(free),  # N_f = n_f (L_x L_y - N_c pi r_c^2) (3.4.1)
            outputs=(TRAJECTORY, FLUID_PROFILE, FLUID_AVERAGES),
            measures=(
                "fluid_temperature",
                "slit_flow",
                "settling_speed",
                "colloid_temperature",
                "diffusion",
                "space_time",
                "snapshot",
                *(("spacings", "pair_correlation", "overlaps") if self.colloids >= 2 else ()),
                *(("zigzag",) if self.colloids >= 3 else ()),
            ),
        )

    def problems(self) -> Iterator[str]:
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
        step = self.system.clock.time_step
        phase = step * math.sqrt(self.colloid_wall.stiffness / self.colloid_mass)
        if phase > 1:
            yield (
                f"wall_strength = {self.wall_strength!r}: too stiff for steps of "
                f"{step:.4g}; must be at most {self.wall_strength / phase**2:.2g}"
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
            largest = abs(self.gravity) * SOUND / self.expected_speed
            yield (
                f"gravity = {self.gravity!r}: colloids would fall at about "
                f"{self.expected_speed:.2g}, faster than sound in the fluid ({SOUND:g}); must be "
                f"between {-largest:.2g} and {largest:.2g}"
            )
        if self.length < 2 * self.colloid_colloid.cutoff:
            yield (
                f"length = {self.length!r}: a colloid would meet its own periodic image; must be "
                f"at least {2 * self.colloid_colloid.cutoff:.4f}"
            )

    def warnings(self) -> Iterator[str]:
        yield from super().warnings()
        if self.hydrodynamics == "on" and self.expected_speed > MACH * SOUND:
            yield (
                f"gravity = {self.gravity!r}: colloids would fall at about "
                f"{self.expected_speed:.2g} a0/t0, no longer slow against sound ({SOUND:g}) and "
                "so not in proportion to gravity"
            )
        if self.wall_strength == 0:
            yield (
                "wall_strength = 0.0: only the fluid keeps colloids off the walls; one that "
                "crosses a wall is lost and stops the run"
            )

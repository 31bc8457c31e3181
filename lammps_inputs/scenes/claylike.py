"""Charged colloids that settle, cluster and are sheared in a 3D fluid (hecht-2005)."""

import math
from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import BeforeValidator, Field, ValidationError, model_validator

from lammps_inputs.comparison import Laboratory
from lammps_inputs.laboratory import suspension_rows
from lammps_inputs.limits import SOUND, solvent_warnings
from lammps_inputs.material import Model, Suspension
from lammps_inputs.placement import LastFrame, Lattice, lattice_cells
from lammps_inputs.potentials.dlvo import Dlvo
from lammps_inputs.potentials.harmonic_wall import HarmonicWall
from lammps_inputs.quantities import si
from lammps_inputs.scene import NonNegative, Positive, Scene
from lammps_inputs.system import (
    FLUID_PROFILE,
    SHEARED_AVERAGES,
    SPINNING_TRAJECTORY,
    SUSPENSION_AVERAGES,
    TRAJECTORY,
    Box,
    Clock,
    Drive,
    Hydrodynamics,
    Interaction,
    Solvent,
    Species,
    System,
    Thermostat,
    Wall,
    slit,
)
from lammps_inputs.viscosity import viscosity

DOUBLE_LAYER = 5.0  # least kappa R: (1) is for double layers that are thin against the radius
MOST_ENERGY = 25.0  # that pairs ever bring along; barriers above it are not crossed [kBT]
PHASE = 0.5  # largest omega dt of an oscillation: velocity Verlet is then 1 % off in its period
DAMPED = 0.25  # largest part of a relative velocity that friction may take in a step
WALL_ENERGY = 1000.0  # of a colloid whose centre is on a wall [kBT]
MACH = 0.08  # as for the channel: above, speeds are no longer in proportion to the pull
CLOSEST, FARTHEST = 0.03, 0.5  # gaps of lubrication [R]
DRIFT_INTERVAL = 100  # collisions, "every hundreds of SRD time steps" (VIII A)
LARGEST = 1.0  # radius of colloids that take part in the collision of a cell [a0]
OVERLAP = 0.3  # of the radius that kBT presses spheres into each other [R]
FASTER = {"cell": 3.0, "reflection": 1.0}  # than Stokes: coupling II has a third of the radius
EDGES = {"cell": 1.6, "reflection": 0.5}  # of a cell [R]: production runs; VII B
REFLECTION = {"cells": 48, "density": 2.5, "mean_free_path": 0.6, "md_steps_per_collision": 111}
TIMES = {"duration": 1, "equilibration": 1, "sampling_interval": 1, "shear_rate": -1}  # power of t0


def _quantity(unit: str) -> BeforeValidator:
    return BeforeValidator(lambda value: si(value, unit))


Length = Annotated[float, _quantity("m"), Field(ge=1e-10, le=1)]


class Claylike(Scene):
    """Charged spheres in a 3D fluid: they attract and repel each other, settle, and are sheared.

    Defaults are the production runs of hecht-2005: coupling II, Al2O3 of 0.25 um in water, 2 us a
    step. With coupling = reflection the fluid's defaults are `cells` 48, `density` 2.5,
    `mean_free_path` 0.6 and `md_steps_per_collision` 111: the same box. Lengths, energies and
    times of the laboratory stand with their units ("0.4 um", "20 mV", "300 K") or in SI; so may the
    times ("1 s") and the shear rate ("10 1/s"), else in t0.
    """

    name: ClassVar[str] = "claylike"
    paper: ClassVar[str] = "hecht-2005"
    si_fields: ClassVar[tuple[str, ...]] = (
        *("radius", "cell_edge", "kappa", "hamaker", "temperature", "viscosity"),
    )

    cells: Annotated[int, Field(ge=2, le=1000)] = Field(
        default=15, description="edge of the cubic box in collision cells"
    )
    density: Annotated[float, Field(gt=0, le=1000)] = Field(
        default=60.0, description="fluid particles per collision cell M [1/a0^3]"
    )
    coupling: Literal["cell", "reflection"] = Field(
        default="cell",
        description="cell: colloids take part in the collision (II); reflection: of fluid at their "
        "surface (I)",
    )
    mean_free_path: Annotated[float, Field(gt=0, le=10)] = Field(
        default=0.5, description="mean free path lambda, so also the collision time [a0, t0]"
    )
    md_steps_per_collision: Annotated[int, Field(ge=1, le=100_000)] = Field(
        default=268, description="MD steps between two collisions"
    )
    hydrodynamics: Hydrodynamics = Field(
        default="on",
        description="on; or a random solvent: shuffle (velocities interchanged), bath (redrawn)",
    )
    thermostat: Thermostat = Field(
        default="monte_carlo", description="thermostat of the fluid; monte_carlo is (33)"
    )
    potential: Literal["dlvo", "hertz", "none"] = Field(
        default="dlvo",
        description="between colloids: dlvo (1)-(3) with a parabola for the primary minimum; hertz "
        "(3) alone; none",
    )
    lubrication: Literal["on", "off"] = Field(
        default="on", description="lubrication (4) with the fluctuations that it demands"
    )
    radius: Length = Field(default=0.25e-6, description="radius of the colloids R [m]")
    cell_edge: Length | None = Field(
        default=None,
        description="edge of a collision cell a0 [m]; none: 1.6 R (cell), R / 2 (reflection)",
    )
    volume_fraction: Annotated[float, Field(gt=0, lt=0.74)] = Field(
        default=0.14, description="of the colloids, phi"
    )
    kappa: Annotated[float, _quantity("1/m"), Field(ge=1, le=1e12)] = Field(
        default=2e8, description="inverse screening length [1/m]"
    )
    surface_potential: Annotated[float, _quantity("V"), Field(ge=0, le=1)] = Field(
        default=0.02, description="effective surface potential Psi_0 [V]"
    )
    hamaker: Annotated[float, _quantity("J"), Field(ge=1e-26, le=1e-12)] = Field(
        default=4.76e-20, description="Hamaker constant A_H [J]"
    )
    minimum_depth: Positive = Field(
        default=6.0, description="depth of the parabola for the primary minimum [kBT]"
    )
    hertz: Positive = Field(
        default=600.0, description="Hertz's constant K of (3), times R^(5/2) [kBT]"
    )
    friction: NonNegative = Field(
        default=10.0, description="of surfaces in contact, across and along (6) [m_f/t0]"
    )
    temperature: Annotated[float, _quantity("K"), Field(ge=0.1, le=1e5)] = Field(
        default=300.0, description="temperature of the suspension T [K]"
    )
    particle_density: Annotated[float, _quantity("kg/m^3"), Field(gt=0)] = Field(
        default=3900.0, description="mass density of the colloids rho_m [kg/m^3]"
    )
    fluid_density: Annotated[float, _quantity("kg/m^3"), Field(gt=0)] = Field(
        default=1000.0, description="mass density of the liquid rho_w [kg/m^3]"
    )
    viscosity: Annotated[float, _quantity("m^2/s"), Field(ge=1e-12, le=1e3)] = Field(
        default=1e-6, description="kinematic viscosity of the liquid nu [m^2/s]"
    )
    peclet: NonNegative = Field(
        default=0.0, description="Peclet number (21), which sets gravity along -z; 0: none"
    )
    boundaries: Literal["periodic", "bottom", "capillary"] = Field(
        default="periodic",
        description="periodic, the fluid balancing gravity; bottom: walls across z; capillary: "
        "walls across x and y",
    )
    shear_rate: float = Field(
        default=0.0,
        description="of walls across z that move along x, for boundaries = bottom [1/t0]",
    )
    duration: Positive = Field(default=1000.0, description="time after equilibration [t0]")
    equilibration: NonNegative = Field(default=100.0, description="time left out [t0]")
    start: str | None = Field(
        default=None,
        description="directory of a run whose last colloids it begins with; none: on a lattice",
    )

    @model_validator(mode="before")
    @classmethod
    def _defaults_of_the_coupling(cls, given: Any) -> Any:
        if isinstance(given, dict) and given.get("coupling") == "reflection":
            return REFLECTION | given
        return given

    @model_validator(mode="before")
    @classmethod
    def _times_of_the_laboratory(cls, given: Any) -> Any:
        if not isinstance(given, dict):
            return given
        times = {name: given[name] for name in TIMES if isinstance(given.get(name), str)}
        if not times:
            return given
        try:
            unit = cls(**{k: v for k, v in given.items() if k not in times}).model.time_unit
        except ValidationError:
            return given  # of other fields
        for name, value in times.items():
            power = TIMES[name]
            try:
                times[name] = si(value, "s" if power > 0 else "1/s") / unit**power
            except ValueError as error:
                raise ValueError(f"{name}: {error}") from None
        return given | times

    @classmethod
    def of_laboratory(cls, **fields: Any) -> tuple[Self, Laboratory]:
        """The suspension of these fields; without `peclet` it settles on Earth.

        Raises:
            SceneError: for wrong fields.
        """
        scene = cls.make(**fields)
        on_earth = scene.model.suspension.time_scales().peclet
        if "peclet" not in fields:
            scene = cls.make(**fields, peclet=on_earth)
        pulled = replace(scene.model.suspension, gravity=9.81 * scene.peclet / on_earth)
        model = replace(scene.model, suspension=pulled)
        lost = tuple(model.time_scales().lost_order())
        return scene, Laboratory(suspension_rows(model), scene.si_units, lost)

    @property
    def edge(self) -> float:
        """Of a collision cell, a0 [m]."""
        return self.cell_edge or EDGES[self.coupling] * self.radius

    @cached_property
    def model(self) -> Model:
        """The suspension of the laboratory, and what stands for it."""
        suspension = Suspension(
            radius=self.radius,
            temperature=self.temperature,
            particle_density=self.particle_density,
            fluid_density=self.fluid_density,
            viscosity=self.viscosity,
            hamaker=self.hamaker,
        )
        return Model(suspension, self.edge, self.density, self.mean_free_path)

    @cached_property
    def between(self) -> Dlvo | None:
        """What acts between two colloids, if anything."""
        radius = self.model.reduced_radius
        lubrication = (CLOSEST * radius, FARTHEST * radius) if self.lubrication == "on" else None
        full = self.model.interaction(
            self.surface_potential,
            self.kappa,
            hertz=self.hertz / radius**2.5,
            depth=self.minimum_depth,
            lubrication=lubrication,
        )
        full = replace(full, friction=self.friction, damping=self.friction)
        if self.potential == "hertz":
            return replace(full, coulomb=0.0, hamaker=0.0)
        if self.potential == "none":
            none = replace(full, coulomb=0.0, hamaker=0.0, hertz=0.0, friction=0.0, damping=0.0)
            return none if lubrication else None
        return full

    @property
    def meet(self) -> bool:
        """Whether colloids ever touch, by forces that are of contact."""
        between = self.between
        return bool(between and between.hertz and between.barrier < MOST_ENERGY)

    @property
    def si_units(self) -> dict[str, float]:
        """Of the simulation, whose kBT is not that of the laboratory."""
        return {
            "a0": self.model.cell,
            "t0": self.model.time_unit,
            "m_f": self.model.fluid_mass,
            "kBT": self.model.thermal_energy,
        }

    @property
    def sphere_volume(self) -> float:
        """4 pi R^3 / 3 [a0^3]."""
        return 4 / 3 * math.pi * self.model.reduced_radius**3

    @property
    def colloids(self) -> int:
        """How many."""
        return round(self.volume_fraction * self.cells**3 / self.sphere_volume)

    @property
    def gravity(self) -> float:
        """Of the model, on colloids alone: Pe = m g R / kBT (21) [a0/t0^2]."""
        return self.peclet / (self.model.reduced_radius * self.model.reduced_mass)

    @property
    def expected_speed(self) -> float:
        """Of a single sphere, by Stokes; coupling II lets it go three times as fast [a0/t0]."""
        eta = self.density * viscosity(self.density, self.mean_free_path, 90, dimensions=3)
        drag = 6 * math.pi * eta * self.model.reduced_radius
        return FASTER[self.coupling] * self.peclet / self.model.reduced_radius / drag

    @property
    def wall_speed(self) -> float:
        """Of either wall, in opposite directions [a0/t0]."""
        return 0.5 * self.shear_rate * self.cells

    @property
    def wall(self) -> HarmonicWall:
        """What keeps colloids off the walls."""
        radius = self.model.reduced_radius
        return HarmonicWall(radius, 2 * WALL_ENERGY / radius**2)

    def build(self) -> System:
        radius, mass = self.model.reduced_radius, self.model.reduced_mass
        volume = float(self.cells**3)
        if self.coupling == "reflection":
            volume -= self.colloids * self.sphere_volume
        repulsion = (("colloids", self.wall),)
        walls: tuple[Wall, ...] = ()
        if self.boundaries == "bottom":
            walls = slit(2, repulsion, self.wall_speed)
        elif self.boundaries == "capillary":
            walls = (*slit(0, repulsion), *slit(1, repulsion))
        closed = {wall.axis for wall in walls}
        between = self.between
        turned = self.coupling == "reflection"  # by the fluid: coupling II gives no torque
        trajectory = SPINNING_TRAJECTORY if turned else TRAJECTORY
        averages = SHEARED_AVERAGES if self.shear_rate else SUSPENSION_AVERAGES
        return System(
            box=Box((float(self.cells),) * 3, tuple(axis not in closed for axis in range(3))),
            clock=Clock.of_times(
                self.mean_free_path,
                self.sampling_interval,
                self.equilibration,
                self.duration,
                self.md_steps_per_collision,
            ),
            species=(Species("colloids", self.colloids, mass, radius, 0.4 * mass * radius**2),),
            placement=LastFrame(str(Path(self.start) / trajectory.file))
            if self.start
            else Lattice(),
            interactions=(Interaction("colloids", "colloids", between),) if between else (),
            walls=walls,
            drives=(Drive("colloids", self.gravity, (0.0, 0.0, -1.0), balanced=not walls),),
            solvent=Solvent(
                particles=round(self.density * volume),
                density=self.density,
                collision_time=self.mean_free_path,
                angle=90.0,
                hydrodynamics=self.hydrodynamics,
                thermostat=self.thermostat,
                coupling=self.coupling,
                drift_interval=0 if walls or self.hydrodynamics == "bath" else DRIFT_INTERVAL,
            ),
            outputs=(trajectory, FLUID_PROFILE, averages),
            measures=(
                "fluid_temperature",
                "colloid_temperature",
                "rotational_temperature",
                "sedimentation",
                "suspension_diffusion",
                *(("rotational_diffusion",) if turned else ()),
                "velocity_distribution",
                "fluid_velocity_distribution",
                *(("clusters",) if self.colloids > 1 else ()),
                *(("radial_distribution",) if self.colloids > 1 and not walls else ()),
                *(("shear_flow",) if self.shear_rate else ()),
            ),
        )

    def problems(self) -> Iterator[str]:
        yield from super().problems()
        if not self.density > 1:
            yield f"density = {self.density!r}: must be more than 1 fluid particle in a cell"
            return
        yield from self._geometry_problems()
        if self.kappa * self.radius < DOUBLE_LAYER and self.potential == "dlvo":
            yield (
                f"kappa = {self.kappa!r}: kappa R is {self.kappa * self.radius:.3g}; (1) needs "
                f"double layers thin against the radius, at least {DOUBLE_LAYER:g}, so kappa of "
                f"{DOUBLE_LAYER / self.radius:.3g} or more"
            )
        if self.coupling == "reflection" and self.potential == "none":
            yield (
                "potential = 'none': spheres that reflect the fluid must not overlap; use 'hertz'"
            )
        yield from self._speed_problems()
        yield from self._step_problems()

    def _geometry_problems(self) -> Iterator[str]:
        radius, box = self.model.reduced_radius, float(self.cells)
        if self.coupling == "reflection" and radius < 1:
            yield (
                f"cell_edge = {self.edge!r}: a sphere that reflects has a radius of {radius:.3g} "
                f"cells; at least 1, so an edge of at most {self.radius:.3g}"
            )
        reach = max(self.between.reach if self.between else 0.0, 2 * radius)
        if box < 2 * reach:
            yield (
                f"cells = {self.cells!r}: colloids would meet their own images, forces reach "
                f"{reach:.3g} cells; at least {math.ceil(2 * reach)}"
            )
        if self.colloids < 1:
            least = 0.5 * self.sphere_volume / box**3
            yield (
                f"volume_fraction = {self.volume_fraction!r}: not one colloid in the box; at least "
                f"{least:.2g}"
            )
            return
        spacing = box / max(lattice_cells((box,) * 3, self.colloids))
        if spacing < 2 * radius:
            most = int(box / (2 * radius)) ** 3 * self.sphere_volume / box**3
            yield (
                f"volume_fraction = {self.volume_fraction!r}: spheres overlap on the cubic lattice "
                f"that they start from; at most {math.floor(1000 * most) / 1000:g} in this box"
            )

    def _speed_problems(self) -> Iterator[str]:
        if self.shear_rate and self.boundaries != "bottom":
            yield (
                f"shear_rate = {self.shear_rate!r}: needs walls across z, boundaries = 'bottom', "
                f"not {self.boundaries!r}"
            )
        if abs(self.wall_speed) > SOUND:
            yield (
                f"shear_rate = {self.shear_rate!r}: the walls would move at "
                f"{abs(self.wall_speed):.3g}, faster than sound in the fluid ({SOUND:g}); at most "
                f"{2 * SOUND / self.cells:.3g} either way"
            )
        if self.expected_speed > SOUND:
            yield (
                f"peclet = {self.peclet!r}: colloids would settle at about "
                f"{self.expected_speed:.2g}, faster than sound in the fluid ({SOUND:g}); at most "
                f"{self.peclet * SOUND / self.expected_speed:.2g}"
            )
        if self.peclet and self.particle_density <= self.fluid_density:
            yield (
                f"particle_density = {self.particle_density!r}: must be more than that of the "
                f"fluid, {self.fluid_density!r}, to settle; or peclet = 0"
            )
        if self.thermostat == "layer" and self.boundaries == "capillary":
            yield (
                "thermostat = 'layer': there must not be two pairs of walls, as in a capillary; "
                "use 'monte_carlo'"
            )
        if self.peclet and self.boundaries == "periodic" and self.thermostat == "none":
            yield (
                "thermostat = 'none': in a periodic box gravity heats without end (VIII B); must "
                "be a thermostat"
            )

    def _step_problems(self) -> Iterator[str]:
        between, step = self.between, self.system.clock.time_step
        half = 0.5 * self.model.reduced_mass  # reduced mass of two spheres
        steps = self.md_steps_per_collision
        if between is None:
            return
        phase = step * math.sqrt(between.stiffest(MOST_ENERGY) / half)
        if phase > PHASE:
            what = "contact and the primary minimum are" if self.meet else "the potential is"
            yield (
                f"md_steps_per_collision = {steps!r}: {what} too stiff for steps of {step:.3g}, "
                f"omega dt is {phase:.2g}; must be at least {math.ceil(steps * phase / PHASE)}, or "
                f"minimum_depth = {self.minimum_depth!r} or hertz = {self.hertz!r} less"
            )
        friction = float(between.normal_friction(between.diameter)) + between.friction
        if friction * step / half > DAMPED:
            yield (
                f"md_steps_per_collision = {steps!r}: friction in contact takes "
                f"{friction * step / half:.2g} of a velocity in a step; must be at least "
                f"{math.ceil(steps * friction * step / half / DAMPED)}"
            )
        wall = step * math.sqrt(self.wall.stiffness / self.model.reduced_mass)
        if self.boundaries != "periodic" and wall > PHASE:
            yield (
                f"md_steps_per_collision = {steps!r}: the walls are too stiff for steps of "
                f"{step:.3g}; must be at least {math.ceil(steps * wall / PHASE)}"
            )

    def warnings(self) -> Iterator[str]:
        yield from super().warnings()
        system = self.system
        if system.solvent:
            yield from solvent_warnings(system.solvent, system.box)
        for lost in self.model.time_scales().lost_order():
            yield f"radius = {self.radius!r}, cell_edge = {self.edge!r}: {lost}"
        radius, overlap = self.model.reduced_radius, self.hertz**-0.4
        if self.coupling == "cell" and radius > LARGEST:
            yield (
                f"cell_edge = {self.edge!r}: spheres of {radius:.3g} cells in radius collide with "
                f"the fluid of one; above {LARGEST:g} the fluid drags them as smaller ones"
            )
        if self.meet and overlap > OVERLAP:
            yield (
                f"hertz = {self.hertz!r}: kBT presses spheres into each other by {overlap:.2g} of "
                f"their radius; above {OVERLAP:g} they are no spheres of that radius"
            )
        for field, value, speed in (
            ("peclet", self.peclet, self.expected_speed),
            ("shear_rate", self.shear_rate, abs(self.wall_speed)),
        ):
            if speed > MACH * SOUND:
                yield (
                    f"{field} = {value!r}: speeds of about {speed:.2g} a0/t0 are no longer slow "
                    f"against sound ({SOUND:g})"
                )

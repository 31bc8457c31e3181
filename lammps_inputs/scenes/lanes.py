"""Two colours of particles in a field that drives them oppositely (delhommelle-2005)."""

import math
from collections.abc import Iterator
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field, model_validator

from lammps_inputs.limits import SOUND, solvent_warnings
from lammps_inputs.scene import Positive
from lammps_inputs.soft_scene import SoftScene
from lammps_inputs.system import (
    FLUID_AVERAGES,
    FLUID_PROFILE,
    TRAJECTORY,
    Box,
    Clock,
    Configurational,
    DissipativePairs,
    Drive,
    Hydrodynamics,
    Interaction,
    Isokinetic,
    Langevin,
    Motion,
    Output,
    Solvent,
    Species,
    System,
    VelocityVerlet,
)
from lammps_inputs.viscosity import mobility_in_cells, solvent_viscosity

TURN = 0.25  # of the velocities by the field in half a step, at most
KICK = 0.005  # of the field in a step, from which on a configurational run is likely to stop
LARGEST_SEED = 900_000_000  # of LAMMPS's noise
IN_SOLVENT = {"thermostat": "solvent", "mass": 5.0}  # defaults: as heavy as the fluid of a cell
STRAINED = 1.05  # edges of a crystal in a square box, at most
ANGLE = 90.0  # of the solvent's rotations [degrees]

Thermostat = Literal[
    "kinetic", "kinetic_x", "kinetic_y", "configurational", "langevin", "dpd", "solvent"
]


class Lanes(SoftScene):
    """A binary mixture in a colour field: half of the particles are driven along x, half against.

    Soft disks in 2D, Weeks-Chandler-Andersen spheres in 3D, at rest before the field, colours at
    random. Units are sigma, epsilon and the mass of a particle, or of a fluid particle where there
    is a solvent: particles then collide with the fluid of their cell (hecht-2005, V).
    """

    name: ClassVar[str] = "lanes"
    paper: ClassVar[str] = "delhommelle-2005"

    field: Annotated[float, Field(ge=0, le=1000)] = Field(
        default=1.0, description="force on each particle, along x or against it [epsilon/sigma]"
    )
    thermostat: Thermostat = Field(
        default="kinetic",
        description="kinetic energy fixed, all or of one direction; configurational temperature "
        "fixed; langevin; dpd; solvent: its noise alone, the default with one",
    )
    friction: Positive = Field(default=1.0, description="of langevin and dpd [1/t0]")
    dpd_cutoff: Positive = Field(default=1.5, description="range of the dpd friction [sigma]")
    solvent: Literal["none", "mpc"] = Field(
        default="none", description="none, or mpc: an MPC fluid in a box of equal edges"
    )
    hydrodynamics: Hydrodynamics = Field(
        default="on",
        description="of the solvent: on; or a random one: shuffle (velocities interchanged), bath "
        "(redrawn)",
    )
    solvent_density: Annotated[float, Field(gt=0, le=1000)] = Field(
        default=5.0, description="fluid particles in a collision cell, whose edge is about sigma"
    )
    collision_time: Positive = Field(
        default=0.1, description="time between collisions of the solvent, whole time steps [t0]"
    )
    mass: Positive = Field(
        default=1.0, description="of a particle, in a solvent [fluid particles]; its default is 5"
    )

    @model_validator(mode="before")
    @classmethod
    def _defaults_in_a_solvent(cls, given: Any) -> Any:
        if isinstance(given, dict) and given.get("solvent") == "mpc":
            return IN_SOLVENT | given
        return given

    @property
    def fluid(self) -> Solvent | None:
        """The solvent; its cells fit the box."""
        if self.solvent == "none":
            return None
        edge = self.box().sizes[0]
        across = max(1, round(edge))
        return Solvent(
            particles=round(self.solvent_density * across**self.dimension),
            density=self.solvent_density,
            collision_time=self.collision_time,
            angle=ANGLE,
            hydrodynamics=self.hydrodynamics,
            thermostat="maxwell_boltzmann",
            coupling="cell",
            cell=edge / across,
            temperature=self.set_temperature,
        )

    def box(self) -> Box:
        if self.solvent == "none":
            return super().box()
        edge = (self.number / self.number_density) ** (1 / self.dimension)
        return Box((edge,) * self.dimension, periodic=(True,) * self.dimension)

    def clock(self) -> Clock:
        if self.solvent == "none":
            return super().clock()
        return Clock.of_times(
            self.collision_time,
            self.sampling_interval,
            self.equilibration,
            self.duration,
            steps_per_beat=max(1, round(self.collision_time / self.time_step)),
        )

    @property
    def motion(self) -> Motion:
        """The thermostat; Newton's equations where it is the solvent."""
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
            case "solvent":
                return VelocityVerlet()

    def build(self) -> System:
        half = self.number // 2
        pairs = (("plus", "plus"), ("plus", "minus"), ("minus", "minus"))
        exact = {"kinetic_x", "kinetic_y", "kinetic"}
        thermostat = ("thermostat_friction",) if self.thermostat in exact else ()
        if self.thermostat == "configurational":
            thermostat = ("thermostat_multiplier",)
        fluid = self.fluid
        averages = ("kinetic_temperature", "potential_energy", "pressure")
        current = () if fluid else ("current",)
        by_displacement = ("displacement_current",) if fluid else ()
        flat = ("bond_order",) if self.dimension == 2 else ()
        return System(
            box=self.box(),
            clock=self.clock(),
            species=tuple(Species(name, half, self.mass, 0.5) for name in ("plus", "minus")),
            placement=self.placement(),
            interactions=tuple(Interaction(*pair, self.potential) for pair in pairs),
            drives=(
                Drive("plus", self.field / self.mass, (1, 0, 0), variable="field"),
                Drive("minus", self.field / self.mass, (-1, 0, 0), variable="field"),
            ),
            motion=self.motion,
            rest=self.resting(),
            solvent=fluid,
            outputs=(
                TRAJECTORY,
                *((FLUID_PROFILE,) if fluid else ()),
                Output(
                    "observables.dat",
                    "table",
                    (
                        *averages,
                        *current,
                        *("force_squares", "laplacians"),
                        *thermostat,
                        *(FLUID_AVERAGES.columns if fluid else ()),
                    ),
                ),
            ),
            measures=(
                "soft_averages",
                *by_displacement,
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
        if self.thermostat == "configurational" and self.begins_anew and not self.resting():
            yield (
                f"rest = {self.rest!r}: the configurational thermostat runs away from a lattice; "
                "let it melt at rest first, for about 20"
            )
        if self.thermostat in ("langevin", "dpd") and self.seed > LARGEST_SEED:
            yield f"seed = {self.seed!r}: must be at most {LARGEST_SEED} for noise"
        if self.thermostat == "dpd" and self.dpd_cutoff > min(self.box().sizes) / 2:
            yield f"dpd_cutoff = {self.dpd_cutoff!r}: must be at most half of the box"
        if self.thermostat != "solvent" and self.solvent != "none":
            yield (f"thermostat = {self.thermostat!r}: a solvent brings its own, must be 'solvent'")
        if self.fluid:
            yield from self._solvent_problems(self.fluid)
        elif self.thermostat == "solvent":
            yield "thermostat = 'solvent': there is none; solvent must be 'mpc'"
        elif self.mass != 1:
            yield f"mass = {self.mass!r}: must be 1, the unit, without a solvent"

    def _solvent_problems(self, fluid: Solvent) -> Iterator[str]:
        columns, rows = self.cells or (1, 1)
        strain = columns / (math.sqrt(3) * rows)
        if (
            self.dimension == 2
            and self.start == "crystal"
            and not (1 / STRAINED < strain < STRAINED)
        ):
            yield (
                f"particles = {self.number!r}: a solvent needs a square box, which strains their "
                f"crystal by {abs(strain - 1):.0%}; 896 fit, or start = 'random'"
            )
        if fluid.particles < 2:
            yield f"solvent_density = {self.solvent_density!r}: leaves no fluid"
        steps = self.collision_time / self.time_step
        if abs(steps - max(1, round(steps))) > 1e-6 * steps:
            yield (
                f"collision_time = {self.collision_time!r}: must be a whole number of time "
                f"steps of {self.time_step!r}"
            )
        if self.collision_time > fluid.cell:
            yield (
                f"collision_time = {self.collision_time!r}: fluid would fly through its cell; must "
                "be at most 1"
            )
        speed = self.field * mobility_in_cells(fluid, self.mass, self.dimension)
        if speed > SOUND:
            yield (
                f"field = {self.field!r}: would drive lone particles at {speed:.2g}, faster than "
                f"sound in the fluid ({SOUND:g}); must be at most {self.field * SOUND / speed:.2g}"
            )

    def warnings(self) -> Iterator[str]:
        yield from super().warnings()
        if self.fluid:
            yield from solvent_warnings(self.fluid, self.box())
            yield from self._flow_warnings(self.fluid)
        if self.thermostat == "configurational" and self.field * self.time_step > KICK:
            yield (
                f"time_step = {self.time_step!r}: long for a field of {self.field!r} under the "
                "configurational thermostat, which does not limit the speed of particles; such "
                f"runs often stop, use {KICK / self.field:.1g}"
            )

    def _flow_warnings(self, fluid: Solvent) -> Iterator[str]:
        """Two lanes are forces +-n F of wave number k = 2 pi / L: their flow is n F / (eta k^2)."""
        edge = self.box().sizes[1]
        viscosity = solvent_viscosity(fluid, self.dimension).total
        shear = fluid.density / fluid.cell**self.dimension * viscosity
        flow = self.number_density * self.field * (edge / (2 * math.pi)) ** 2 / shear
        if self.hydrodynamics == "on" and flow > SOUND:
            yield (
                f"field = {self.field!r}: two lanes would flow at {flow:.2g}, faster than sound in "
                f"the fluid ({SOUND:g}); below {self.field * SOUND / flow:.2g}, or with a shorter "
                "collision_time, they do not"
            )

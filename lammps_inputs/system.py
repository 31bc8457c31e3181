"""The parts of a system: what engines write and measures ask, whatever its scene is called.

All parts are frozen data in reduced units: lengths in a0, energies in kBT, masses in m_f, times in
t0. A scene builds its `System` from them; an engine refuses the parts that it does not know.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, Literal, Protocol, Self, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

FLUID = "fluid"  # in interactions and drives: the solvent
SIZES = ("length", "width", "height")  # what scenes call the edges of the box along x, y and z
LONGEST_LOOK = 10  # beats between two looks at a fluid: its velocities decorrelate in a few

Hydrodynamics = Literal["on", "shuffle", "bath"]
Precision = Literal["double", "single"]
Thermostat = Literal["none", "layer", "monte_carlo", "maxwell_boltzmann", "rescale", "andersen"]
Rotation = Literal["random_axis", "coordinate_axes"]
Coupling = Literal["force", "reflection", "cell"]
Side = Literal["lower", "upper"]


@dataclass(frozen=True)
class Box:
    """Edges from the origin on [a0], and whether each axis is periodic; one entry a dimension."""

    sizes: tuple[float, ...]
    periodic: tuple[bool, ...]

    @property
    def dimensions(self) -> int:
        """Number of space dimensions d."""
        return len(self.sizes)

    def nearest_image(self, separation: Array) -> Array:
        """Separations (..., d) between the nearest periodic images, a new array [a0]."""
        image = separation.copy()
        for axis, (size, periodic) in enumerate(zip(self.sizes, self.periodic, strict=True)):
            if periodic:
                image[..., axis] -= size * np.round(image[..., axis] / size)
        return image


@dataclass(frozen=True)
class Clock:
    """When an engine steps, collides, looks and writes; all but the time step in engine steps.

    Attributes:
        time_step: that of molecular dynamics where there is any, else the collision time [t0].
        steps_per_collision: of the solvent; 1 where there is none.
        sample_steps: between two outputs.
        look_steps: between two looks at the system, which an output averages; they divide
            `sample_steps` and are at most half of it. With a single look LAMMPS would also output
            at the step a run starts from.
        equilibration_steps: at the start, left out of averages.
        total_steps: of the whole run, equilibration included; whole outputs.
    """

    time_step: float
    steps_per_collision: int
    sample_steps: int
    look_steps: int
    equilibration_steps: int
    total_steps: int

    @classmethod
    def of_times(
        cls,
        beat: float,
        sampling_interval: float,
        equilibration: float,
        duration: float,
        steps_per_beat: int = 1,
    ) -> Self:
        """Times [t0] rounded to whole beats, a run to whole outputs of at least two beats.

        Args:
            beat: collision time, or the time step of an engine without collisions.
            steps_per_beat: engine steps in a beat.
        """
        beats = max(2, round(sampling_interval / beat))
        outputs = max(1, math.ceil((equilibration + duration) / beat / beats - 1e-9))
        look = max(
            look for look in range(1, LONGEST_LOOK + 1) if beats % look == 0 and beats // look >= 2
        )
        return cls(
            time_step=beat / steps_per_beat,
            steps_per_collision=steps_per_beat,
            sample_steps=beats * steps_per_beat,
            look_steps=look * steps_per_beat,
            equilibration_steps=round(equilibration / beat) * steps_per_beat,
            total_steps=outputs * beats * steps_per_beat,
        )

    @property
    def collisions(self) -> int:
        """Collisions of the whole run."""
        return self.total_steps // self.steps_per_collision

    @property
    def looks(self) -> int:
        """Looks that one output averages."""
        return self.sample_steps // self.look_steps

    @property
    def end(self) -> float:
        """Time of the whole run [t0]."""
        return self.total_steps * self.time_step


@dataclass(frozen=True)
class Species:
    """Particles that move by themselves, not the fluid; `name` is their group in LAMMPS.

    Attributes:
        count: how many.
        mass: of one [m_f].
        radius: where others meet its surface; 0: a point [a0].
        inertia: moment of inertia of one, a solid sphere's; 0: they do not rotate [m_f a0^2].
    """

    name: str
    count: int
    mass: float
    radius: float = 0.0
    inertia: float = 0.0


class PairPotential(Protocol):
    """A pair potential: numpy energy and force beside the LAMMPS lines that realise it."""

    @property
    def cutoff(self) -> float:
        """Distance from which on it is zero [a0]."""

    @property
    def title(self) -> str:
        """`48-24 repulsion`."""

    @property
    def pair_style(self) -> str:
        """Name of the LAMMPS style, without its arguments."""

    def pair_arguments(self, cutoff: float, seed: str) -> str:
        """What follows the style on the `pair_style` line, with a space before each argument.

        Args:
            cutoff: the largest of the species' interactions [a0].
            seed: a variable of the deck, for a style that draws random numbers.
        """

    @property
    def pair_modify(self) -> str:
        """Arguments of the `pair_modify` line."""

    @property
    def dissipates(self) -> bool:
        """Whether it needs the velocities of both."""

    def energy(self, r: ArrayLike) -> Array:
        """Energy at distances r > 0 [kBT]."""

    def force(self, r: ArrayLike) -> Array:
        """-dU/dr at distances r > 0 [kBT/a0]."""

    def pair_coeff(self, types: str) -> str:
        """The `pair_coeff` line of two atom types."""

    def no_pair_coeff(self, types: str) -> str:
        """The `pair_coeff` line of two atom types that do not interact."""


class WallPotential(Protocol):
    """The potential of a wall for a species, by the distance of the centre from the wall."""

    @property
    def stiffness(self) -> float:
        """Largest second derivative in thermal reach [kBT/a0^2]."""

    def energy(self, distance: ArrayLike) -> Array:
        """Energy at distances > 0 [kBT]."""

    def force(self, distance: ArrayLike) -> Array:
        """Force away from the wall at distances > 0 [kBT/a0]."""


@dataclass(frozen=True)
class Interaction:
    """A potential between two species, or a species and the `FLUID`."""

    first: str
    second: str
    potential: PairPotential


@dataclass(frozen=True)
class Wall:
    """A wall at one end of a box axis; it bounces the fluid back.

    Attributes:
        axis: 0, 1 or 2, not periodic.
        side: of the box.
        potentials: for species, by name.
        velocity: along itself, which the fluid feels [a0/t0].
    """

    axis: int
    side: Side
    potentials: tuple[tuple[str, WallPotential], ...] = ()
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)


def slit(
    axis: int,
    potentials: tuple[tuple[str, WallPotential], ...] = (),
    speed: float = 0.0,
) -> tuple[Wall, Wall]:
    """The walls at both ends of an axis; the lower moves along -x, the upper along x [a0/t0]."""
    return (
        Wall(axis, "lower", potentials, (-speed if speed else 0.0, 0.0, 0.0)),
        Wall(axis, "upper", potentials, (speed, 0.0, 0.0)),
    )


@dataclass(frozen=True)
class Drive:
    """A constant acceleration of a species, or of the `FLUID`.

    Attributes:
        target: name of the species, or `FLUID`.
        magnitude: [a0/t0^2].
        direction: unit vector, three components.
        variable: of the deck, which holds the magnitude: `-var VARIABLE VALUE` changes it.
        balanced: by an opposite one of the fluid, so that total momentum stays what it is.
    """

    target: str
    magnitude: float
    direction: tuple[float, float, float] = (1.0, 0.0, 0.0)
    variable: str = "gravity"
    balanced: bool = False

    @property
    def acceleration(self) -> Array:
        """Magnitude times direction, (3,) [a0/t0^2]."""
        return self.magnitude * np.array(self.direction)


@dataclass(frozen=True)
class VelocityVerlet:
    """Newton's equations of motion, by velocity Verlet."""


@dataclass(frozen=True)
class Events:
    """Free flight from one elastic collision to the next, at exact times.

    Species collide where their radii say that surfaces touch, with each other and with walls.
    """


@dataclass(frozen=True)
class Reactions:
    """Colours A and B that no particle feels: A turns to B at one surface, B to A at another.

    The surfaces are the lower and the upper wall of an axis; or, about central particles, contact
    with one of them and the sphere of radius `cutoff`, entered from outside.

    Attributes:
        probabilities: of a reaction at each visit, (0, 1]; each has colours of its own.
        axis: of the walls; None where central particles have the surfaces.
        centers: the first so many particles are central.
        cutoff: radius of the outer surface [a0].
    """

    probabilities: tuple[float, ...]
    axis: int | None = None
    centers: int = 0
    cutoff: float = 0.0


@dataclass(frozen=True)
class Isokinetic:
    """Gauss's thermostat: the kinetic energy is constant (delhommelle-2005, 1 to 3).

    Attributes:
        temperature: [kBT].
        directions: of which the kinetic energy is.
        shear_rate: dv_x/dy of a SLLOD flow, the kinetic energy then relative to it [1/t0].
    """

    temperature: float
    directions: Literal["xyz", "x", "y", "z"] = "xyz"
    shear_rate: float = 0.0


@dataclass(frozen=True)
class Configurational:
    """The temperature of the configurations is held, velocities are free (delhommelle-2005, 4, 5).

    Attributes:
        temperature: [kBT].
        damping: Q of (5).
        shear_rate: dv_x/dy of a SLLOD flow [1/t0].
    """

    temperature: float
    damping: float = 10.0
    shear_rate: float = 0.0


@dataclass(frozen=True)
class Langevin:
    """Friction -m friction v against the laboratory, and its noise.

    Attributes:
        temperature: [kBT].
        friction: [1/t0].
    """

    temperature: float
    friction: float


@dataclass(frozen=True)
class DissipativePairs:
    """The thermostat of dissipative particle dynamics: friction and noise of pairs.

    The friction of a pair is friction (1 - r/cutoff)^2 times its approach; momentum is conserved.

    Attributes:
        temperature: [kBT].
        friction: [m_f/t0].
        cutoff: [a0].
    """

    temperature: float
    friction: float
    cutoff: float


Thermostatted = Isokinetic | Configurational | Langevin | DissipativePairs
Motion = VelocityVerlet | Thermostatted | Events


@dataclass(frozen=True)
class Rest:
    """A time at rest before step 0, without drives and outputs, the kinetic energy constant.

    Attributes:
        steps: of the clock's time step.
        temperature: [kBT].
    """

    steps: int
    temperature: float


@dataclass(frozen=True)
class Solvent:
    """The MPC fluid.

    Attributes:
        particles: N_f.
        density: n_f, fluid particles in a collision cell [1/a0^d].
        collision_time: tau_c [t0].
        angle: alpha [degrees].
        rotation: axis of the 3D rotation.
        hydrodynamics: on, or the random solvent instead.
        thermostat: of the fluid.
        shear_wave: amplitude A of the initial flow v_x = A sin(2 pi y / L_y) [a0/t0].
        coupling: how it meets species: by the force of their interaction with the `FLUID`; or all
            of them reflect it at their radius; or take part in the collision of their cell.
        drift_interval: collisions between removals of the total momentum; 0: never.
        cell: edge of a collision cell [a0].
        temperature: [kBT].
        precision: of the fluid's state.
    """

    particles: int
    density: float
    collision_time: float
    angle: float
    rotation: Rotation = "coordinate_axes"
    hydrodynamics: Hydrodynamics = "on"
    thermostat: Thermostat = "layer"
    shear_wave: float = 0.0
    coupling: Coupling = "force"
    drift_interval: int = 0
    cell: float = 1.0
    temperature: float = 1.0
    precision: Precision = "double"


class Placement(Protocol):
    """Where the particles are at the start."""

    def positions(self, box: Box, species: tuple[Species, ...], seed: int) -> Array:
        """Centres of all species, one after the other, (N, d) [a0]."""


@runtime_checkable
class Continuation(Placement, Protocol):
    """A placement with velocities, as another run left the particles."""

    def velocities(self, box: Box, species: tuple[Species, ...]) -> Array:
        """Velocities of all species relative to a shear flow, in order, (N, d) [a0/t0]."""

    def tilt(self, box: Box, species: tuple[Species, ...]) -> float:
        """How far along x the image above a sheared box is ahead [a0]."""

    def problems(self, box: Box, species: tuple[Species, ...]) -> Iterator[str]:
        """Why that run cannot be gone on from, in one line."""


Kind = Literal["trajectory", "table", "profile", "flow"]


@dataclass(frozen=True)
class FlowField:
    """Density and velocity of the fluid on a grid, in the laboratory or about a particle.

    Attributes:
        bins: along each axis.
        samples: sampling intervals that an average is over.
        around: number of the particle, from 1, in the middle of all periodic axes; 0: none.
    """

    bins: tuple[int, ...]
    samples: int
    around: int = 0


@dataclass(frozen=True)
class Output:
    """A file of a run, written every `sample_steps` (docs/run-directory.md).

    Attributes:
        file: its name.
        kind: trajectory of particles; table of averages; profile, averages by bins; flow, of the
            fluid on a grid, every so many samples as its `FlowField` says.
        columns: beside the step. Those of a table are quantities that the engine averages.
    """

    file: str
    kind: Kind
    columns: tuple[str, ...]


TRAJECTORY = Output(
    "trajectory.lammpsdump",
    "trajectory",
    ("id", "type", "x", "y", "z", "vx", "vy", "vz", "ix", "iy", "iz"),
)
SPINNING_TRAJECTORY = replace(
    TRAJECTORY, columns=(*TRAJECTORY.columns, "omegax", "omegay", "omegaz")
)
FLUID_PROFILE = Output(
    "fluid_profile.dat", "profile", ("Coord1", "Ncount", "density/number", "vx", "temp")
)
FLUID_AVERAGES = Output("observables.dat", "table", ("fluid_temperature", "mean_velocity_x"))
FLOW = Output("flow.dat", "flow", ("Ncount", "density/number", "temp"))
SUSPENSION_AVERAGES = Output(
    "observables.dat",
    "table",
    (
        *FLUID_AVERAGES.columns,
        "mean_velocity_z",
        "fluid_velocity_x",
        "fluid_velocity_z",
        "rotational_temperature",
        *(f"fluid_skewness_{axis}" for axis in "xyz"),
        *(f"fluid_kurtosis_{axis}" for axis in "xyz"),
    ),
)
SHEARED_AVERAGES = replace(
    SUSPENSION_AVERAGES,
    columns=(*SUSPENSION_AVERAGES.columns, "lower_wall_force_x", "upper_wall_force_x"),
)
PARTICLE_AVERAGES = Output(
    "observables.dat", "table", ("temperature", "potential_energy", "mean_velocity_x")
)


@dataclass(frozen=True)
class System:
    """What is simulated, by its parts.

    Attributes:
        species: particles, none for a pure fluid; atom types of LAMMPS from 1 on, in this order.
        placement: of the species at the start; None without any.
        rest: before the run; None: it begins as the species are placed.
        solvent: None: the species move in vacuum.
        outputs: what the run writes.
        measures: what `narrows analyze` makes of it, names of `analysis/measures`.
        reactions: of colours, if any.
        flow: field of the fluid, if one is wanted.
    """

    box: Box
    clock: Clock
    outputs: tuple[Output, ...]
    measures: tuple[str, ...]
    species: tuple[Species, ...] = ()
    placement: Placement | None = None
    interactions: tuple[Interaction, ...] = ()
    walls: tuple[Wall, ...] = ()
    drives: tuple[Drive, ...] = ()
    motion: Motion = VelocityVerlet()
    rest: Rest | None = None
    solvent: Solvent | None = None
    reactions: Reactions | None = None
    flow: FlowField | None = None

    @property
    def particles(self) -> int:
        """Number of particles of all species."""
        return sum(species.count for species in self.species)

    @property
    def shear_rate(self) -> float:
        """dv_x/dy that the motion imposes on a sheared periodic box [1/t0]."""
        return float(getattr(self.motion, "shear_rate", 0.0))

    @property
    def masses(self) -> Array:
        """Mass of each particle, (N,) [m_f]."""
        return self._each("mass")

    @property
    def radii(self) -> Array:
        """Radius of each particle, (N,) [a0]."""
        return self._each("radius")

    @property
    def inertias(self) -> Array:
        """Moment of inertia of each particle, (N,) [m_f a0^2]."""
        return self._each("inertia")

    @property
    def rotates(self) -> bool:
        """Whether any species does."""
        return any(species.inertia for species in self.species)

    @property
    def coupled(self) -> bool:
        """Whether fluid and species meet at all."""
        by_force = self.solvent is None or self.solvent.coupling == "force"
        return bool(self.fluid_interactions()) if by_force else bool(self.species)

    @property
    def work(self) -> float:
        """Particle updates of the whole run, which run time is proportional to."""
        fluid = self.solvent.particles if self.solvent else 0
        return float(fluid * self.clock.collisions + self.particles * self.clock.total_steps)

    def types(self) -> dict[str, int]:
        """Atom type of each species."""
        return {species.name: number for number, species in enumerate(self.species, start=1)}

    def atom_types(self) -> list[int]:
        """Atom type of each particle."""
        types = enumerate(self.species, start=1)
        return [number for number, species in types for _ in range(species.count)]

    def particle_interactions(self) -> tuple[Interaction, ...]:
        """Interactions between species."""
        return tuple(i for i in self.interactions if FLUID not in (i.first, i.second))

    def fluid_interactions(self) -> dict[str, PairPotential]:
        """The potential of each species that interacts with the fluid."""
        return {i.first: i.potential for i in self.interactions if i.second == FLUID}

    def drive_variables(self) -> dict[str, list[Drive]]:
        """The drives that each variable of the deck holds, all of its magnitude."""
        variables: dict[str, list[Drive]] = {}
        for drive in self.drives:
            variables.setdefault(drive.variable, []).append(drive)
        return variables

    def drives_on(self, target: str) -> Iterator[Drive]:
        """The drives on a species, or on the `FLUID`."""
        return (drive for drive in self.drives if drive.target == target)

    def walls_on(self, axis: int) -> tuple[Wall, ...]:
        """The walls across an axis."""
        return tuple(wall for wall in self.walls if wall.axis == axis)

    def _each(self, attribute: str) -> Array:
        values: list[Any] = [getattr(species, attribute) for species in self.species]
        return np.repeat(np.array(values, dtype=float), [s.count for s in self.species])

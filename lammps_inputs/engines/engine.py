"""What an engine says of a system before it runs, and what it writes of one."""

from abc import ABC, abstractmethod
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

from lammps_inputs.initial_state import InitialState
from lammps_inputs.system import SIZES, Coupling, Motion, PairPotential, System, WallPotential


@dataclass(frozen=True)
class Start:
    """Where a deck starts: from `state.data` at step 0, or from a checkpoint at its step."""

    step: int = 0
    checkpoint: str | None = None


class Engine(ABC):
    """An engine: the parts that it knows, and what else keeps it from running a system.

    Attributes:
        name: on the command line.
        plugin: whether LAMMPS needs our compiled styles for each of its decks.
        processes: whether it runs under mpirun.
        pair_potentials, wall_potentials, motions: classes of the parts that it knows.
        reactions: whether it lets colours react.
        rests: whether it can let a system rest before the run.
        couplings: of species to a solvent that it knows.
        tells_flow: whether it tells the flow of the fluid on a grid.
        scales: whether a solvent may have cells of another edge than a0, and not be of kBT.
    """

    name: ClassVar[str]
    plugin: ClassVar[bool] = False
    processes: ClassVar[bool] = True
    pair_potentials: ClassVar[tuple[type[PairPotential], ...]]
    wall_potentials: ClassVar[tuple[type[WallPotential], ...]]
    motions: ClassVar[tuple[type[Motion], ...]]
    reactions: ClassVar[bool] = False
    rests: ClassVar[bool] = False
    couplings: ClassVar[tuple[Coupling, ...]] = ("force",)
    tells_flow: ClassVar[bool] = False
    scales: ClassVar[bool] = False

    @abstractmethod
    def problems(self, system: System) -> Iterator[str]:
        """What it cannot do of a system, one line each: field or part, value, what is allowed."""

    def warnings(self, system: System) -> Iterator[str]:
        """What it does inaccurately, one line each."""
        yield from ()

    def needs_plugin(self, system: System) -> bool:
        """Whether LAMMPS needs our compiled styles for a system."""
        return self.plugin

    def seeds(self, seed: int, step: int) -> dict[str, int]:
        """Its random seeds, by name, for a start at a step."""
        return {"seed": seed}

    def unknown_parts(self, system: System) -> Iterator[str]:
        """One line for each part of a class that the engine does not know."""
        for interaction in system.interactions:
            if not isinstance(interaction.potential, self.pair_potentials):
                pair = f"{interaction.first} and {interaction.second}"
                yield f"{interaction.potential!r} between {pair}: engine {self.name} has no such"
        for wall in system.walls:
            for name, potential in wall.potentials:
                if not isinstance(potential, self.wall_potentials):
                    yield f"{potential!r} of a wall for {name}: engine {self.name} has no such"
        if not isinstance(system.motion, self.motions):
            yield f"{system.motion!r}: engine {self.name} has no such motion"
        if system.reactions and not self.reactions:
            yield f"{system.reactions!r}: engine {self.name} has no such"
        if system.rest and not self.rests:
            yield f"{system.rest!r}: engine {self.name} has no rest before the run"
        if system.flow and not self.tells_flow:
            yield f"{system.flow!r}: engine {self.name} tells no flow field"
        if system.solvent and system.solvent.coupling not in self.couplings:
            known = " or ".join(self.couplings)
            yield f"coupling = {system.solvent.coupling!r}: engine {self.name} has {known} only"
        if system.solvent and not self.scales:
            for part in ("cell", "temperature"):
                value = getattr(system.solvent, part)
                if value != 1:
                    yield f"{part} of the solvent = {value!r}: engine {self.name} has 1 only"

    def no_moving_walls(self, system: System) -> Iterator[str]:
        """A line for each wall that moves."""
        for wall in system.walls:
            if any(wall.velocity):
                yield (
                    f"wall {wall.side} across the {SIZES[wall.axis]}: engine {self.name} has none "
                    f"that move, here by {wall.velocity}"
                )

    def no_balanced_drives(self, system: System) -> Iterator[str]:
        """A line for each drive that the fluid balances, or removal of the drift it leaves."""
        for drive in system.drives:
            if drive.balanced:
                yield f"{drive.variable} of {drive.target}: engine {self.name} cannot balance it"

    def what_single_has_not(self, system: System) -> Iterator[str]:
        """A line for each property of a fluid that is in double precision only."""
        fluid = system.solvent
        if not fluid or fluid.precision == "double":
            return
        if fluid.hydrodynamics != "on":
            yield f"precision = 'single': needs hydrodynamics = 'on', not {fluid.hydrodynamics!r}"
        if fluid.coupling != "force":
            yield f"precision = 'single': needs coupling = 'force', not {fluid.coupling!r}"

    def needs_known_tables(self, system: System, known: Collection[str]) -> Iterator[str]:
        """A line for each table with a column that the engine does not tell."""
        for output in system.outputs:
            unknown = [name for name in output.columns if name not in known]
            if output.kind == "table" and unknown:
                yield f"{output.file}: engine {self.name} does not tell {', '.join(unknown)}"

    def needs_solvent(self, system: System) -> Iterator[str]:
        """A line where there is no fluid."""
        if system.solvent is None:
            yield f"engine = {self.name!r}: it is a fluid, and the scene has none"

    def needs_walls_or_periodic(self, system: System) -> Iterator[str]:
        """A line for each axis that is neither periodic nor between two walls."""
        for axis, periodic in enumerate(system.box.periodic):
            sides = sorted(wall.side for wall in system.walls_on(axis))
            if sides != ([] if periodic else ["lower", "upper"]):
                yield (
                    f"walls across the {SIZES[axis]}: engine {self.name} needs periodic axes, or a "
                    "wall on either side"
                )

    def needs_slit_or_periodic(self, system: System) -> Iterator[str]:
        """A line for each axis that is neither periodic nor, across y, between two walls."""
        for axis, periodic in enumerate(system.box.periodic):
            sides = sorted(wall.side for wall in system.walls_on(axis))
            if sides != ([] if periodic else ["lower", "upper"]) or (sides and axis != 1):
                yield (
                    f"walls across the {SIZES[axis]}: engine {self.name} needs periodic axes, or "
                    "across the width a wall on either side"
                )


class LammpsEngine(Engine):
    """An engine that LAMMPS runs: the lines of its decks, section by section.

    `deck.py` has the order of the sections. Lines have no newline; an empty line parts blocks.
    """

    @abstractmethod
    def atoms(self, system: System, start: Start) -> Iterator[str]:
        """Atom style, the state, groups."""

    @abstractmethod
    def interactions(self, system: System) -> Iterator[str]:
        """Pair styles, neighbours, ghosts."""

    @abstractmethod
    def motion(self, system: System) -> Iterator[str]:
        """What moves and pulls the particles, and walls and drives."""

    def preparation(self, system: System, start: Start) -> Iterator[str]:
        """What comes before step 0."""
        yield from ()

    def renewal(self, system: System) -> Sequence[str]:
        """Commands at each output, after which the run is set up anew as where it is resumed.

        None where a run goes on to the last bit without them.
        """
        return ()

    def solvent(self, system: System, start: Start) -> Iterator[str]:
        """The fluid."""
        yield from ()

    @abstractmethod
    def averages(self, system: System, start: Start) -> Iterator[str]:
        """The variables that tables average, and what computes profiles."""

    @abstractmethod
    def write(self, system: System, state: InitialState, title: str, directory: Path) -> None:
        """What the input script reads."""

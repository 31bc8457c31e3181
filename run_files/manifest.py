"""`manifest.json`: all that analysis needs to know of a run, its system part by part."""

import math
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from run_files.manifest_0_1 import from_narrows_0_1
from run_files.names import FileName
from run_files.progress import is_begun
from run_files.reading import Part, RunDirectoryError, checked, read_json, read_toml, refuse

FORMAT = 2  # of the manifest; narrows 0.1 wrote no number
NAME = "manifest.json"
FLUID = "fluid"
VARIABLES = "variables.json"
SCENE = "scene.toml"
CHANGEABLE = {"duration"}  # fields: a run may be resumed to last longer
CHANGED_BY_DECK = ("total_steps", "sample_steps")  # entries of the clock in variables.json

Positive = Annotated[float, Field(gt=0)]
Count = Annotated[int, Field(gt=0, lt=2**63)]
Whole = Annotated[int, Field(ge=0, lt=2**63)]
Word = Annotated[str, Field(pattern=r"^[A-Za-z_][A-Za-z0-9_]*$", max_length=100)]
Vector = tuple[float, float, float]


class Box(Part):
    """Edges [a0], and which axes are periodic."""

    sizes: tuple[Positive, ...] = Field(min_length=2, max_length=3)
    periodic: tuple[bool, ...]

    @model_validator(mode="after")
    def _same_length(self) -> Self:
        if len(self.periodic) != len(self.sizes):
            raise ValueError("sizes and periodic must have an entry for each axis")
        return self

    @property
    def dimensions(self) -> int:
        """Number of space dimensions."""
        return len(self.sizes)


class Clock(Part):
    """Steps, and the time of one [t0]."""

    time_step: Positive
    steps_per_collision: Count
    sample_steps: Count
    look_steps: Count
    equilibration_steps: Whole
    total_steps: Count

    @model_validator(mode="after")
    def _whole_looks(self) -> Self:
        if self.sample_steps % self.look_steps:
            raise ValueError("sample_steps must be a multiple of look_steps")
        return self


class Species(Part):
    """Particles of one kind."""

    name: Word
    count: Whole
    mass: Positive
    radius: Annotated[float, Field(ge=0)]
    inertia: Annotated[float, Field(ge=0)] = 0.0


class Interaction(Part):
    """A potential between two species, or one and the fluid; `potential` names class and fields."""

    first: Word
    second: Word
    potential: dict[str, Any]


class Wall(Part):
    """A wall at one end of an axis."""

    axis: Annotated[int, Field(ge=0, le=2)]
    side: Literal["lower", "upper"]
    potentials: tuple[tuple[Word, dict[str, Any]], ...]
    velocity: Vector = (0.0, 0.0, 0.0)


class Drive(Part):
    """A constant acceleration, magnitude [a0/t0^2] times direction, of a species or the fluid.

    A balanced one is that of the fluid too, in the other direction, by the mass of both.
    """

    target: Word
    magnitude: float
    direction: Vector
    variable: Word
    balanced: bool = False


class Rest(Part):
    """A time at rest before step 0."""

    steps: Whole
    temperature: Positive


class Solvent(Part):
    """The MPC fluid; viscosity_theory is null where kinetic theory has none [a0^2/t0]."""

    particles: Count
    density: Positive
    collision_time: Positive
    angle: float
    rotation: str
    hydrodynamics: str
    thermostat: str
    shear_wave: float
    coupling: Literal["force", "reflection", "cell"] = "force"
    drift_interval: Whole = 0
    cell: Positive = 1.0
    temperature: Positive = 1.0
    precision: Literal["double", "single"] = "double"
    viscosity_theory: float | None


class Reactions(Part):
    """Reactions of colours, at the walls of an axis or about the first so many particles."""

    probabilities: tuple[Annotated[float, Field(gt=0, le=1)], ...] = Field(min_length=1)
    axis: Annotated[int, Field(ge=0, le=2)] | None
    centers: Whole
    cutoff: Annotated[float, Field(ge=0)]


class FlowField(Part):
    """The grid of the flow of the fluid, and what it is about; 0: the laboratory."""

    bins: tuple[Count, ...] = Field(min_length=2, max_length=3)
    samples: Count
    around: Whole = 0


class Output(Part):
    """A file of the run, and its columns beside the step."""

    file: FileName
    kind: Literal["trajectory", "table", "profile", "flow"]
    columns: tuple[str, ...]


class System(Part):
    """The parts of a system, as `lammps_inputs/system.py` has them."""

    box: Box
    clock: Clock
    species: tuple[Species, ...]
    interactions: tuple[Interaction, ...]
    walls: tuple[Wall, ...]
    drives: tuple[Drive, ...]
    motion: dict[str, Any]
    rest: Rest | None = None
    solvent: Solvent | None
    reactions: Reactions | None = None
    flow: FlowField | None = None
    outputs: tuple[Output, ...]
    measures: tuple[Word, ...]

    @model_validator(mode="after")
    def _parts_fit(self) -> Self:
        names = [species.name for species in self.species]
        _require_different("species", names)
        _require_different("outputs", [output.file for output in self.outputs])
        known = {*names, FLUID}
        named = [name for i in self.interactions for name in (i.first, i.second)]
        named += [drive.target for drive in self.drives]
        named += [name for wall in self.walls for name, _ in wall.potentials]
        for name in named:
            if name not in known:
                raise ValueError(f"{name}: no such species; there is {', '.join(sorted(known))}")
        for wall in self.walls:
            if wall.axis >= self.box.dimensions or self.box.periodic[wall.axis]:
                raise ValueError(f"a wall across axis {wall.axis}, which is periodic or none")
        if self.flow and len(self.flow.bins) != self.box.dimensions:
            raise ValueError(
                f"flow: bins along {len(self.flow.bins)} axes of {self.box.dimensions}"
            )
        reacting = self.reactions.axis if self.reactions else None
        if reacting is not None and reacting not in [wall.axis for wall in self.walls]:
            raise ValueError(f"reactions at walls of axis {reacting}: it has none")
        return self


def _require_different(what: str, names: list[str]) -> None:
    if len(set(names)) < len(names):
        raise ValueError(f"{what}: a name stands twice in {', '.join(names)}")


class Manifest(Part):
    """What a run is."""

    format: Literal[2]
    engine: Word
    scene: Annotated[str, Field(max_length=100)]
    fields: dict[str, Any]
    units: dict[str, str]
    si_units: dict[str, Positive] = Field(default_factory=dict)  # a0, t0, m_f, kBT, or none
    system: System
    seeds: dict[str, int]
    versions: dict[str, str] = Field(default_factory=dict)
    command: str = ""
    ranks: int = 1


def read_manifest(directory: Path) -> Manifest:
    """The manifest of a run directory, as the deck ran: `lmp -var` wins over what the scene said.

    Raises:
        RunDirectoryError: when it is missing, damaged, or of a version that cannot be read.
    """
    path = directory / NAME
    if not directory.is_dir():
        refuse(directory, "no such directory")
    if not path.is_file():
        raise RunDirectoryError(f"{directory}: not a run directory, {NAME} is missing")
    content = read_json(path)
    version = content.get("format")
    if version is None:
        try:
            content = from_narrows_0_1(content)
        except (LookupError, TypeError, AttributeError, ValueError, ArithmeticError) as error:
            refuse(path, f"neither of this narrows nor of 0.1: {error!r}")
    elif version != FORMAT:
        refuse(
            path,
            f"format {version!r}: of a newer narrows; this one reads format 2, and narrows 0.1",
        )
    manifest = checked(Manifest, content, path)
    if (directory / SCENE).is_file():
        _require_same_scene(manifest, read_toml(directory / SCENE), path)
    variables = directory / VARIABLES
    by_hand = variables.is_file() and not is_begun(directory)  # narrows itself changes nothing
    return _with_variables(manifest, variables) if by_hand else manifest


def _require_same_scene(manifest: Manifest, scene: dict[str, Any], path: Path) -> None:
    told = {"scene": manifest.scene} | manifest.fields
    for name in (told.keys() | scene.keys()) - CHANGEABLE:
        if told.get(name) != scene.get(name):
            refuse(path, f"{name} = {told.get(name)!r}, but {scene.get(name)!r} in {SCENE}")


def _with_variables(manifest: Manifest, path: Path) -> Manifest:
    values = read_json(path)
    for name, value in values.items():
        if not isinstance(value, int | float) or not math.isfinite(value):
            refuse(path, f"{name}: must be a number")
    content = manifest.model_dump()
    for name in CHANGED_BY_DECK:
        if name in values:
            content["system"]["clock"][name] = values[name]
    for drive in content["system"]["drives"]:
        drive["magnitude"] = values.get(drive["variable"], drive["magnitude"])
    return checked(Manifest, content, path)

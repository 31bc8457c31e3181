"""A run directory, opened for analysis: `docs/run-directory.md` is the format."""

import json
import math
import re
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import MDAnalysis
import numpy as np
from numpy.typing import NDArray

from analysis.colloid_trajectory import ColloidTrajectory

Array = NDArray[np.float64]
Steps = NDArray[np.int64]

MANIFEST_KEYS = ("scene", "engine", "fields", "dimension", "fluid_particles", "colloids")
MANIFEST_COUNTS = ("steps_per_collision", "sample_steps", "fluid_looks", "total_steps")


class RunDirectoryError(ValueError):
    """A directory that cannot be analysed; the message is one line that names the file."""


@dataclass(frozen=True)
class Observables:
    """Averages over each sampling interval.

    Attributes:
        steps: last engine step of each interval, (K,).
        fluid_temperature: without the streaming profile, (K,) [kBT].
        mean_velocity_x: P_t / M_t of (4.9), (K,) [a0/t0].
    """

    steps: Steps
    fluid_temperature: Array
    mean_velocity_x: Array


@dataclass(frozen=True)
class FluidProfile:
    """The fluid by bins of y, averages over each sampling interval.

    Attributes:
        steps: last engine step of each interval, (K,).
        y: bin centres, (bins,) [a0].
        counts: particles in each bin, (K, bins).
        velocity_x: their mean velocity along x, (K, bins) [a0/t0].
    """

    steps: Steps
    y: Array
    counts: Array
    velocity_x: Array


@dataclass(frozen=True)
class Colloids:
    """The colloids at every sampled step, the first at step 0.

    Attributes:
        steps: engine steps, (T,).
        positions: unwrapped, from the lower corner of the box, (T, N, d) [a0].
        velocities: (T, N, d) [a0/t0].
    """

    steps: Steps
    positions: Array
    velocities: Array


class RunDirectory:
    """Reads the files of one run; each is read when first asked for.

    A run still in progress, or cut off while it wrote, is read up to its last complete frame or
    interval. A deck run by hand leaves no `progress.json`: then LAMMPS's log tells the wall time.

    Args:
        path: of the directory.

    Raises:
        RunDirectoryError: when it is no run directory or its manifest lacks what analysis needs.
    """

    def __init__(self, path: str | Path) -> None:
        path = Path(path)
        if not path.is_dir():
            raise RunDirectoryError(f"{path}: no such directory")
        if not (path / "manifest.json").is_file():
            raise RunDirectoryError(f"{path}: not a run directory, manifest.json is missing")
        self.path = path
        self.manifest = self._read_json("manifest.json")
        for key in MANIFEST_KEYS:
            self._require(key in self.manifest, key, "is missing")
        self._require(isinstance(self.manifest["fields"], dict), "fields", "is not a table")
        self._require(self.manifest["dimension"] in (2, 3), "dimension", "must be 2 or 3")
        self._adopt_variables()
        for key in MANIFEST_COUNTS:
            value = self.manifest.get(key)
            self._require(isinstance(value, int) and value > 0, key, "must be a positive integer")
        equilibration = self.manifest.get("equilibration_steps")
        self._require(
            isinstance(equilibration, int) and equilibration >= 0,
            "equilibration_steps",
            "must be an integer, 0 or more",
        )
        step = self.manifest.get("time_step")
        self._require(
            isinstance(step, int | float) and math.isfinite(step) and step > 0,
            "time_step",
            "must be a positive number",
        )

    def _adopt_variables(self) -> None:
        """What `lmp -var` made of the deck's variables wins over what the scene said."""
        if (self.path / "variables.json").is_file():
            variables = self._read_json("variables.json")
            if "gravity" in variables:
                self.manifest["fields"]["gravity"] = variables.pop("gravity")
            self.manifest |= variables

    def _require(self, holds: bool, key: str, problem: str) -> None:
        if not holds:
            raise RunDirectoryError(f"{self.path / 'manifest.json'}: {key} {problem}")

    def _read_json(self, name: str) -> dict[str, Any]:
        try:
            content = json.loads((self.path / name).read_text(encoding="utf-8"))
        except (OSError, UnicodeDecodeError, json.JSONDecodeError) as error:
            raise RunDirectoryError(f"{self.path / name}: {error}") from None
        if not isinstance(content, dict):
            raise RunDirectoryError(f"{self.path / name}: not a JSON object")
        return content

    def field(self, name: str) -> Any:
        """A field of the scene.

        Raises:
            RunDirectoryError: when the manifest does not have it.
        """
        fields = self.manifest["fields"]
        self._require(name in fields, f"fields.{name}", "is missing")
        return fields[name]

    def number(self, name: str) -> float:
        """A field of the scene that is a number.

        Raises:
            RunDirectoryError: when the manifest does not have it, or it is none.
        """
        value = self.field(name)
        is_number = isinstance(value, int | float) and math.isfinite(value)
        self._require(is_number, f"fields.{name}", "must be a number")
        return float(value)

    @property
    def time_step(self) -> float:
        """Time of one engine step [t0]."""
        return float(self.manifest["time_step"])

    @property
    def interval(self) -> float:
        """The sampling interval [t0]."""
        return float(self.manifest["sample_steps"]) * self.time_step

    @property
    def fluid_looks(self) -> int:
        """Evenly spaced looks at the fluid that each average is made of."""
        return int(self.manifest["fluid_looks"])

    @property
    def viscosity_theory(self) -> float | None:
        """Kinematic viscosity of the fluid by kinetic theory, where there is one [a0^2/t0]."""
        theory = self.manifest.get("viscosity_theory")
        return None if theory is None else float(theory)

    @property
    def equilibration_steps(self) -> int:
        """Engine steps at the start that averages leave out."""
        return int(self.manifest["equilibration_steps"])

    @property
    def equilibration_time(self) -> float:
        """Time at the start that averages leave out [t0]."""
        return self.equilibration_steps * self.time_step

    def times(self, steps: Steps) -> Array:
        """Time of engine steps [t0]."""
        return np.asarray(steps * self.time_step, dtype=float)

    def sampled(self, steps: Steps) -> NDArray[np.bool_]:
        """Which of the intervals that end at these steps lie after the equilibration.

        Raises:
            RunDirectoryError: when none does.
        """
        used = steps - int(self.manifest["sample_steps"]) >= self.equilibration_steps
        if not used.any():
            raise RunDirectoryError(
                f"{self.path}: no frames after the equilibration: it ends at step "
                f"{self.equilibration_steps}, the output at step {steps[-1]}"
            )
        return np.asarray(used)

    @property
    def has_colloids(self) -> bool:
        """Whether the scene has colloids, and so a trajectory."""
        return int(self.manifest["colloids"]) > 0

    @cached_property
    def progress(self) -> dict[str, Any]:
        """`progress.json`, empty for a deck run by hand."""
        if not (self.path / "progress.json").exists():
            return {}
        return self._read_json("progress.json")

    def wall_seconds(self) -> float | None:
        """Wall time of the run: from `progress.json`, else from LAMMPS's log, else None [s]."""
        if "wall_seconds" in self.progress:
            return float(self.progress["wall_seconds"])
        log = self.path / "log.lammps"
        text = log.read_text(encoding="utf-8", errors="replace") if log.is_file() else ""
        found = re.search(r"^Total wall time: (\d+):(\d\d):(\d\d)", text, re.MULTILINE)
        if not found:
            return None
        hours, minutes, seconds = map(float, found.groups())
        return 3600 * hours + 60 * minutes + seconds

    def finished(self) -> bool:
        """Whether the run came to its end, as `progress.json` or else its last output says."""
        if "finished" in self.progress:
            return bool(self.progress["finished"])
        return bool(self.observables.steps[-1] >= self.manifest["total_steps"])

    @cached_property
    def observables(self) -> Observables:
        """`observables.dat`.

        Raises:
            RunDirectoryError: when it is missing, malformed, empty or has gaps.
        """
        name = "observables.dat"
        wanted = ["TimeStep", "v_fluid_temperature", "v_mean_velocity_x"]
        columns, count, numbers = self._read_table(name, "TimeStep", wanted)
        table = self._reshape(name, numbers, count)[:, columns]
        steps = self._check_steps(name, table[:, 0], first=self.manifest["sample_steps"])
        return Observables(steps, table[:, 1], table[:, 2])

    @cached_property
    def fluid_profile(self) -> FluidProfile:
        """`fluid_profile.dat`.

        Raises:
            RunDirectoryError: when it is missing, malformed, empty or has gaps.
        """
        name = "fluid_profile.dat"
        wanted = ["Coord1", "Ncount", "vx"]
        columns, count, numbers = self._read_table(name, "Chunk Coord1", wanted)
        if len(numbers) < 3:
            raise RunDirectoryError(f"{self.path / name}: no complete sampling interval yet")
        bins = int(numbers[1])  # each interval: step, number of bins, particles; then the bins
        rows = self._reshape(name, numbers, 3 + bins * count)
        if bins < 2 or np.any(rows[:, 1] != bins):
            raise RunDirectoryError(f"{self.path / name}: the number of bins is not constant")
        table = rows[:, 3:].reshape(len(rows), bins, count)
        y, counts, velocity = (table[:, :, column] for column in columns)
        steps = self._check_steps(name, rows[:, 0], first=self.manifest["sample_steps"])
        return FluidProfile(steps, y[0], counts, velocity)

    def universe(self) -> MDAnalysis.Universe:
        """The colloids as an MDAnalysis Universe: wrapped positions, masses, time from the step.

        `ts.data` holds the step and the image counts `ix iy iz`. `totaltime` is wrong, because
        MDAnalysis takes frames for consecutive steps; `ts.time` is right.

        Raises:
            RunDirectoryError: when the trajectory is missing, malformed or has no complete frame.
        """
        name = "trajectory.lammpsdump"
        self._require_file(name)
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", message="Guessed all Masses")
            warnings.filterwarnings("ignore", message="Some of the additional columns")
            try:
                universe = MDAnalysis.Universe(
                    str(self.path / name),
                    dt=self.time_step,
                    additional_columns=["ix", "iy", "iz"],
                )
                first = universe.trajectory[0]
            except (OSError, ValueError, IndexError, EOFError, KeyError):
                raise RunDirectoryError(f"{self.path / name}: no complete frame yet") from None
        if not first.has_velocities or not {"ix", "iy", "iz"} <= first.data.keys():
            raise RunDirectoryError(
                f"{self.path / name}: the columns must be id type x y z vx vy vz ix iy iz"
            )
        universe.atoms.masses = self.manifest.get("colloid_mass") or 1.0
        return universe

    @cached_property
    def colloids(self) -> Colloids:
        """All complete frames of `trajectory.lammpsdump`.

        Raises:
            RunDirectoryError: as `universe`, or when frames are malformed or have gaps.
        """
        name = "trajectory.lammpsdump"
        universe = self.universe()
        # MDAnalysis takes a last line without its newline, so a number cut short, for complete
        with (self.path / name).open("rb") as file:
            lines = sum(chunk.count(b"\n") for chunk in iter(lambda: file.read(1 << 20), b""))
        frames = lines // (universe.atoms.n_atoms + 9)
        if frames == 0:
            raise RunDirectoryError(f"{self.path / name}: no complete frame yet")
        walk = ColloidTrajectory(universe, self.manifest["dimension"])
        try:
            results = walk.run(stop=frames).results
        except (ValueError, IndexError) as error:
            raise RunDirectoryError(f"{self.path / name}: malformed frame: {error}") from None
        if not (np.isfinite(results.positions).all() and np.isfinite(results.velocities).all()):
            raise RunDirectoryError(f"{self.path / name}: holds numbers that are not finite")
        steps = self._check_steps(name, results.steps, first=0)
        return Colloids(steps, results.positions, results.velocities)

    def _require_file(self, name: str) -> None:
        if not (self.path / name).is_file():
            raise RunDirectoryError(f"{self.path / name}: missing")

    def _read_table(
        self, name: str, mark: str, wanted: Sequence[str]
    ) -> tuple[list[int], int, Array]:
        """Where the wanted columns of a LAMMPS output file are, of how many, and all its numbers.

        The comment line that holds `mark` names the columns. A last line that is cut short is left
        out.
        """
        self._require_file(name)
        try:
            text = (self.path / name).read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise RunDirectoryError(f"{self.path / name}: {error}") from None
        lines = text[: text.rfind("\n") + 1].splitlines()
        comments = [line[1:] for line in lines if line.startswith("#")]
        names = next((line.split() for line in comments if mark in line), [])
        for column in wanted:
            if column not in names:
                raise RunDirectoryError(f"{self.path / name}: no column {column}")
        data = "\n".join(line for line in lines if not line.startswith("#"))
        with warnings.catch_warnings():
            warnings.simplefilter("error", DeprecationWarning)
            try:
                numbers = np.fromstring(data, sep=" ") if data else np.empty(0)
            except (ValueError, DeprecationWarning):  # which one depends on numpy's version
                raise RunDirectoryError(f"{self.path / name}: holds text among numbers") from None
        if not np.all(np.isfinite(numbers)):
            raise RunDirectoryError(f"{self.path / name}: holds numbers that are not finite")
        return [names.index(column) for column in wanted], len(names), numbers

    def _reshape(self, name: str, numbers: Array, columns: int) -> Array:
        """Complete rows of a table of so many columns; a last, incomplete one is dropped."""
        rows = len(numbers) // columns
        if rows == 0:
            raise RunDirectoryError(f"{self.path / name}: no complete sampling interval yet")
        return numbers[: rows * columns].reshape(rows, columns)

    def _check_steps(self, name: str, steps: Sequence[float] | NDArray[Any], first: int) -> Steps:
        """The steps as integers, when they start at the first and leave no gap."""
        found = np.asarray(steps).astype(np.int64)
        expected = first + int(self.manifest["sample_steps"]) * np.arange(len(found))
        wrong = np.flatnonzero(found != expected)
        if len(wrong):
            raise RunDirectoryError(
                f"{self.path / name}: step {expected[wrong[0]]} expected, "
                f"step {found[wrong[0]]} found"
            )
        return found

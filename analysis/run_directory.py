"""A run directory, opened for analysis: `docs/run-directory.md` is the format."""

import math
import re
from collections.abc import Sequence
from functools import cached_property
from pathlib import Path
from typing import Any

import MDAnalysis
import numpy as np
from numpy.typing import NDArray

from analysis.arrays import Array
from analysis.averages_file import AveragesFile
from analysis.flow_grid import FlowField, flow_columns
from analysis.particle_trajectory import SPINS, open_trajectory, read_frames
from analysis.run_outputs import Bins, Particles, Profile, Steps, Table
from run_files import RunDirectoryError
from run_files.manifest import Box, Clock, Output, Solvent, Species, read_manifest
from run_files.progress import Progress, is_begun, read_progress
from run_files.reading import refuse

BOX_PRECISION = 1e-5  # MDAnalysis keeps edges in float32


class RunDirectory:
    """Reads the files of one run; each is read when first asked for.

    A run still in progress, or cut off while it wrote, is read up to its last complete frame or
    interval. A deck run by hand leaves no `progress.json`: then LAMMPS's log tells the wall time.

    Args:
        path: of the directory.

    Attributes:
        path: of the directory.
        manifest: what the run is, as its deck ran.

    Raises:
        RunDirectoryError: when it is no run directory, or its manifest is damaged.
    """

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        self.manifest = read_manifest(self.path)
        self._bins: dict[tuple[str, ...], Bins] = {}
        self._tables: dict[str, Table] = {}
        self._particles: dict[str, Particles] = {}

    @property
    def box(self) -> Box:
        """The box."""
        return self.manifest.system.box

    @property
    def length(self) -> float:
        """Edge of the box along x [a0]."""
        return self.box.sizes[0]

    @property
    def width(self) -> float:
        """Edge of the box along y [a0]."""
        return self.box.sizes[1]

    @property
    def clock(self) -> Clock:
        """Steps and times."""
        return self.manifest.system.clock

    @property
    def solvent(self) -> Solvent:
        """The fluid.

        Raises:
            RunDirectoryError: when there is none.
        """
        if self.manifest.system.solvent is None:
            raise RunDirectoryError(f"{self.path}: the scene {self.manifest.scene} has no fluid")
        return self.manifest.system.solvent

    def species(self, name: str | None = None) -> Species:
        """The species of that name; without a name, the only one.

        Raises:
            RunDirectoryError: when there is no such, or not just one.
        """
        known = self.manifest.system.species
        chosen = [each for each in known if name in (None, each.name)]
        if len(chosen) != 1:
            names = ", ".join(each.name for each in known) or "none"
            wanted = f"a species {name}" if name else "one species"
            raise RunDirectoryError(f"{self.path}: {wanted} is needed; there is {names}")
        return chosen[0]

    def acceleration(self, target: str) -> Array:
        """Sum of the drives on a species, or on `fluid`, as the deck ran, (3,) [a0/t0^2]."""
        total = np.zeros(3)
        for drive in self.manifest.system.drives:
            if drive.target == target:
                total += drive.magnitude * np.array(drive.direction)
        return total

    @property
    def time_step(self) -> float:
        """Time of one engine step [t0]."""
        return self.clock.time_step

    @property
    def interval(self) -> float:
        """The sampling interval [t0]."""
        return self.clock.sample_steps * self.clock.time_step

    @property
    def looks(self) -> int:
        """Evenly spaced looks at the fluid that each average is made of."""
        return self.clock.sample_steps // self.clock.look_steps

    @property
    def equilibration_steps(self) -> int:
        """Engine steps at the start that averages leave out."""
        return self.clock.equilibration_steps

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
        used = steps - self.clock.sample_steps >= self.equilibration_steps
        if not used.any():
            raise RunDirectoryError(
                f"{self.path}: no frames after the equilibration: it ends at step "
                f"{self.equilibration_steps}, the output at step {steps[-1]}"
            )
        return np.asarray(used)

    @property
    def equilibration_frames(self) -> int:
        """Frames of the trajectory, the first at step 0, that the equilibration takes."""
        return math.ceil(self.equilibration_steps / self.clock.sample_steps)

    @cached_property
    def progress(self) -> Progress | None:
        """How far a driven run is; None for a deck run by hand.

        Raises:
            RunDirectoryError: when the file is damaged.
        """
        if not is_begun(self.path):
            return None
        progress = read_progress(self.path)
        if progress.finished and progress.step < self.clock.total_steps:
            refuse(self.path, f"finished at step {progress.step} of {self.clock.total_steps}")
        return progress

    def _checked(self, name: str) -> Path:
        """The path of an output, once it begins with what it held at the newest checkpoint.

        Raises:
            RunDirectoryError: when it is missing or damaged.
        """
        path = self.path / name
        if not path.is_file():
            refuse(path, "missing")
        return self.progress.require(self.path, name) if self.progress else path

    def wall_seconds(self) -> float | None:
        """Wall time of the run: from `progress.json`, else from LAMMPS's log, else None [s]."""
        if self.progress:
            return self.progress.wall_seconds
        log = self.path / "log.lammps"
        text = log.read_text(encoding="utf-8", errors="replace") if log.is_file() else ""
        found = re.search(r"^Total wall time: (\d+):(\d\d):(\d\d)", text, re.MULTILINE)
        if not found:
            return None
        hours, minutes, seconds = map(float, found.groups())
        return 3600 * hours + 60 * minutes + seconds

    def finished(self) -> bool:
        """Whether the run came to its end, as `progress.json` or else its last output says."""
        step = self.progress.step if self.progress else self._last_step()
        return step >= self.clock.total_steps

    def simulated_time(self) -> float:
        """Time up to the last output [t0]."""
        return self._last_step() * self.time_step

    def _last_step(self) -> int:
        return int(self.table(self._first_table().file.partition(".")[0]).steps[-1])

    def _first_table(self) -> Output:
        for output in self.manifest.system.outputs:
            if output.kind == "table":
                return output
        raise RunDirectoryError(f"{self.path / 'manifest.json'}: no table among outputs")

    def _output(self, name: str, kind: str) -> Output:
        """The output whose file has that name, without its ending."""
        for output in self.manifest.system.outputs:
            if output.file.partition(".")[0] == name and output.kind == kind:
                return output
        kept = ", ".join(output.file for output in self.manifest.system.outputs)
        hint = ""
        if kind == "trajectory":
            hint = (
                ": it has no particles, or did not keep them (flow_interval keeps the flow of a "
                "fluid, narrows analyze draws it)"
            )
        wanted = kind if name == kind else f"{kind} {name}"
        raise RunDirectoryError(f"{self.path}: no {wanted} among its outputs {kept}{hint}")

    def table(self, name: str = "observables") -> Table:
        """An output of kind `table`, by the name of its file.

        Raises:
            RunDirectoryError: when it is missing, malformed, empty or has gaps.
        """
        if name not in self._tables:
            self._tables[name] = self._read_table_output(self._output(name, "table"))
        return self._tables[name]

    def _read_table_output(self, output: Output) -> Table:
        wanted = ["TimeStep", *(f"v_{column}" for column in output.columns)]
        table = self._averages(output.file, "TimeStep").table(wanted)
        steps = self._check_steps(output.file, table[:, 0], first=self.clock.sample_steps)
        return Table(steps, dict(zip(output.columns, table[:, 1:].T, strict=True)))

    def profile(self, name: str = "fluid_profile") -> Profile:
        """A profile of the fluid, by the name of its file.

        Raises:
            RunDirectoryError: as `bins`.
        """
        read = self.bins(name, ("Ncount", "vx"))
        return Profile(read.steps, read.positions, read["Ncount"], read["vx"])

    def bins(self, name: str, columns: Sequence[str] | None = None) -> Bins:
        """An output of kind `profile`, by the name of its file.

        Args:
            columns: those wanted; default: all that the manifest names.

        Raises:
            RunDirectoryError: when it is missing, malformed, empty or has gaps.
        """
        output = self._output(name, "profile")
        wanted = [each for each in columns or output.columns if each != "Coord1"]
        if (name, *wanted) not in self._bins:
            self._bins[name, *wanted] = self._read_bins(output.file, wanted)
        return self._bins[name, *wanted]

    def _read_bins(self, name: str, wanted: list[str]) -> Bins:
        steps, table = self._averages(name, "Chunk Coord1").bins(["Coord1", *wanted])
        positions, *values = np.moveaxis(table, -1, 0)
        checked = self._check_steps(name, steps, first=self.clock.sample_steps)
        return Bins(checked, positions[0], dict(zip(wanted, values, strict=True)))

    def _averages(self, name: str, mark: str) -> AveragesFile:
        return AveragesFile.read(self._checked(name), mark)

    def field(self, name: str = "flow") -> FlowField:
        """The flow of the fluid on a grid, by the name of its file.

        Raises:
            RunDirectoryError: when there is none, or it is malformed, empty or has gaps.
        """
        grid = self.manifest.system.flow
        if grid is None:
            raise RunDirectoryError(f"{self.path}: no flow field was asked for (flow_interval)")
        file = self._output(name, "flow").file
        steps, table = self._averages(file, "Chunk Coord1").bins(flow_columns(len(grid.bins)))
        if table.shape[1] != math.prod(grid.bins):
            wanted = math.prod(grid.bins)
            refuse(self.path / file, f"{table.shape[1]} bins; the manifest says {wanted}")
        expected = grid.samples * self.clock.sample_steps * np.arange(1, len(steps) + 1)
        if np.any(steps != expected):
            wrong = int(np.flatnonzero(steps != expected)[0])
            refuse(self.path / file, f"step {expected[wrong]} expected, {steps[wrong]:g} found")
        return FlowField.of_table(expected, table, grid.bins)

    def flow_used(self, field: FlowField) -> NDArray[np.bool_]:
        """Which averages of a flow field lie after the equilibration, (K,).

        Raises:
            RunDirectoryError: when none does.
        """
        every = int(field.steps[0])
        used = field.steps - every >= self.equilibration_steps
        if not used.any():
            raise RunDirectoryError(
                f"{self.path}: no average of the flow lies after the equilibration, which ends at "
                f"step {self.equilibration_steps}; each is over {every} steps"
            )
        return np.asarray(used)

    def universe(self, name: str = "trajectory") -> MDAnalysis.Universe:
        """The particles as an MDAnalysis Universe: wrapped positions, masses, radii, right times.

        `ts.data` holds the step and the image counts `ix iy iz`. `totaltime` is wrong, because
        MDAnalysis takes frames for consecutive steps; `ts.time` is right.

        Raises:
            RunDirectoryError: when the trajectory is missing, malformed or has no complete frame.
        """
        output = self._output(name, "trajectory")
        path = self._checked(output.file)
        universe = open_trajectory(path, self.time_step, _spinning(output))
        expected = sum(species.count for species in self.manifest.system.species)
        if universe.atoms.n_atoms != expected:
            refuse(path, f"{universe.atoms.n_atoms} particles; the manifest says {expected}")
        edges = np.diagonal(universe.trajectory.ts.triclinic_dimensions)
        for edge, size in zip(edges, self.box.sizes, strict=False):
            if abs(edge - size) > BOX_PRECISION * size:
                refuse(path, f"a box edge of {edge:g}; the manifest says {size:g}")
        universe.atoms.masses = self._each_particle("mass")
        universe.add_TopologyAttr("radii", self._each_particle("radius"))
        return universe

    def _each_particle(self, attribute: str) -> list[Any]:
        """An attribute of each particle's species, (N,): particles are numbered by species."""
        species = self.manifest.system.species
        return [getattr(each, attribute) for each in species for _ in range(each.count)]

    def particles(self, name: str = "trajectory") -> Particles:
        """All complete frames of an output of kind `trajectory`, by the name of its file.

        Raises:
            RunDirectoryError: as `universe`, or when frames are malformed or have gaps.
        """
        if name not in self._particles:
            self._particles[name] = self._read_particles(name)
        return self._particles[name]

    def _read_particles(self, trajectory: str) -> Particles:
        output = self._output(trajectory, "trajectory")
        universe = self.universe(trajectory)
        results = read_frames(universe, self.box.dimensions, _spinning(output))
        steps = self._check_steps(output.file, results.steps, first=0)
        species = np.array(self._each_particle("name"))
        return Particles(steps, results.positions, results.velocities, species, results.spins)

    def _check_steps(self, name: str, steps: Sequence[float] | NDArray[Any], first: int) -> Steps:
        """The steps as integers, when they start at the first and leave no gap."""
        given = np.asarray(steps)
        if not np.all(np.abs(given) < 2**53):
            refuse(self.path / name, "a step that is no step")
        found = given.astype(np.int64)
        expected = first + self.clock.sample_steps * np.arange(len(found))
        wrong = np.flatnonzero((found != expected) | (found != given))
        if len(wrong):
            raise RunDirectoryError(
                f"{self.path / name}: step {expected[wrong[0]]} expected, "
                f"step {given[wrong[0]]:.17g} found"
            )
        self._check_end(name, int(found[-1]))
        return found

    def _check_end(self, name: str, last: int) -> None:
        """That the output goes as far as the run: to its end, or to what else tells of it."""
        total, sample = self.clock.total_steps, self.clock.sample_steps
        least, most = 0, total
        if self.progress:
            least = self.progress.step
        elif name != self._first_table().file:
            # a deck run by hand writes all outputs of a step, one after the other
            end = self._last_step()
            least, most = end if end >= total else end - sample, min(total, end + sample)
        if not least <= last <= most:
            now = least if last < least else most
            refuse(self.path / name, f"ends at step {last}; the run is at step {now} of {total}")


def _spinning(output: Output) -> bool:
    """Whether a trajectory holds angular velocities."""
    return set(SPINS) <= set(output.columns)

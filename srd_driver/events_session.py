"""Hard spheres from event to event, with the files that every run has; resumes bit for bit."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from lammps_inputs import Scene
from lammps_inputs.color_outputs import color_outputs
from lammps_inputs.system import TRAJECTORY, Array, Output, System
from run_files.fluid_file import Fluid
from run_files.progress import Progress
from run_files.writing import replacing
from srd_driver.dump import write_frame
from srd_driver.errors import RunError
from srd_driver.events import (
    EventError,
    HardSpheres,
    PairReactions,
    Profile,
    WallReactions,
)
from srd_driver.events.initial import thermal_velocities
from srd_driver.events.state import SPEED_BIN


class EventsSession:
    """The engine of events at work: a step is a look at the colours, at a set time."""

    suffix = "npz"
    lammps = None

    def __init__(self, scene: Scene, directory: Path, progress: Progress) -> None:
        self._directory = directory
        self._system, self._clock = scene.system, scene.system.clock
        self._outputs = {output.file: output for output in self._system.outputs}
        self.step = progress.step
        if progress.checkpoint:
            try:
                self._engine = HardSpheres.load(directory / progress.checkpoint)
            except EventError as error:
                raise RunError(str(error)) from None
        else:
            self._engine = _engine(self._system, scene.seed)
            for output in self._outputs.values():
                if output.kind != "trajectory":
                    (directory / output.file).write_text(_title(output), encoding="utf-8")
        self._write_frame()

    @property
    def colloid_positions(self) -> Array:
        return self._engine.positions

    @property
    def colloid_velocities(self) -> Array:
        return self._engine.velocities

    def fluid(self) -> Fluid:
        raise RunError("engine events: has no fluid")

    def mean_colloid_position(self) -> float:
        engine = self._engine
        return float((engine.positions + engine.images * engine.lengths)[:, 0].mean())

    def advance(self, steps: int) -> None:
        for _ in range(steps // self._clock.sample_steps):
            self._sample()

    def save(self, file: str) -> None:
        with replacing(self._directory / file) as draft:
            self._engine.save(draft)

    def close(self) -> None:
        pass

    def _sample(self) -> None:
        """One sampling interval."""
        engine, clock = self._engine, self._clock
        before = (engine.collisions, engine.virial, engine.wall_momentum)
        for _ in range(clock.looks):
            self.step += clock.look_steps
            engine.advance_to(self.step * clock.time_step)
            engine.sample()
        time = clock.sample_steps * clock.time_step
        averages = _averages(engine, before, time)
        for output in self._outputs.values():
            if set(output.columns) <= averages.keys():
                self._append(output, [averages[name] for name in output.columns])
        if self._system.reactions:
            self._write_colors(engine.take_profile())
        self._write_frame()

    def _write_colors(self, profile: Profile) -> None:
        kinds = profile.composition.shape[2]
        colors, reactions, speeds = color_outputs(kinds)
        looks = profile.samples
        by_bin = np.stack([*profile.composition, *profile.current], axis=-1) / looks
        self._append_bins(
            colors,
            profile.positions,
            [profile.number / looks, *by_bin.reshape(len(profile.number), 4 * kinds).T],
        )
        by_kind = profile.reactions.reshape(4, kinds).T  # labels and chances of either surface
        self._append(reactions, [*profile.hits, *by_kind.ravel()])
        bins = profile.speeds.shape[2]
        self._append_bins(
            speeds,
            SPEED_BIN * np.arange(0.5, bins),
            list(profile.speeds.transpose(1, 0, 2).reshape(2 * kinds, bins)),
        )

    def _append(self, output: Output, row: Sequence[float]) -> None:
        with (self._directory / output.file).open("a", encoding="utf-8") as file:
            file.write(f"{self.step} {' '.join(f'{value:.10g}' for value in row)}\n")

    def _append_bins(self, output: Output, positions: Array, columns: Sequence[Array]) -> None:
        with (self._directory / output.file).open("a", encoding="utf-8") as file:
            file.write(f"{self.step} {len(positions)} {columns[0].sum():.10g}\n")
            rows = np.column_stack([np.arange(1, len(positions) + 1), positions, *columns])
            np.savetxt(file, rows, fmt="  %d" + " %.8g" * (1 + len(columns)))

    def _write_frame(self) -> None:
        if TRAJECTORY.file in self._outputs:
            engine = self._engine
            write_frame(
                self._directory / TRAJECTORY.file,
                self.step,
                self._system,
                (engine.positions, engine.velocities, engine.images),
            )


def _engine(system: System, seed: int) -> HardSpheres:
    """The start of a system: its placement, Maxwell velocities of exactly kBT = 1."""
    (kind,) = system.species
    box, reactions = system.box, system.reactions
    walls = tuple(sorted({wall.axis for wall in system.walls}))
    assert system.placement is not None, "there are particles"
    surfaces: WallReactions | PairReactions | None = None
    if reactions and reactions.axis is not None:
        surfaces = WallReactions(reactions.probabilities, reactions.axis)
    elif reactions:
        centers = range(reactions.centers)
        surfaces = PairReactions(reactions.probabilities, centers, reactions.cutoff)
    return HardSpheres(
        system.placement.positions(box, system.species, seed),
        thermal_velocities(kind.count, box.dimensions, walls, 1.0, seed),
        box.sizes,
        walls,
        diameter=2 * kind.radius,
        reactions=surfaces,
        seed=seed,
    )


def _averages(
    engine: HardSpheres, before: tuple[int, float, Array], time: float
) -> dict[str, float]:
    """Averages over a stretch of time, from what the engine has counted since."""
    count, dimensions = engine.velocities.shape
    collisions, virial, momentum = before
    values = {
        "temperature": 2 * engine.energy() / (dimensions * count),
        "collision_rate": 2 * (engine.collisions - collisions) / (count * time),
        "compressibility": 1 + (engine.virial - virial) / (dimensions * count * time),
    }
    for axis in engine.walls[:1]:
        area = float(np.prod(np.delete(engine.lengths, axis)))
        lower, upper = (engine.wall_momentum - momentum)[axis] / (area * time)
        values |= {"lower_pressure": float(lower), "upper_pressure": float(upper)}
    return values


def _title(output: Output) -> str:
    """The head of LAMMPS's files of this kind."""
    if output.kind == "table":
        columns = " ".join(f"v_{name}" for name in output.columns)
        return (
            f"# Time-averaged data for fix {output.file.partition('.')[0]}\n# TimeStep {columns}\n"
        )
    return (
        f"# Averages by bins: {output.file.partition('.')[0]}\n"
        "# Timestep Number-of-bins Total\n"
        f"# Chunk {' '.join(output.columns)}\n"
    )

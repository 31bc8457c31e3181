"""The numpy reference engine, writing the files that LAMMPS would write."""

from pathlib import Path

import numpy as np

from lammps_inputs import Scene
from lammps_inputs.system import FLUID_PROFILE, SPINNING_TRAJECTORY, TRAJECTORY, Array
from run_files.fluid_file import Fluid
from run_files.progress import Progress
from run_files.writing import replacing
from srd_driver.dump import write_frame
from srd_driver.reference import ReferenceEngine, SingleEngine, SuspensionEngine


class ReferenceSession:
    """The reference engine with the output of docs/run-directory.md; resumes bit for bit."""

    suffix = "npz"
    lammps = None

    def __init__(self, scene: Scene, directory: Path, progress: Progress) -> None:
        self._scene = scene
        self._directory = directory
        solvent = scene.system.solvent
        by_force = solvent is None or solvent.coupling == "force"
        engine = ReferenceEngine if by_force else SuspensionEngine
        if solvent and solvent.precision == "single":
            engine = SingleEngine
        (self._table,) = (each for each in scene.system.outputs if each.kind == "table")
        if progress.checkpoint:
            self._engine = engine.load(scene, directory / progress.checkpoint)
        else:
            self._engine = engine(scene)
            self._write_titles()
        self.step = progress.step
        self._system, self._clock = scene.system, scene.system.clock
        self._box = scene.system.box
        self._width = self._box.sizes[1]
        self._bins = 2 * round(self._width)
        self._write_frame()

    @property
    def colloid_positions(self) -> Array:
        return self._engine.colloid_positions

    @property
    def colloid_velocities(self) -> Array:
        return self._engine.colloid_velocities

    def fluid(self) -> Fluid:
        engine = self._engine
        return Fluid(engine.fluid_positions.copy(), engine.fluid_velocities.copy())

    def mean_colloid_position(self) -> float:
        engine = self._engine
        images = engine.colloid_images[:, 0]
        unwrapped = engine.colloid_positions[:, 0] + images * self._box.sizes[0]
        return float(unwrapped.mean())

    def advance(self, steps: int) -> None:
        for _ in range(steps // self._clock.sample_steps):
            self._sample()

    def save(self, file: str) -> None:
        with replacing(self._directory / file) as draft:
            self._engine.save(draft)

    def close(self) -> None:
        pass

    def _sample(self) -> None:
        """One sampling interval: as many looks at the fluid as the deck takes, averaged."""
        looks = self._clock.looks
        every = self._clock.look_steps // self._clock.steps_per_collision
        count, momentum, squares = np.zeros((3, self._bins))
        averages = np.zeros(len(self._table.columns))
        for _ in range(looks):
            self._engine.advance(every)
            velocity = self._engine.fluid_velocities
            y = self._engine.fluid_positions[:, 1]
            layer = np.minimum((y * (self._bins / self._width)).astype(int), self._bins - 1)
            count += np.bincount(layer, minlength=self._bins)
            momentum += np.bincount(layer, velocity[:, 0], self._bins)
            squares += np.bincount(layer, (velocity**2).sum(axis=1), self._bins)
            values = self._engine.averages()
            averages += np.array([values[column] for column in self._table.columns]) / looks
        self.step += self._clock.sample_steps

        depth = self._width / self._bins
        volume = depth * self._box.sizes[0] * np.prod(self._box.sizes[2:])
        occupied = np.maximum(count, 1)
        columns = np.column_stack(
            [
                np.arange(1, self._bins + 1),
                depth * (np.arange(self._bins) + 0.5),
                count / looks,
                count / looks / volume,
                momentum / occupied,
                squares / (occupied * self._box.dimensions),
            ]
        )
        with (self._directory / FLUID_PROFILE.file).open("a", encoding="utf-8") as file:
            file.write(f"{self.step} {self._bins} {count.sum() / looks:g}\n")
            np.savetxt(file, columns, fmt="  %d %g %g %g %.6g %.6g")
        with (self._directory / self._table.file).open("a", encoding="utf-8") as file:
            file.write(" ".join([str(self.step), *(f"{value:.8g}" for value in averages)]) + "\n")
        self._write_frame()

    def _write_frame(self) -> None:
        engine = self._engine
        spinning = SPINNING_TRAJECTORY in self._system.outputs
        if len(engine.colloid_positions):
            write_frame(
                self._directory / TRAJECTORY.file,
                self.step,
                self._system,
                (engine.colloid_positions, engine.colloid_velocities, engine.colloid_images),
                getattr(engine, "colloid_spins", None) if spinning else None,
            )

    def _write_titles(self) -> None:
        columns = " ".join(f"v_{column}" for column in self._table.columns)
        for name, title in (
            (
                FLUID_PROFILE.file,
                "# Chunk-averaged data for fix profile and group fluid\n"
                "# Timestep Number-of-chunks Total-count\n"
                "# Chunk Coord1 Ncount density/number vx temp\n",
            ),
            (
                self._table.file,
                f"# Time-averaged data for fix observables\n# TimeStep {columns}\n",
            ),
        ):
            (self._directory / name).write_text(title, encoding="utf-8")

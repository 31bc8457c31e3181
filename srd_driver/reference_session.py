"""The numpy reference engine, writing the files that LAMMPS would write."""

from pathlib import Path

import numpy as np

from lammps_inputs import Scene
from srd_driver.reference import ReferenceEngine
from srd_driver.run_directory import Progress
from srd_driver.session import Array


class ReferenceSession:
    """The reference engine with the output of docs/run-directory.md; resumes bit for bit."""

    suffix = "npz"

    def __init__(self, scene: Scene, directory: Path, progress: Progress) -> None:
        self._scene = scene
        self._directory = directory
        if progress.checkpoint:
            self._engine = ReferenceEngine.load(scene, directory / progress.checkpoint)
        else:
            self._engine = ReferenceEngine(scene)
        self.step = progress.step
        self._bins = 2 * round(scene.width)
        for name, title in _TITLES.items():
            if not (directory / name).exists():
                (directory / name).write_text(title, encoding="utf-8")
        self._write_frame()

    @property
    def colloid_positions(self) -> Array:
        return self._engine.colloid_positions

    @property
    def colloid_velocities(self) -> Array:
        return self._engine.colloid_velocities

    def mean_colloid_position(self) -> float:
        engine = self._engine
        unwrapped = engine.colloid_positions[:, 0] + engine.colloid_images * self._scene.length
        return float(unwrapped.mean())

    def advance(self, steps: int) -> None:
        for _ in range(steps // self._scene.sample_steps):
            self._sample()

    def save(self, file: str) -> None:
        draft = self._directory / f".{file}"
        self._engine.save(draft)
        draft.replace(self._directory / file)

    def close(self) -> None:
        pass

    def _sample(self) -> None:
        """One sampling interval: as many looks at the fluid as the deck takes, averaged."""
        looks = self._scene.fluid_looks
        every = self._scene.collisions_per_sample // looks
        count, momentum, squares = np.zeros((3, self._bins))
        temperature = mean_velocity = 0.0
        for _ in range(looks):
            self._engine.advance(every)
            velocity = self._engine.fluid_velocities
            y = self._engine.fluid_positions[:, 1]
            layer = np.minimum((y * (self._bins / self._scene.width)).astype(int), self._bins - 1)
            count += np.bincount(layer, minlength=self._bins)
            momentum += np.bincount(layer, velocity[:, 0], self._bins)
            squares += np.bincount(layer, (velocity**2).sum(axis=1), self._bins)
            temperature += self._engine.fluid_temperature() / looks
            mean_velocity += float(self._engine.mean_velocity()[0]) / looks
        self.step += self._scene.sample_steps

        depth = self._scene.width / self._bins
        volume = depth * self._scene.length * np.prod(self._scene.box[2:])
        occupied = np.maximum(count, 1)
        columns = np.column_stack(
            [
                np.arange(1, self._bins + 1),
                depth * (np.arange(self._bins) + 0.5),
                count / looks,
                count / looks / volume,
                momentum / occupied,
                squares / (occupied * self._scene.dimensions),
            ]
        )
        with (self._directory / "fluid_profile.dat").open("a", encoding="utf-8") as file:
            file.write(f"{self.step} {self._bins} {count.sum() / looks:g}\n")
            np.savetxt(file, columns, fmt="  %d %g %g %g %.6g %.6g")
        with (self._directory / "observables.dat").open("a", encoding="utf-8") as file:
            file.write(f"{self.step} {temperature:.8g} {mean_velocity:.8g}\n")
        self._write_frame()

    def _write_frame(self) -> None:
        if not self._scene.colloids:
            return
        engine = self._engine
        number = np.arange(1, self._scene.colloids + 1)
        zero = np.zeros(len(number))
        columns = np.column_stack(
            [
                number,
                np.ones(len(number)),
                engine.colloid_positions,
                zero,
                engine.colloid_velocities,
                zero,
                engine.colloid_images,
                zero,
                zero,
            ]
        )
        with (self._directory / "trajectory.lammpsdump").open("a", encoding="utf-8") as file:
            file.write(
                f"ITEM: TIMESTEP\n{self.step}\nITEM: NUMBER OF ATOMS\n{len(number)}\n"
                "ITEM: BOX BOUNDS pp ff pp\n"
                f"0 {self._scene.length!r}\n0 {self._scene.width!r}\n-0.5 0.5\n"
                "ITEM: ATOMS id type x y z vx vy vz ix iy iz\n"
            )
            np.savetxt(file, columns, fmt="%d %d " + 6 * "%.10g " + "%d %d %d")


_TITLES = {
    "fluid_profile.dat": (
        "# Chunk-averaged data for fix profile and group fluid\n"
        "# Timestep Number-of-chunks Total-count\n"
        "# Chunk Coord1 Ncount density/number vx temp\n"
    ),
    "observables.dat": (
        "# Time-averaged data for fix observables\n"
        "# TimeStep v_fluid_temperature v_mean_velocity_x\n"
    ),
}

"""The particles of a run: its trajectory as MDAnalysis opens it, and the arrays of every frame."""

import warnings
from pathlib import Path
from typing import Any

import MDAnalysis
import numpy as np
from MDAnalysis.analysis.base import AnalysisBase

from run_files.reading import refuse

SPINS = ("omegax", "omegay", "omegaz")
HEADER_LINES = 9  # of a frame


def open_trajectory(path: Path, time_step: float, spinning: bool) -> MDAnalysis.Universe:
    """A LAMMPS dump as an MDAnalysis Universe; `ts.data` holds the images, and spins if spinning.

    Raises:
        RunDirectoryError: when it is malformed, lacks columns or has no complete frame.
    """
    columns = ["ix", "iy", "iz", *(SPINS if spinning else ())]
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Guessed all Masses")
        warnings.filterwarnings("ignore", message="Some of the additional columns")
        try:
            universe = MDAnalysis.Universe(str(path), dt=time_step, additional_columns=columns)
            first = universe.trajectory[0]
        except (OSError, ValueError, IndexError, EOFError, KeyError):
            refuse(path, "no complete frame yet")
    if not first.has_velocities or not {"ix", "iy", "iz"} <= first.data.keys():
        refuse(path, "the columns must be id type x y z vx vy vz ix iy iz")
    return universe


def read_frames(universe: MDAnalysis.Universe, dimension: int, spinning: bool) -> Any:
    """`ParticleTrajectory.results` of all complete frames of what `open_trajectory` opened.

    Raises:
        RunDirectoryError: when a frame is malformed or there is no complete one.
    """
    path = Path(universe.filename)
    # MDAnalysis takes a last line without its newline, so a number cut short, for complete
    with path.open("rb") as file:
        lines = sum(chunk.count(b"\n") for chunk in iter(lambda: file.read(1 << 20), b""))
    frames = lines // (universe.atoms.n_atoms + HEADER_LINES)
    if frames == 0:
        refuse(path, "no complete frame yet")
    try:
        results = ParticleTrajectory(universe, dimension, spinning).run(stop=frames).results
    except (ValueError, IndexError, KeyError) as error:
        refuse(path, f"malformed frame: {error}")
    read = (results.positions, results.velocities, *([results.spins] if spinning else []))
    if not all(np.isfinite(values).all() for values in read):
        refuse(path, "holds numbers that are not finite")
    return results


class ParticleTrajectory(AnalysisBase):  # type: ignore[misc]  # MDAnalysis has no types
    """Collects the particles of each frame in float64.

    MDAnalysis keeps positions in float32. Wrapped ones are therefore unwrapped here, with the image
    counts: far down a long channel its own unwrapping would lose digits.

    Args:
        universe: of a `trajectory.lammpsdump`, as `RunDirectory.universe` opens it, with image
            counts as additional columns `ix iy iz`.
        dimension: space dimensions d, 2 or 3.
        spinning: whether `omegax omegay omegaz` are additional columns too.

    After `run()`, `results` holds:
        steps: engine steps, (T,).
        positions: unwrapped centres, from the lower corner of the box, (T, N, d) [a0]. In a sheared
            box images are counted as if it were not: modulo its edges they are right.
        velocities: (T, N, d) [a0/t0].
        spins: angular velocities, (T, N, 3) [1/t0]; None unless spinning.
    """

    def __init__(self, universe: Any, dimension: int, spinning: bool = False) -> None:
        super().__init__(universe.trajectory)
        self._atoms = universe.atoms
        self._dimension = dimension
        self._spinning = spinning

    def _prepare(self) -> None:
        shape = (self.n_frames, self._atoms.n_atoms, self._dimension)
        self.results.steps = np.empty(self.n_frames, dtype=np.int64)
        self.results.positions = np.empty(shape)
        self.results.velocities = np.empty(shape)
        self.results.spins = np.empty((*shape[:2], 3)) if self._spinning else None

    def _single_frame(self) -> None:
        frame, axes = self._frame_index, slice(0, self._dimension)
        data = self._ts.data
        images = np.column_stack([data[axis] for axis in ("ix", "iy", "iz")])[:, axes]
        box = np.diagonal(self._ts.triclinic_dimensions)[axes].astype(float)
        self.results.steps[frame] = data["step"]
        self.results.positions[frame] = self._atoms.positions[:, axes] + images * box
        self.results.velocities[frame] = self._atoms.velocities[:, axes]
        if self._spinning:
            self.results.spins[frame] = np.column_stack([data[name] for name in SPINS])

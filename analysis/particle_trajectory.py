"""The particles of a run: unwrapped positions and velocities of every frame."""

from typing import Any

import numpy as np
from MDAnalysis.analysis.base import AnalysisBase

SPINS = ("omegax", "omegay", "omegaz")


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

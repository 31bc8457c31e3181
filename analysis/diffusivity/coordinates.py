"""The coordinate along which particles diffuse: z of a slit, y of a channel, a pair distance."""

from typing import Any, Protocol

import MDAnalysis
import numpy as np
from MDAnalysis.coordinates.memory import MemoryReader
from MDAnalysis.lib.distances import distance_array

from analysis.arrays import Array
from analysis.diffusivity.errors import DiffusivityError


class Coordinate(Protocol):
    """One number for each walker, a particle or a pair, in every frame."""

    trajectory: Any

    def values(self) -> Array:
        """In the present frame, (walkers,)."""


class AlongAxis:
    """The position of each particle along an axis with walls.

    Args:
        atoms: MDAnalysis AtomGroup.
        axis: "x", "y" or "z".
    """

    def __init__(self, atoms: Any, axis: str = "z") -> None:
        if axis not in ("x", "y", "z"):
            raise DiffusivityError(f"axis: {axis!r}; it must be 'x', 'y' or 'z'")
        if len(atoms) == 0:
            raise DiffusivityError("atoms: the group is empty")
        self.trajectory = atoms.universe.trajectory
        self._atoms = atoms
        self._column = "xyz".index(axis)

    def values(self) -> Array:
        return np.asarray(self._atoms.positions[:, self._column], dtype=float)


class PairDistance:
    """The distance of each particle from each central particle, nearest images.

    Args:
        atoms: MDAnalysis AtomGroup of the particles.
        centers: AtomGroup of the central particles; a particle is not paired with itself.
    """

    def __init__(self, atoms: Any, centers: Any) -> None:
        if len(atoms) == 0 or len(centers) == 0:
            raise DiffusivityError("atoms and centers: neither group may be empty")
        self.trajectory = atoms.universe.trajectory
        self._atoms, self._centers = atoms, centers
        self._paired = (centers.indices[:, None] != atoms.indices[None, :]).ravel()
        if not self._paired.any():
            raise DiffusivityError("atoms and centers: there is no pair")

    def values(self) -> Array:
        box = self._atoms.dimensions
        distances = distance_array(self._centers.positions, self._atoms.positions, box=box)
        return np.asarray(distances.ravel()[self._paired], dtype=float)


class Recorded:
    """A coordinate that is known already, as of walkers of several runs side by side.

    Args:
        values: of each walker in each frame, (T, walkers).
        interval: between frames.
    """

    def __init__(self, values: Array, interval: float) -> None:
        if values.ndim != 2 or values.size == 0:
            raise DiffusivityError(f"values: {values.shape}; they must be (frames, walkers)")
        if not 0 < interval < np.inf:
            raise DiffusivityError(f"interval: {interval:g}; it must be positive")
        frames = MDAnalysis.Universe.empty(1, trajectory=True)
        nowhere = np.zeros((len(values), 1, 3), dtype=np.float32)
        frames.load_new(nowhere, format=MemoryReader, dt=interval)
        self.trajectory = frames.trajectory
        self._values = values

    def values(self) -> Array:
        return np.asarray(self._values[self.trajectory.frame])

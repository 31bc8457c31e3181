"""A wall that pushes a sphere away as it is pressed into it."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lammps_inputs.system import Array


@dataclass(frozen=True)
class HarmonicWall:
    """k (R - y)^2 / 2 where a sphere of radius R overlaps a wall at the distance y, else zero.

    Attributes:
        radius: R, of the spheres [a0].
        stiffness: k [kBT/a0^2].
    """

    radius: float
    stiffness: float

    def energy(self, y: ArrayLike) -> Array:
        """Energy at distances y > 0 of the centre (any shape) [kBT]."""
        overlap = np.maximum(self.radius - np.asarray(y, dtype=float), 0.0)
        return np.asarray(0.5 * self.stiffness * overlap**2)

    def force(self, y: ArrayLike) -> Array:
        """Force away from the wall at distances y > 0 [kBT/a0]."""
        overlap = np.maximum(self.radius - np.asarray(y, dtype=float), 0.0)
        return np.asarray(self.stiffness * overlap)

    def wall_fix(self, name: str, group: str, faces: Sequence[str]) -> str:
        """At these faces (`zlo`): `fix wall/harmonic`, whose energy is epsilon (r - rc)^2."""
        strength = 0.5 * self.stiffness
        ends = " ".join(f"{face} EDGE {strength!r} 1.0 {self.radius!r}" for face in faces)
        return f"fix {name} {group} wall/harmonic {ends}"

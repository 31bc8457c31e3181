"""The repulsion of a wall of particles, cut and shifted at its minimum."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lammps_inputs.system import Array


@dataclass(frozen=True)
class IntegratedWall:
    """The 12-6 potential of a line of wall particles, integrated along the wall: 11-5.

    U(y) = (3 pi strength / 2) [21/32 (sigma/y)^11 - (sigma/y)^5 + 6/11 (160/231)^(5/6)] below its
    minimum at sigma (231/160)^(1/6), zero beyond (tabatabaei-2009 3.35, 3.36 corrected). The
    strength is q times the energy scale, q wall particles per sigma (3.31).
    """

    sigma: float
    strength: float = 1.0

    table_points = 4096
    table_inner = 0.4  # in units of sigma: an energy of 7e4 strength, out of thermal reach

    @property
    def cutoff(self) -> float:
        """Distance of the minimum, the sixth root of 231/160 times sigma [a0]."""
        return float(self.sigma * (231 / 160) ** (1 / 6))

    @property
    def _shift(self) -> float:
        return float(6 / 11 * (160 / 231) ** (5 / 6))

    @property
    def stiffness(self) -> float:
        """Second derivative of the energy where it begins, at the cutoff [kBT/a0^2]."""
        return -self._slope(self.cutoff)

    def energy(self, y: ArrayLike) -> Array:
        """Energy at distances y > 0 from the wall (any shape) [kBT]."""
        y = np.asarray(y, dtype=float)
        u = self.sigma / y
        energy = 1.5 * math.pi * self.strength * (21 / 32 * u**11 - u**5 + self._shift)
        return np.where(y < self.cutoff, energy, 0.0)

    def force(self, y: ArrayLike) -> Array:
        """Force away from the wall at distances y > 0 [kBT/a0] (3.49)."""
        y = np.asarray(y, dtype=float)
        u = self.sigma / y
        force = 7.5 * math.pi * self.strength * (231 / 160 * u**11 - u**5) / y
        return np.where(y < self.cutoff, force, 0.0)

    def wall_fix(self, name: str, group: str, faces: Sequence[str]) -> str:
        """The compiled wall at these faces (`ylo`): `fix wall/lj115` of lammps_plugin."""
        ends = " ".join(f"{face} EDGE {self.strength!r} {self.sigma!r}" for face in faces)
        return f"fix {name} {group} wall/lj115 {ends}"

    def table_fix(self, name: str, group: str, faces: Sequence[str], file: str) -> str:
        """The tabulated wall at these faces: `fix wall/table`, cubic splines of `table_text`."""
        ends = " ".join(f"{face} EDGE {file} WALL {self.cutoff!r}" for face in faces)
        return f"fix {name} {group} wall/table spline {self.table_points} {ends}"

    def table_text(self) -> str:
        """The table file of `table_fix`: distance, energy and force."""
        y = np.linspace(self.table_inner * self.sigma, self.cutoff, self.table_points)
        force = self.force(y)
        rows = zip(y, self.energy(y), force, strict=True)
        lines = [f"{i} {a:.16g} {b:.16g} {c:.16g}" for i, (a, b, c) in enumerate(rows, start=1)]
        header = [
            "# 11-5 wall potential: index, distance, energy, force",
            "WALL",
            f"N {self.table_points} FP {self._slope(y[0])!r} {self._slope(y[-1])!r}",
            "",
        ]
        return "\n".join([*header, *lines, ""])

    def _slope(self, y: float) -> float:
        u = self.sigma / y
        slope = 7.5 * math.pi * self.strength * (-12 * 231 / 160 * u**11 + 6 * u**5) / y**2
        return float(slope)

"""The potentials of the colloids, each once: numpy energy and force beside its LAMMPS lines.

All are purely repulsive: cut at their minimum and shifted to zero there, so that energy and force
are continuous. Distances in a0, energies in kBT.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class RepulsiveMie:
    """4 eps [(sigma/r)^2n - (sigma/r)^n + 1/4] below its minimum, zero beyond.

    n = 6 is the 12-6 colloid-fluid repulsion (tabatabaei-2009 3.42), n = 24 the 48-24
    colloid-colloid repulsion (3.43).
    """

    sigma: float
    exponent: int
    epsilon: float = 1.0

    @property
    def cutoff(self) -> float:
        """Distance of the minimum, 2^(1/n) sigma [a0]."""
        return float(2 ** (1 / self.exponent) * self.sigma)

    def energy(self, r: ArrayLike) -> Array:
        """Energy at distances r > 0 (any shape) [kBT]."""
        r = np.asarray(r, dtype=float)
        u = (self.sigma / r) ** self.exponent
        return np.where(r < self.cutoff, 4 * self.epsilon * (u * u - u + 0.25), 0.0)

    def force(self, r: ArrayLike) -> Array:
        """Radial force -dU/dr, positive when repulsive, at distances r > 0 [kBT/a0] (3.28)."""
        r = np.asarray(r, dtype=float)
        u = (self.sigma / r) ** self.exponent
        force = 4 * self.epsilon * self.exponent * (2 * u * u - u) / r
        return np.where(r < self.cutoff, force, 0.0)

    def force_over_distance(self, r_squared: Array) -> Array:
        """F(r)/r at squared distances [kBT/a0^2]: times the separation it is the force vector."""
        u = (self.sigma**2 / r_squared) ** (self.exponent / 2)
        force = 4 * self.epsilon * self.exponent * (2 * u * u - u) / r_squared
        return np.where(r_squared < self.cutoff**2, force, 0.0)

    def pair_coeff(self, types: str) -> str:
        """The `pair_coeff` line of `pair_style mie/cut` for the two atom types.

        `mie/cut` with exponents 2n and n has the prefactor 4; with `pair_modify shift yes` and
        the cut at the minimum it is this potential.
        """
        return (
            f"pair_coeff {types} {self.epsilon!r} {self.sigma!r} "
            f"{2 * self.exponent} {self.exponent} {self.cutoff!r}"
        )


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

    def wall_fix(self, name: str, group: str) -> str:
        """The compiled wall at both y faces: `fix wall/lj115` of lammps_plugin."""
        faces = " ".join(f"{face} EDGE {self.strength!r} {self.sigma!r}" for face in ("ylo", "yhi"))
        return f"fix {name} {group} wall/lj115 {faces}"

    def lepton_fix(self, name: str, group: str) -> str:
        """The exact wall at both y faces: `fix wall/lepton`, compiled at every step and so slow."""
        u = f"({self.sigma!r}/r)"
        prefactor = 1.5 * math.pi * self.strength
        energy = f"{prefactor!r}*({21 / 32!r}*{u}^11-{u}^5+{self._shift!r})"
        faces = " ".join(f'{face} EDGE "{energy}" {self.cutoff!r}' for face in ("ylo", "yhi"))
        return f"fix {name} {group} wall/lepton {faces}"

    def table_fix(self, name: str, group: str, file: str) -> str:
        """The tabulated wall at both y faces: `fix wall/table`, cubic splines of `table_text`."""
        faces = " ".join(f"{face} EDGE {file} WALL {self.cutoff!r}" for face in ("ylo", "yhi"))
        return f"fix {name} {group} wall/table spline {self.table_points} {faces}"

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

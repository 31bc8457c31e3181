"""Repulsions that are cut and shifted at their minimum: energy and force are continuous."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lammps_inputs.system import Array


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

    @property
    def title(self) -> str:
        """`48-24 repulsion`."""
        return f"{2 * self.exponent}-{self.exponent} repulsion"

    @property
    def pair_style(self) -> str:
        """The LAMMPS style."""
        return "mie/cut"

    def pair_arguments(self, cutoff: float, seed: str) -> str:
        """The cutoff."""
        return f" {cutoff!r}"

    @property
    def dissipates(self) -> bool:
        """No."""
        return False

    @property
    def pair_modify(self) -> str:
        """Arguments of `pair_modify`."""
        return "shift yes"

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

    def no_pair_coeff(self, types: str) -> str:
        """The `pair_coeff` line of two atom types that do not interact."""
        return f"pair_coeff {types} 0.0 1.0 {2 * self.exponent} {self.exponent} 0.0"

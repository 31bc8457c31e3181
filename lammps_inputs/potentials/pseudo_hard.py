"""The pseudo hard sphere: the 50-49 repulsion that has nearly the pressure of hard spheres."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lammps_inputs.system import Array

REPULSION, ATTRACTION = 50, 49
PREFACTOR = REPULSION * (REPULSION / ATTRACTION) ** ATTRACTION
TEMPERATURE = 1.5  # kBT / epsilon at which the second virial coefficient is that of hard spheres


@dataclass(frozen=True)
class PseudoHard:
    """50 (50/49)^49 epsilon [(sigma/r)^50 - (sigma/r)^49] + epsilon below 50/49 sigma, else zero.

    J. Jover et al., J. Chem. Phys. 137, 144505 (2012), at kBT = 1.5 epsilon. Energy and force are
    continuous at the cutoff.
    """

    sigma: float = 1.0
    epsilon: float = 1 / TEMPERATURE

    @property
    def cutoff(self) -> float:
        """Distance of the minimum, 50/49 sigma [a0]."""
        return self.sigma * REPULSION / ATTRACTION

    @property
    def title(self) -> str:
        """What it is, for a deck."""
        return "50-49 repulsion"

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
        u = self.sigma / r
        energy = self.epsilon * (PREFACTOR * (u**REPULSION - u**ATTRACTION) + 1)
        return np.where(r < self.cutoff, energy, 0.0)

    def force(self, r: ArrayLike) -> Array:
        """-dU/dr at distances r > 0 (any shape) [kBT/a0]."""
        r = np.asarray(r, dtype=float)
        u = self.sigma / r
        force = (
            PREFACTOR * self.epsilon / r * (REPULSION * u**REPULSION - ATTRACTION * u**ATTRACTION)
        )
        return np.where(r < self.cutoff, force, 0.0)

    def pair_coeff(self, types: str) -> str:
        """The `pair_coeff` line of two atom types; `mie/cut` has the same prefactor."""
        return (
            f"pair_coeff {types} {self.epsilon!r} {self.sigma!r} {REPULSION} {ATTRACTION} "
            f"{self.cutoff!r}"
        )

    def no_pair_coeff(self, types: str) -> str:
        """The `pair_coeff` line of two atom types that do not interact."""
        return f"pair_coeff {types} 0.0 1.0 {REPULSION} {ATTRACTION} 0.0"

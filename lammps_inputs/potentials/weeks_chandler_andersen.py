"""The repulsive part of the Lennard-Jones potential, by our compiled pair style."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from lammps_inputs.system import Array


@dataclass(frozen=True)
class WeeksChandlerAndersen:
    """epsilon (1 - 4 [(sigma/r)^6 - (sigma/r)^12]) within 2^(1/6) sigma (delhommelle-2005, II).

    Energy and force are continuous at the cutoff, the second derivative is not.
    """

    sigma: float = 1.0
    epsilon: float = 1.0

    reach: ClassVar[float] = 2 ** (1 / 6)

    @property
    def cutoff(self) -> float:
        """Distance of the minimum, 2^(1/6) sigma."""
        return self.reach * self.sigma

    def derivatives(self, r: ArrayLike) -> tuple[Array, Array, Array, Array]:
        """Energy and its first three derivatives by r at distances r > 0 (any shape)."""
        r = np.asarray(r, dtype=float)
        near = r < self.cutoff
        six = np.where(near, 4 * self.epsilon * (self.sigma / r) ** 6, 0.0)
        twelve = np.where(near, 4 * self.epsilon * (self.sigma / r) ** 12, 0.0)
        return (
            np.where(near, self.epsilon - six + twelve, 0.0),
            (6 * six - 12 * twelve) / r,
            (156 * twelve - 42 * six) / r**2,
            (336 * six - 2184 * twelve) / r**3,
        )

    def energy(self, r: ArrayLike) -> Array:
        """Energy at distances r > 0 (any shape)."""
        return self.derivatives(r)[0]

    def force(self, r: ArrayLike) -> Array:
        """-dU/dr at distances r > 0 (any shape)."""
        return -self.derivatives(r)[1]

    @property
    def title(self) -> str:
        """What it is, for a deck."""
        return "Weeks-Chandler-Andersen repulsion"

    @property
    def pair_style(self) -> str:
        """The LAMMPS style, of our plugin."""
        return "wca"

    def pair_arguments(self, cutoff: float, seed: str) -> str:
        """None: the cutoff is that of sigma."""
        return ""

    @property
    def dissipates(self) -> bool:
        """No."""
        return False

    @property
    def pair_modify(self) -> str:
        """Arguments of `pair_modify`: it ends at zero by itself."""
        return "shift no"

    def pair_coeff(self, types: str) -> str:
        """The `pair_coeff` line of two atom types."""
        return f"pair_coeff {types} {self.epsilon!r} {self.sigma!r}"

    def no_pair_coeff(self, types: str) -> str:
        """The `pair_coeff` line of two atom types that do not interact."""
        return f"pair_coeff {types} 0.0 {self.sigma!r}"

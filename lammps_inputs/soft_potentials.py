"""The repulsions of lane formation, each once: numpy derivatives beside its LAMMPS lines.

A temperature of configurations needs three derivatives (delhommelle-2005, 4 and 5). Distances in
sigma, energies in epsilon, whatever the pair's own are.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class SoftDisk:
    """epsilon (sigma/r)^12 within a cutoff, zero beyond (delhommelle-2005, II; its cutoff unsaid).

    `shifted` takes the energy at the cutoff off, so that it is continuous; the force is not, by
    12 epsilon sigma^12 / cutoff^13: 1.5e-3 at 2 sigma.
    """

    sigma: float = 1.0
    epsilon: float = 1.0
    cutoff: float = 2.0
    shifted: bool = True

    def derivatives(self, r: ArrayLike) -> tuple[Array, Array, Array, Array]:
        """Energy and its first three derivatives by r at distances r > 0 (any shape)."""
        r = np.asarray(r, dtype=float)
        u = np.where(r < self.cutoff, self.epsilon * (self.sigma / r) ** 12, 0.0)
        shift = self.epsilon * (self.sigma / self.cutoff) ** 12 if self.shifted else 0.0
        energy = np.where(r < self.cutoff, u - shift, 0.0)
        return energy, -12 * u / r, 156 * u / r**2, -2184 * u / r**3

    def pair_style(self) -> str:
        """The `pair_style` command and what belongs to it."""
        shift = "yes" if self.shifted else "no"
        return f"pair_style soft/disk {self.cutoff!r}\npair_modify shift {shift}"

    def pair_coeff(self, types: str) -> str:
        """The `pair_coeff` command for the two atom types."""
        return f"pair_coeff {types} {self.epsilon!r} {self.sigma!r}"


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

    def pair_style(self) -> str:
        """The `pair_style` command."""
        return "pair_style wca"

    def pair_coeff(self, types: str) -> str:
        """The `pair_coeff` command for the two atom types."""
        return f"pair_coeff {types} {self.epsilon!r} {self.sigma!r}"

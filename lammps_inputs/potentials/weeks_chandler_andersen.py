"""The repulsive part of the Lennard-Jones potential, by our compiled pair style."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from lammps_inputs.potentials.soft_repulsion import SoftRepulsion
from lammps_inputs.system import Array


@dataclass(frozen=True)
class WeeksChandlerAndersen(SoftRepulsion):
    """epsilon (1 - 4 [(sigma/r)^6 - (sigma/r)^12]) within 2^(1/6) sigma (delhommelle-2005, II).

    Energy and force are continuous at the cutoff, the second derivative is not.
    """

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
    def pair_modify(self) -> str:
        """Arguments of `pair_modify`: it ends at zero by itself."""
        return "shift no"

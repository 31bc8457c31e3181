"""The inverse twelfth power of soft disks, by our compiled pair style."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lammps_inputs.potentials.soft_repulsion import SoftRepulsion
from lammps_inputs.system import Array


@dataclass(frozen=True)
class SoftDisk(SoftRepulsion):
    """epsilon (sigma/r)^12 within a cutoff, zero beyond (delhommelle-2005, II; its cutoff unsaid).

    `shifted` takes the energy at the cutoff off, so that it is continuous; the force is not, by
    12 epsilon sigma^12 / cutoff^13: 1.5e-3 at 2 sigma.
    """

    cutoff: float = 2.0
    shifted: bool = True

    def derivatives(self, r: ArrayLike) -> tuple[Array, Array, Array, Array]:
        """Energy and its first three derivatives by r at distances r > 0 (any shape)."""
        r = np.asarray(r, dtype=float)
        u = np.where(r < self.cutoff, self.epsilon * (self.sigma / r) ** 12, 0.0)
        shift = self.epsilon * (self.sigma / self.cutoff) ** 12 if self.shifted else 0.0
        energy = np.where(r < self.cutoff, u - shift, 0.0)
        return energy, -12 * u / r, 156 * u / r**2, -2184 * u / r**3

    @property
    def title(self) -> str:
        """What it is, for a deck."""
        return "inverse twelfth power"

    @property
    def pair_style(self) -> str:
        """The LAMMPS style, of our plugin."""
        return "soft/disk"

    def pair_arguments(self, cutoff: float, seed: str) -> str:
        """The cutoff."""
        return f" {cutoff!r}"

    @property
    def pair_modify(self) -> str:
        """Arguments of `pair_modify`."""
        return "shift yes" if self.shifted else "shift no"

"""What our compiled pair styles of soft repulsions have in common (delhommelle-2005, II)."""

from abc import ABC, abstractmethod
from dataclasses import dataclass

from numpy.typing import ArrayLike

from lammps_inputs.system import Array


@dataclass(frozen=True)
class SoftRepulsion(ABC):
    """A repulsion with three derivatives, which the configurational temperature needs."""

    sigma: float = 1.0
    epsilon: float = 1.0

    @abstractmethod
    def derivatives(self, r: ArrayLike) -> tuple[Array, Array, Array, Array]:
        """Energy and its first three derivatives by r at distances r > 0 (any shape)."""

    def energy(self, r: ArrayLike) -> Array:
        """Energy at distances r > 0 (any shape)."""
        return self.derivatives(r)[0]

    def force(self, r: ArrayLike) -> Array:
        """-dU/dr at distances r > 0 (any shape)."""
        return -self.derivatives(r)[1]

    @property
    def dissipates(self) -> bool:
        """No."""
        return False

    def pair_coeff(self, types: str) -> str:
        """The `pair_coeff` line of two atom types."""
        return f"pair_coeff {types} {self.epsilon!r} {self.sigma!r}"

    def no_pair_coeff(self, types: str) -> str:
        """The `pair_coeff` line of two atom types that do not interact."""
        return f"pair_coeff {types} 0.0 {self.sigma!r}"

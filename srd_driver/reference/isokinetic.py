"""The Gaussian isokinetic thermostat of delhommelle-2005 (1)-(3), at rest or under shear (SLLOD).

A step is a symmetric splitting whose parts are exact, each on the constraint: F. Zhang, J. Chem.
Phys. 106, 6102 (1997); G. Pan et al., J. Chem. Phys. 122, 094114 (2005).
"""

import numpy as np

from lammps_inputs.system import Array
from srd_driver.reference.soft_pairs import SoftPairs


def constraint(particles: int, directions: int, temperature: float) -> float:
    """The sum of m v^2 for which configurations are canonical at T.

    Of n directions of N particles, the total momentum takes n and the constraint one: (1) as
    printed, n N T, gives configurations of a temperature 3/(2N) higher in 2D.
    """
    return (directions * (particles - 1) - 1) * temperature


def friction(velocities: Array, forces: Array, masses: Array) -> float:
    """The multiplier of (3) that keeps sum m v^2 [1/time]."""
    return float((forces * velocities).sum() / (masses[:, None] * velocities**2).sum())


def kick(velocities: Array, forces: Array, masses: Array, tau: float, squares: float) -> Array:
    """Velocities after a time of (2) at constant forces, the sum of m v^2 being `squares`.

    With a = F.v / 2K and b = F.F/m / 2K: v' = (v + F s/m) / (ds/dt), where
    s = (a/b) (cosh(tau sqrt b) - 1) + sinh(tau sqrt b) / sqrt b. The denominator is taken from the
    constraint.

    Args:
        velocities: of the directions held, (N, n).
        forces: the same, (N, n).
        masses: (N,).
        tau: time.
        squares: to be kept.
    """
    acceleration = forces / masses[:, None]
    now = (masses[:, None] * velocities**2).sum()
    a = (forces * velocities).sum() / now
    b = (forces * acceleration).sum() / now
    root = np.sqrt(b)
    s = a / b * (np.cosh(tau * root) - 1) + np.sinh(tau * root) / root if b > 0 else tau
    return _on_constraint(velocities + s * acceleration, masses, squares)


def _on_constraint(velocities: Array, masses: Array, squares: float) -> Array:
    scale = np.sqrt(squares / (masses[:, None] * velocities**2).sum())
    return np.asarray(scale * velocities)


class Isokinetic:
    """Particles under the thermostat.

    Args:
        pairs: their interaction.
        positions: (N, D).
        velocities: (N, D), relative to the flow.
        masses: (N,).
        field: constant force on each, (N, D).
        temperature: T.
        held: directions whose kinetic energy is fixed, of `range(D)`.
        rate: shear rate, dv_x/dy, about y = 0; needs all directions held.
    """

    def __init__(
        self,
        pairs: SoftPairs,
        positions: Array,
        velocities: Array,
        masses: Array,
        field: Array,
        temperature: float,
        held: tuple[int, ...],
        rate: float = 0.0,
    ) -> None:
        self.pairs, self.masses, self.field, self.rate = pairs, masses, field, rate
        self.positions, self.velocities = positions.copy(), velocities.copy()
        self.held = list(held)
        self.squares = constraint(len(positions), len(held), temperature)
        self.offset = 0.0
        self._forces = self.forces()

    def forces(self) -> Array:
        """Of the pairs and the field, (N, D)."""
        return self.pairs.sums(self.positions, self.offset).forces + self.field

    def step(self, dt: float) -> None:
        """Kick, shear, flight, shear, kick."""
        self._kick(dt / 2)
        self._shear(dt / 2)
        height = self.positions[:, 1].copy()
        self.positions += dt * self.velocities
        self.positions[:, 0] += self.rate * dt * (height + dt / 2 * self.velocities[:, 1])
        self._shear(dt / 2)
        self._forces = self.forces()
        self.offset += self.rate * self.pairs.lengths[1] * dt  # as fix deform, after the forces
        self._kick(dt / 2)

    def _kick(self, tau: float) -> None:
        free = [a for a in range(self.positions.shape[1]) if a not in self.held]
        self.velocities[:, free] += tau * self._forces[:, free] / self.masses[:, None]
        self.velocities[:, self.held] = kick(
            self.velocities[:, self.held],
            self._forces[:, self.held],
            self.masses,
            tau,
            self.squares,
        )

    def _shear(self, tau: float) -> None:
        if self.rate == 0:
            return
        self.velocities[:, 0] -= self.rate * tau * self.velocities[:, 1]
        self.velocities = _on_constraint(self.velocities, self.masses, self.squares)

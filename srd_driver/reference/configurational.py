"""The configurational thermostat of delhommelle-2005 (5), at rest or under shear (SLLOD).

It feeds T_conf back into the positions and leaves the velocities alone.
"""

from lammps_inputs.system import Array
from srd_driver.reference.soft_pairs import PairSums, SoftPairs


class Configurational:
    """Particles under the thermostat.

    A step is velocity Verlet with half a step of s at each end; the gradient of T_conf that moves
    the positions is extrapolated to the middle of the step, 3/2 of the present and -1/2 of the one
    before (second order, one evaluation).

    Args:
        pairs: their interaction.
        positions: (N, D).
        velocities: (N, D), relative to the flow.
        masses: (N,).
        field: constant force on each, (N, D).
        temperature: T.
        damping: Q of (5).
        rate: shear rate, dv_x/dy, about y = 0.
    """

    def __init__(
        self,
        pairs: SoftPairs,
        positions: Array,
        velocities: Array,
        masses: Array,
        field: Array,
        temperature: float,
        damping: float = 10.0,
        rate: float = 0.0,
    ) -> None:
        self.pairs, self.masses, self.field = pairs, masses, field
        self.temperature, self.damping, self.rate = temperature, damping, rate
        self.positions, self.velocities = positions.copy(), velocities.copy()
        self.multiplier = 0.0
        self.offset = 0.0
        self.now: PairSums = pairs.sums(self.positions)
        self._before = self.now.temperature_gradient

    def step(self, dt: float) -> None:
        """Kick, shear, move, shear, kick."""
        self._kick(dt / 2)
        gradient = self.now.temperature_gradient
        thrust = self.multiplier / self.temperature * (1.5 * gradient - 0.5 * self._before)
        self._before = gradient
        self.velocities[:, 0] -= self.rate * dt / 2 * self.velocities[:, 1]
        height = self.positions[:, 1].copy()
        speed = self.velocities + thrust
        self.positions += dt * speed
        self.positions[:, 0] += self.rate * dt * (height + dt / 2 * speed[:, 1])
        self.velocities[:, 0] -= self.rate * dt / 2 * self.velocities[:, 1]
        self.now = self.pairs.sums(self.positions, self.offset)
        self.offset += self.rate * self.pairs.lengths[1] * dt  # as fix deform, after the forces
        self._kick(dt / 2)

    def _kick(self, tau: float) -> None:
        self.velocities += tau * (self.now.forces + self.field) / self.masses[:, None]
        excess = (self.now.temperature - self.temperature) / self.temperature
        self.multiplier -= tau * self.damping * excess

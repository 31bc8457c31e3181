"""The thermostatted equations as dy/dt = f(y), for integrators that are checks of the splitting.

delhommelle-2005, (2) and (3), or (5), with the SLLOD flow of a shear rate.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from lammps_inputs.system import Array
from srd_driver.reference.configurational import Configurational
from srd_driver.reference.gear import Gear
from srd_driver.reference.isokinetic import Isokinetic, constraint, friction
from srd_driver.reference.soft_pairs import SoftPairs


@dataclass(frozen=True)
class Isothermal:
    """A driven mixture in 2D, and its state after some time by two integrators.

    Attributes:
        kind: what is fixed, the kinetic energy or the configurational temperature.
        positions, velocities: at the start, (N, 2).
        masses: (N,).
        field: force on each, (N, 2).
        rate: of shear.
        damping: Q of (5).
    """

    kind: Literal["kinetic", "configurational"]
    pairs: SoftPairs
    positions: Array
    velocities: Array
    masses: Array
    field: Array
    temperature: float
    rate: float = 0.0
    damping: float = 10.0

    @property
    def start(self) -> Array:
        """y at time 0: positions, velocities on the constraint, s of (5), the image offset."""
        velocities = self.velocities
        if self.kind == "kinetic":
            squares = constraint(len(self.masses), 2, self.temperature)
            velocities = velocities * np.sqrt(
                squares / (self.masses[:, None] * velocities**2).sum()
            )
        return np.concatenate([self.positions.ravel(), velocities.ravel(), [0.0, 0.0]])

    def slope(self, y: Array) -> Array:
        """f(y)."""
        n = self.positions.size
        x, v = y[:n].reshape(-1, 2), y[n : 2 * n].reshape(-1, 2)
        multiplier, offset = y[-2:]
        sums = self.pairs.sums(x, float(offset))
        masses = self.masses
        dx = v + self.rate * np.column_stack([x[:, 1], 0 * x[:, 1]])
        shear = self.rate * np.column_stack([v[:, 1], 0 * v[:, 1]])
        dv = (sums.forces + self.field) / masses[:, None] - shear
        ds = 0.0
        if self.kind == "kinetic":
            dv = dv - friction(v, masses[:, None] * dv, masses) * v
        else:
            dx = dx + multiplier / self.temperature * sums.temperature_gradient
            ds = -self.damping * (sums.temperature - self.temperature) / self.temperature
        offset_rate = self.rate * self.pairs.lengths[1]
        return np.concatenate([dx.ravel(), dv.ravel(), [ds, offset_rate]])

    def gear(self, dt: float, time: float) -> Array:
        """Positions and velocities after a time by Gear's method, (2 N, 2)."""
        run = Gear(self.slope, self.start, dt)
        for _ in range(round(time / dt)):
            run.step()
        return np.asarray(run.y[:-2].reshape(-1, 2))

    def split(self, dt: float, time: float) -> Array:
        """The same by the splitting that the compiled styles use, (2 N, 2)."""
        state = (self.pairs, self.positions, self.velocities, self.masses, self.field)
        n = self.positions.size
        if self.kind == "kinetic":
            run: Isokinetic | Configurational = Isokinetic(
                *state, self.temperature, (0, 1), self.rate
            )
            run.velocities = self.start[n:-2].reshape(-1, 2).copy()
        else:
            run = Configurational(*state, self.temperature, self.damping, self.rate)
        # the reference's image offset is a step behind, as fix deform's: in step with the flow here
        run.offset = self.rate * run.pairs.lengths[1] * dt
        for _ in range(round(time / dt)):
            run.step(dt)
        return np.concatenate([run.positions, run.velocities])

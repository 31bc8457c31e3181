"""Current of settling colloids J(rho) = rho v(rho), and the ASEP form of the thesis (5.1-5.3)."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from analysis.arrays import Array
from analysis.estimate import Estimate


def current(density: float, speed: Estimate) -> Estimate:
    """J = rho v [1/(a0 t0)]."""
    return speed.scaled(density)


@dataclass(frozen=True)
class AsepForm:
    """J = (p - q) rho (1 - rho / rho_full), (5.1) in the units of the channel.

    Attributes:
        bias: p - q [a0/t0]; negative: the holes of the ASEP run along +x.
        full: density at which the current vanishes again, rho of a full lattice [1/a0^2].
    """

    bias: float
    full: float

    def current(self, density: ArrayLike) -> Array:
        """J(rho), same shape [1/(a0 t0)]."""
        rho = np.asarray(density, dtype=float)
        return np.asarray(self.bias * rho * (1 - rho / self.full))


def asep_form(slope: float, intercept: float, frame: float) -> AsepForm:
    """The ASEP that (5.3) is: J = rho (c rho + c' - V) in a frame that moves at V.

    Printed with p = c/(v_cm - c'); right is J = -(V - c') rho (1 - c rho/(V - c')): p - q = c' - V
    and rho_full = (V - c')/c. For V > c' the bias is negative, J is convex in every frame, and its
    shocks have the high density on the left, as at the head of a chain that falls along +x.

    Args:
        slope, intercept: c [a0^3/t0] and c' [a0/t0] of v = c rho + c' at rest.
        frame: V, not c' [a0/t0].
    """
    return AsepForm(intercept - frame, (frame - intercept) / slope)

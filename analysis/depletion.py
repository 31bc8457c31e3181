"""Attraction that an ideal-gas fluid makes between a colloid and a wall.

The MPC fluid is an ideal gas in equilibrium: its particles do not repel each other. A colloid keeps
it off by f(r) = 1 - exp(-u(r)), and where that region reaches beyond the wall it costs no work: the
potential of mean force at the distance y is -n times the integral of f beyond the wall, exactly
(S. Asakura and F. Oosawa, J. Chem. Phys. 22, 1255 (1954)).
"""

from collections.abc import Callable

import numpy as np
from scipy.integrate import quad

from analysis.arrays import Array


def wall_depletion(
    potential: Callable[[Array], Array], cutoff: float, distance: float, density: float
) -> float:
    """Work to bring a disc from afar to a wall through an ideal gas, in two dimensions [kBT].

    Args:
        potential: u(r) of a fluid particle at the distance r from the centre [kBT].
        cutoff: where u ends [a0].
        distance: of the centre from the wall that reflects the fluid, positive [a0].
        density: of the fluid [1/a0^2].
    """
    if distance >= cutoff:
        return 0.0

    def arc(r: float) -> float:
        kept_off = -np.expm1(-potential(np.array([r]))[0])
        return float(kept_off * 2 * r * np.arccos(distance / r))

    return -density * float(quad(arc, distance, cutoff)[0])

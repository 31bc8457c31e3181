"""Second virial coefficient of a pair potential, and how strongly it attracts in terms of it.

Short-ranged attractions of one B2 over that of hard spheres of the effective diameter have much the
same phase diagram: a fluid falls into a gas and a liquid at about -1.5 (M. G. Noro and D. Frenkel,
J. Chem. Phys. 113, 2941 (2000); G. A. Vliegenthart and H. N. W. Lekkerkerker, J. Chem. Phys. 112,
5364 (2000)). Energies in kBT; spheres never come closer than the first distance, and do not act on
each other beyond the last.
"""

import math

import numpy as np
from scipy.integrate import trapezoid

from analysis.arrays import Array

CRITICAL = -1.5  # B2 over that of hard spheres where the critical point is


def second_virial(distance: Array, energy: Array) -> float:
    """B2 = 2 pi times the integral of (1 - exp(-V)) r^2 [a0^3].

    Args:
        distance: rising, (n,) [a0].
        energy: there, (n,) [kBT].
    """
    beyond = trapezoid((1 - np.exp(-energy)) * distance**2, distance)
    return 2 * math.pi * (float(distance[0]) ** 3 / 3 + float(beyond))


def effective_diameter(distance: Array, energy: Array) -> float:
    """Of the repulsion up to the minimum, lifted to end at 0 there: Barker and Henderson's [a0].

    Args:
        distance, energy: as for `second_virial`.
    """
    lowest = int(np.argmin(energy))
    repulsion = energy[: lowest + 1] - energy[lowest]
    inside = trapezoid(1 - np.exp(-repulsion), distance[: lowest + 1])
    return float(distance[0]) + float(inside)


def reduced_second_virial(distance: Array, energy: Array) -> float:
    """B2 over 2 pi sigma^3 / 3, sigma the effective diameter: 1 for hard spheres.

    Args:
        distance, energy: as for `second_virial`.
    """
    hard = 2 * math.pi / 3 * effective_diameter(distance, energy) ** 3
    return second_virial(distance, energy) / hard

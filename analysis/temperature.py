"""Temperature of the colloids, from their velocities across the channel."""

from collections.abc import Sequence

import numpy as np

from analysis.arrays import Array


def colloid_temperature(velocities: Array, mass: float, axes: Sequence[int] = (1,)) -> Array:
    """Kinetic temperature of the colloids in each frame, M_c <v_a^2> by equipartition.

    Across the channel the walls allow no drift; along it a drift that changes or differs between
    colloids would count as heat.

    Args:
        velocities: (T, N, d) [a0/t0].
        mass: of one colloid, M_c [m_f].
        axes: the directions a, without any drift.

    Returns:
        (T,) [kBT]; its mean is the temperature.
    """
    return np.asarray(mass * (velocities[:, :, list(axes)] ** 2).mean(axis=(1, 2)))

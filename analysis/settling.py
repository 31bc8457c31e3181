"""Settling speed of the colloids, at rest and in the co-moving frame (tabatabaei-2009, 4.2)."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def settling_speed(x: Array, interval: float) -> Array:
    """Mean colloid velocity along x over each sampling interval, in the frame at rest.

    Displacements over the interval, not velocities at its end: their mean is the same, and their
    thermal noise is averaged over the interval.

    Args:
        x: unwrapped positions along x, (T, N) [a0].
        interval: time between two frames [t0].

    Returns:
        (T - 1,) [a0/t0].
    """
    return np.asarray(np.diff(x, axis=0).mean(axis=1) / interval)


def co_moving(speed: Array, mean_velocity: Array) -> Array:
    """Settling speed in the frame of zero total momentum, tabatabaei-2009 (4.9).

    Args:
        speed: mean colloid velocity over each sampling interval, (K,) [a0/t0].
        mean_velocity: P_t / (N_f m_f + N_c M_c) along x over the same intervals, (K,) [a0/t0].

    Returns:
        (K,) [a0/t0].
    """
    return speed - mean_velocity

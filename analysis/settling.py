"""Settling speed of the colloids, at rest and in the co-moving frame (tabatabaei-2009, 4.2)."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analysis.arrays import Array
from analysis.run_directory import RunDirectory
from run_files import RunDirectoryError


@dataclass(frozen=True)
class SettlingSeries:
    """Mean speed of the colloids along x over each sampling interval of a run.

    Attributes:
        times: ends of the intervals, (K,) [t0].
        rest, co_moving: in the frame at rest and in that of zero momentum (4.9), (K,) [a0/t0].
        used: which intervals lie after the equilibration, (K,).
    """

    times: Array
    rest: Array
    co_moving: Array
    used: NDArray[np.bool_]


def settling_series(run: RunDirectory) -> SettlingSeries:
    """Reads the settling speed of a run with colloids.

    Raises:
        RunDirectoryError: when its files cannot be read, or nothing lies after the equilibration.
    """
    table = run.table()
    rest = settling_speed(run.particles().positions[:, :, 0], run.interval)
    count = min(len(rest), len(table.steps))  # a run in progress may be ahead in one file
    rest, steps = rest[:count], table.steps[:count]
    if count == 0:
        raise RunDirectoryError(f"{run.path}: no complete sampling interval yet")
    return SettlingSeries(
        run.times(steps),
        rest,
        co_moving(rest, table["mean_velocity_x"][:count]),
        run.sampled(steps),
    )


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

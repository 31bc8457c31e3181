"""The chain of colloids: neighbour spacings and the zigzag (tabatabaei-2009, 4.5).

Colloids are counted from the head, the foremost in the direction of gravity at the start. In single
file the order never changes.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analysis.arrays import Array
from analysis.run_directory import RunDirectory

GROUP = 5  # spacings in a group, Fig. 4.12


@dataclass(frozen=True)
class Chain:
    """Colloids from head to tail: unwrapped x along and y across the channel, each (T, N) [a0]."""

    x: Array
    y: Array


def chain_of(run: RunDirectory) -> Chain:
    """The colloids of a run, all frames, ordered along their drive.

    Raises:
        RunDirectoryError: when the trajectory cannot be read.
    """
    positions = run.particles().positions
    gravity = float(run.acceleration(run.species().name)[0])
    order = head_order(positions[0, :, 0], gravity)
    return Chain(positions[:, order, 0], positions[:, order, 1])


def head_order(x: Array, gravity: float) -> NDArray[np.int64]:
    """Colloids from head to tail.

    Args:
        x: positions along x at the start, (N,) [a0].
        gravity: along x; only its sign counts, 0 counts as along +x [a0/t0^2].

    Returns:
        indices, (N,), head first.
    """
    return np.argsort(-x if gravity >= 0 else x, kind="stable")


def neighbour_spacings(x: Array) -> Array:
    """Distances of neighbouring centres along the channel.

    Args:
        x: unwrapped positions along x in the order of `head_order`, (T, N) [a0].

    Returns:
        |x_j - x_(j+1)|, head first, (T, N - 1) [a0]; a pair that changed places is negative.
    """
    spacings = x[:, :-1] - x[:, 1:]
    return np.asarray(spacings * np.where(spacings[0] < 0, -1.0, 1.0))


def group_spacings(spacings: Array) -> Array:
    """D_i of Fig. 4.12, the mean of five consecutive spacings; D_1 is at the head.

    Args:
        spacings: of neighbours, head first, (T, N - 1) [a0].

    Returns:
        (T, (N - 1) // 5) [a0]. Spacings at the tail that do not fill a group are left out.
    """
    frames, count = spacings.shape
    groups = count // GROUP
    return np.asarray(spacings[:, : groups * GROUP].reshape(frames, groups, GROUP).mean(axis=2))


def zigzag_amplitude(y: Array, width: float) -> Array:
    """Staggered displacement from the mid-line, sum_i (-1)^i (y_i - width/2) / N.

    Args:
        y: positions across the channel in the order of `head_order`, (T, N) [a0].
        width: of the channel [a0].

    Returns:
        (T,) [a0]; A (or -A) for a chain at width/2 +- A in turn.
    """
    return np.asarray(((y - width / 2) * _signs(y.shape[1])).mean(axis=1))


def local_zigzag(y: Array) -> Array:
    """Zigzag about each inner colloid, (-1)^i (2 y_i - y_(i-1) - y_(i+1)) / 4.

    It needs no mid-line: a shift and a slope of the chain drop out.

    Args:
        y: positions across the channel in the order of `head_order`, (T, N) [a0].

    Returns:
        (T, N - 2), head first [a0]; A (or -A) for a chain at +- A in turn. Its sign changes where
        two zigzags of opposite phase meet.
    """
    kink = (2 * y[:, 1:-1] - y[:, :-2] - y[:, 2:]) / 4
    return np.asarray(kink * _signs(y.shape[1])[1:-1])


def zigzag_place(local: Array) -> Array:
    """Where along the chain the zigzag is: the mean colloid number, weighted by its square.

    Args:
        local: from `local_zigzag`, head first, (T, N - 2) [a0].

    Returns:
        (T,), from 1 if all of it is at the second colloid from the head to N - 2 at the other end;
        NaN where the chain is straight.
    """
    weights = local**2
    total = weights.sum(axis=1)
    moment = weights @ np.arange(1, local.shape[1] + 1)
    return np.asarray(np.divide(moment, total, out=np.full_like(total, np.nan), where=total > 0))


def _signs(count: int) -> Array:
    return np.asarray(1.0 - 2.0 * (np.arange(count) % 2), dtype=float)

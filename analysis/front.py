"""Coarse-grained density of a long chain of colloids, and the fronts at its ends."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import curve_fit
from scipy.special import ndtr

from analysis.arrays import Array


def coarse_density(x: Array, edges: ArrayLike, width: float) -> Array:
    """Number density along the channel; every colloid fills its share, half-way to its neighbours.

    The outermost ones reach as far out as in. So an even chain has an even density in bins of any
    size, and the number of colloids is kept if the edges enclose the chain.

    Args:
        x: positions along x, in any order, (N,), at least 2 [a0].
        edges: of the bins, increasing, (B + 1,) [a0].
        width: of the channel [a0].

    Returns:
        (B,) [1/a0^2].
    """
    ordered, bins = np.sort(x), np.asarray(edges, dtype=float)
    middles = (ordered[1:] + ordered[:-1]) / 2
    shares = np.concatenate(
        [[2 * ordered[0] - middles[0]], middles, [2 * ordered[-1] - middles[-1]]]
    )
    number = np.interp(bins, shares, np.arange(len(shares)))
    return np.asarray(np.diff(number) / (np.diff(bins) * width))


def places(density: Array, edges: ArrayLike, width: float, numbers: Sequence[float]) -> Array:
    """Where a density has so many colloids to the left: 0.5 is the place of the first.

    Args:
        density: (B,) [1/a0^2].
        edges: of its bins, (B + 1,) [a0].
        width: of the channel [a0].
        numbers: of colloids to the left, increasing, (n,).

    Returns:
        (n,) [a0].
    """
    bins = np.asarray(edges, dtype=float)
    left = np.concatenate([[0.0], np.cumsum(np.maximum(density, 1e-12) * np.diff(bins) * width)])
    return np.asarray(np.interp(numbers, left, bins))


@dataclass(frozen=True)
class Front:
    """A smooth step: level * Phi(+-(x - position) / width), Phi the normal distribution.

    Attributes:
        position, width: [a0]; Phi rises from 16 to 84 % over two widths.
        level: density on the full side [1/a0^2].
    """

    position: float
    width: float
    level: float


def fit_front(x: Array, density: Array, side: int) -> Front:
    """Least squares through a density that goes from nothing to a level.

    Args:
        x: centres of equal bins, at least 4 [a0].
        density: (B,) [1/a0^2].
        side: +1 where the full side is on the right, as at the tail of a chain that falls along
            +x, -1 where it is on the left, as at its head.

    Raises:
        RuntimeError: when no step is found.
    """
    bin_size = x[1] - x[0]
    highest = float(np.max(density))
    half = x[density > highest / 2]
    start = float(half[0] if side > 0 else half[-1])

    def step(at: Array, position: float, width: float, level: float) -> Array:
        return np.asarray(level * ndtr(side * (at - position) / width))

    bounds = ([x[0], 0.05 * bin_size, 0.0], [x[-1], x[-1] - x[0], 2 * highest])
    guess = (start, 2 * bin_size, 0.9 * highest)
    (position, width, level), _ = curve_fit(step, x, density, guess, bounds=bounds)
    return Front(float(position), float(width), float(level))

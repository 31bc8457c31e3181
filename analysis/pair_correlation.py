"""Pair correlation of the colloids along the channel."""

import numpy as np

from analysis.arrays import Array


def pair_correlation(x: Array, length: float, bin_width: float) -> tuple[Array, Array]:
    """g(x) of points on a ring: pairs at a distance, over those of N independent points.

    Args:
        x: positions along the channel, wrapped or not, (T, N), N at least 2 [a0].
        length: of the periodic channel [a0].
        bin_width: wanted; the bins used divide half the channel evenly [a0].

    Returns:
        bin centres in (0, length / 2) [a0] and g, both (bins,). An ideal gas has g = 1: the
        N - 1 neighbours of each point spread evenly over the length.

    Raises:
        ValueError: for fewer than 2 points.
    """
    frames, points = x.shape
    if points < 2:
        raise ValueError("a pair correlation needs at least 2 points")
    bins = max(1, round(length / 2 / bin_width))
    edges = np.linspace(0, length / 2, bins + 1)
    counts = np.zeros(bins)
    for shift in range(1, points):
        separation = x - np.roll(x, shift, axis=1)
        distance = np.abs(separation - length * np.round(separation / length))
        counts += np.histogram(distance, edges)[0]
    ideal = frames * points * (points - 1) / bins  # ordered pairs: all lie within half the length
    return (edges[:-1] + edges[1:]) / 2, counts / ideal

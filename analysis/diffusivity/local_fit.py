"""Derivative of a binned profile by a local cubic fit."""

import numpy as np

from analysis.arrays import Array

CUBIC = 4  # coefficients


def local_derivative(
    positions: Array, values: Array, weights: Array, reach: float, at: Array | None = None
) -> Array:
    """Slopes of the weighted cubics through the values within `reach`.

    Near the ends the window is cut, not shifted. Positions without weight take no part.

    Args:
        positions: increasing, (B,).
        values, weights: (B,); a weight is the inverse variance up to a factor.
        reach: half width of the window, in the unit of the positions.
        at: where the slopes are asked for (P,); by default at the positions.

    Returns:
        (P,); NaN where fewer than 5 weighted values are within reach.
    """
    places = positions if at is None else at
    slopes = np.full(len(places), np.nan)
    for n, place in enumerate(places):
        near = (np.abs(positions - place) <= reach * (1 + 1e-9)) & (weights > 0)
        if near.sum() <= CUBIC:
            continue
        distance = (positions[near] - place) / reach
        root = np.sqrt(weights[near] / weights[near].max())
        powers = distance[:, None] ** np.arange(CUBIC)
        fit = np.linalg.lstsq(powers * root[:, None], values[near] * root, rcond=None)[0]
        slopes[n] = fit[1] / reach
    return slopes

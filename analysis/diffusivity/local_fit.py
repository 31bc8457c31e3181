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
    distance = (positions - places[:, None]) / reach
    near = (np.abs(distance) <= 1 + 1e-9) & (weights > 0)
    known = near.sum(axis=1) > CUBIC
    distance, power = distance[known], np.where(near, weights, 0.0)[known]
    power /= power.max(axis=1, keepdims=True)
    given = np.where(weights > 0, values, 0.0)
    # sums over w d^n and w d^n y: the normal equations of all windows at once
    sums, sides = [], []
    for _ in range(2 * CUBIC - 1):
        sums.append(power.sum(axis=1))
        sides.append(power @ given)
        power *= distance
    order = np.arange(CUBIC)
    normal = np.array(sums).T[:, order[:, None] + order]
    right = np.array(sides[:CUBIC]).T[:, :, None]
    slopes = np.full(len(places), np.nan)
    slopes[known] = np.linalg.solve(normal, right)[:, 1, 0] / reach
    return slopes

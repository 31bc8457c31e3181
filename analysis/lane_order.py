"""The order parameter of lanes (delhommelle-2005, II): particles without the other colour beside.

phi is the fraction of particles of which every particle of the other colour is further than a
spacing n^(-1/D), the distance measured along certain axes. The paper prints the axis of the field,
x; lanes along the field are told apart by the distance across it.
"""

import numpy as np
from numpy.typing import ArrayLike

from analysis.arrays import Array
from analysis.periodic import nearest_distance


def lane_order(positions: Array, colours: ArrayLike, lengths: ArrayLike) -> Array:
    """phi with the distance across the field: 1 for lanes along x, 0 when well mixed.

    Args:
        positions: (T, N, D), wrapped or not.
        colours: of each particle, two different values, (N,).
        lengths: of the periodic box, (D,).

    Returns:
        (T,).

    Raises:
        ValueError: when there are not two colours.
    """
    dimension = positions.shape[2]
    return _order(positions, colours, lengths, list(range(1, dimension)))


def lane_order_printed(positions: Array, colours: ArrayLike, lengths: ArrayLike) -> Array:
    """phi as printed, with the distance along x, the field: 0 for lanes along the field.

    Arguments as of `lane_order`. It is 1 for bands across the field.
    """
    return _order(positions, colours, lengths, [0])


def _order(positions: Array, colours: ArrayLike, lengths: ArrayLike, axes: list[int]) -> Array:
    colours, lengths = np.asarray(colours), np.asarray(lengths, dtype=float)
    kinds = np.unique(colours)
    if len(kinds) != 2:
        raise ValueError(f"{len(kinds)} colours: lanes need two")
    _, particles, dimension = positions.shape
    spacing = (particles / lengths.prod()) ** (-1 / dimension)
    first = colours == kinds[0]
    order = np.empty(len(positions))
    for frame, points in enumerate(positions[:, :, axes]):
        alone = 0
        for own in (first, ~first):
            distance = nearest_distance(points[own], points[~own], lengths[axes])
            alone += int(np.count_nonzero(distance > spacing))
        order[frame] = alone / particles
    return order

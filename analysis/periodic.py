"""Neighbours in periodic boxes: trees of points, for measures that need distances only."""

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import cKDTree

from analysis.arrays import Array

Indices = NDArray[np.intp]


def wrapped(positions: Array, lengths: ArrayLike) -> Array:
    """Positions in [0, L) of each direction, whatever image they are: (..., D)."""
    box = np.asarray(lengths, dtype=float)
    inside = np.mod(positions, box)
    return np.where(inside < box, inside, 0.0)  # of -1e-20 the remainder rounds to L


def nearest_distance(points: Array, others: Array, lengths: ArrayLike) -> Array:
    """Distance from each point to the nearest of the others.

    Args:
        points: (N, D).
        others: (M, D), M at least 1.
        lengths: of the periodic box, (D,).

    Returns:
        (N,).
    """
    box = np.asarray(lengths, dtype=float)
    tree = cKDTree(wrapped(others, box), boxsize=box)
    distance, _ = tree.query(wrapped(points, box))
    return np.asarray(distance)


def close_pairs(positions: Array, lengths: ArrayLike, distance: float) -> tuple[Array, Indices]:
    """Pairs of points up to a distance apart.

    Args:
        positions: (N, D).
        lengths: of the periodic box, (D,).
        distance: at most half of the shortest length.

    Returns:
        separations, first minus second, (pairs, D), and the two numbers of each, (pairs, 2).

    Raises:
        ValueError: when a pair could be close twice.
    """
    box = np.asarray(lengths, dtype=float)
    if distance > box.min() / 2:
        raise ValueError(f"distance {distance}: more than half the box, {box.min() / 2}")
    pairs = cKDTree(wrapped(positions, box), boxsize=box).query_pairs(
        distance, output_type="ndarray"
    )
    separation = positions[pairs[:, 0]] - positions[pairs[:, 1]]
    separation -= box * np.round(separation / box)
    return separation, pairs

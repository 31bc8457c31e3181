"""The order parameter of lanes (delhommelle-2005, II): particles without the other colour beside.

phi is the fraction of particles of which every particle of the other colour is further than a
spacing n^(-1/D), the distance measured along certain axes. The paper prints the axis of the field,
x; lanes along the field are told apart by the distance across it.

Asked of all particles, phi is 0 until a lane is pure over the length of the box. The paper's
numbers are those among neighbours, as a loop over interacting pairs has them (docs/errata.md). How
far the colours have parted is told by the structure factor of the colour, of waves across the
field, too.
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from analysis.arrays import Array
from analysis.periodic import close_pairs, nearest_distance

REACH = {2: 1.5, 3: 2 ** (1 / 6)}  # sigma: of soft disks, customary; of WCA spheres, exact
WAVES = 4  # along each axis across the field, the longest


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


def lane_order_near(positions: Array, colours: ArrayLike, lengths: ArrayLike) -> Array:
    """phi (delhommelle-2005, II) of pairs that interact: closer than `REACH`, which is not printed.

    It is 1 for lanes, and not 0 when mixed: about 0.05 for soft disks at density 1. Arguments as of
    `lane_order`, in units of sigma.

    Raises:
        ValueError: as `lane_order`, and for a box below twice the reach.
    """
    colours, lengths = _two_colours(colours), np.asarray(lengths, dtype=float)
    dimension = positions.shape[2]
    order = np.empty(len(positions))
    for frame, points in enumerate(positions):
        separations, pairs = close_pairs(points, lengths, REACH[dimension])
        across = np.linalg.norm(separations[:, 1:], axis=1)
        unlike = colours[pairs[:, 0]] != colours[pairs[:, 1]]
        beside = pairs[unlike & (across <= _spacing(points, lengths))]
        order[frame] = 1 - len(np.unique(beside)) / len(points)
    return order


def colour_structure(positions: Array, colours: ArrayLike, lengths: ArrayLike) -> Array:
    """Largest S_c(k) = |sum_j eps_j exp(i k r_j)|^2 / N of the longest waves across the field.

    About 2 when mixed at random, 4 N / pi^2 for two lanes of equal width. Arguments as of
    `lane_order`.
    """
    colours, lengths = np.asarray(colours), np.asarray(lengths, dtype=float)
    signs = np.where(colours == np.unique(colours)[0], 1.0, -1.0)
    largest = np.zeros(len(positions))
    for axis in range(1, positions.shape[2]):
        phases = np.exp(2j * np.pi * positions[:, :, axis] / lengths[axis])
        for wave in range(1, WAVES + 1):
            squares = np.abs(phases**wave @ signs) ** 2 / len(signs)
            largest = np.maximum(largest, squares)
    return largest


def _order(positions: Array, colours: ArrayLike, lengths: ArrayLike, axes: list[int]) -> Array:
    colours, lengths = _two_colours(colours), np.asarray(lengths, dtype=float)
    particles = len(colours)
    first = colours == colours[0]
    order = np.empty(len(positions))
    for frame, points in enumerate(positions):
        spacing, along = _spacing(points, lengths), points[:, axes]
        alone = 0
        for own in (first, ~first):
            distance = nearest_distance(along[own], along[~own], lengths[axes])
            alone += int(np.count_nonzero(distance > spacing))
        order[frame] = alone / particles
    return order


def _spacing(points: Array, lengths: Array) -> float:
    """n^(-1/D)."""
    particles, dimension = points.shape
    return float((particles / lengths.prod()) ** (-1 / dimension))


def _two_colours(colours: ArrayLike) -> NDArray[Any]:
    kinds = len(np.unique(np.asarray(colours)))
    if kinds != 2:
        raise ValueError(f"{kinds} colours: lanes need two")
    return np.asarray(colours)

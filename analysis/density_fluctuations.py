"""How unevenly particles are spread: structure factor, numbers in boxes, clusters."""

import itertools

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from analysis.arrays import Array
from analysis.periodic import close_pairs, wrapped


def structure_factor(positions: Array, lengths: ArrayLike, largest: int) -> tuple[Array, Array]:
    """S(k) = <|sum_j exp(i k.r_j)|^2> / N of the smallest wave vectors of the box.

    Args:
        positions: (T, N, D).
        lengths: of the periodic box, (D,).
        largest: wave vectors 2 pi (n_1 / L_1, ...) with all |n| up to it; of k and -k one.

    Returns:
        wave vectors, (K, D), and S of each, (K,). Uncorrelated particles have S = 1.
    """
    box = np.asarray(lengths, dtype=float)
    numbers = itertools.product(range(-largest, largest + 1), repeat=len(box))
    waves = 2 * np.pi * np.array([n for n in numbers if n > (0,) * len(box)]) / box
    phases = np.einsum("tnd,kd->tkn", positions, waves)
    amplitude = np.exp(1j * phases).sum(axis=2)
    return waves, np.asarray((np.abs(amplitude) ** 2).mean(axis=0) / positions.shape[1])


def number_variance(positions: Array, lengths: ArrayLike, boxes: int) -> float:
    """<(n - <n>)^2> / <n> of the number of particles in equal boxes.

    Args:
        positions: (T, N, D), wrapped or not.
        lengths: of the periodic box, (D,).
        boxes: along each direction; there are boxes^D.

    Returns:
        1 - boxes^-D for uncorrelated particles, 0 where all boxes hold the same number.
    """
    box = np.asarray(lengths, dtype=float)
    cells = np.minimum((wrapped(positions, box) / box * boxes).astype(np.intp), boxes - 1)
    index = np.ravel_multi_index(tuple(np.moveaxis(cells, 2, 0)), (boxes,) * len(box))
    counts = np.array([np.bincount(frame, minlength=boxes ** len(box)) for frame in index])
    return float(counts.var(axis=1).mean() / counts.mean())


def cluster_sizes(positions: Array, lengths: ArrayLike, distance: float) -> NDArray[np.int64]:
    """Sizes of the groups of particles that chains of neighbours up to a distance apart connect.

    Args:
        positions: (N, D), wrapped or not.
        lengths: of the periodic box, (D,).
        distance: at most half of the shortest length.

    Returns:
        largest first, (clusters,).
    """
    _, pairs = close_pairs(positions, lengths, distance)
    particles = len(positions)
    links = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), (particles, particles))
    _, labels = connected_components(links, directed=False)
    return np.asarray(np.sort(np.bincount(labels))[::-1])

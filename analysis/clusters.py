"""Clusters of spheres: who touches whom, by freud (which computes in single precision)."""

from dataclasses import dataclass

import freud
import numpy as np
from numpy.typing import ArrayLike, NDArray

from analysis.arrays import Array

BOND = 1.1  # distance of bonded centres over the diameter: beyond the secondary minimum of (1), (2)


@dataclass(frozen=True)
class ClusterSeries:
    """Of each frame, (T,).

    Attributes:
        largest: colloids in the largest cluster.
        number: clusters of two or more.
        bonds_per_colloid: pairs closer than a bond, over colloids: half the coordination number.
        alone: colloids without a bond.
    """

    largest: Array
    number: Array
    bonds_per_colloid: Array
    alone: Array


def labels(
    positions: Array, lengths: ArrayLike, periodic: ArrayLike, distance: float
) -> tuple[NDArray[np.int64], int]:
    """The cluster of each sphere, (N,), the largest first, and the number of bonds.

    Args:
        positions: (N, 3), wrapped or not.
        lengths: of the box, (3,), one corner at the origin.
        periodic: whether each axis is, (3,).
        distance: up to which two centres are bonded, at most half the box.
    """
    ways = np.asarray(periodic, dtype=bool)
    # freud's box is periodic and about the origin: space keeps images beyond walls away
    edges = np.asarray(lengths, dtype=float) + np.where(ways, 0.0, 2 * distance)
    box = freud.box.Box.from_box(edges)
    centred = positions - np.asarray(lengths, dtype=float) / 2
    points = centred - edges * np.round(centred / edges)
    neighbours = freud.locality.AABBQuery(box, points).query(
        points, {"r_max": distance, "exclude_ii": True}
    )
    bonds = neighbours.toNeighborList()
    clusters = freud.cluster.Cluster().compute((box, points), neighbors=bonds)
    return np.array(clusters.cluster_idx, dtype=np.int64), len(bonds) // 2


def cluster_series(
    positions: Array, lengths: ArrayLike, periodic: ArrayLike, distance: float
) -> ClusterSeries:
    """The same of each frame, positions (T, N, 3)."""
    rows = []
    for frame in positions:
        label, bonds = labels(frame, lengths, periodic, distance)
        sizes = np.bincount(label)
        rows.append((sizes.max(), (sizes > 1).sum(), bonds / len(frame), (sizes == 1).sum()))
    return ClusterSeries(*np.array(rows, dtype=float).T)

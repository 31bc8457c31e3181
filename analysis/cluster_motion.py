"""What the motion of colloids that stick together is made of.

Over a time, colloids that were alone move, some leave their neighbours, and the others move with
their cluster and about it. The question is that of hecht-2005, X D: the remaining mobility of
clusters is of colloids that leave, of whole clusters that diffuse, or of their deformation.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from analysis.arrays import Array
from analysis.periodic import close_pairs


@dataclass(frozen=True)
class ClusterMotion:
    """Sums over windows of time, per colloid and window, so that the four squares add up, (W,).

    Attributes:
        alone: squared displacement of colloids without a bond at the beginning [a0^2].
        left: of those that are without any of their bonds at the end [a0^2].
        together: of the means of each cluster's other members, which stay [a0^2].
        about: of these about their mean [a0^2].
        broken: bonds of the beginning that are not there at the end, over those of the beginning;
            0 without any.
    """

    alone: Array
    left: Array
    together: Array
    about: Array
    broken: Array

    @property
    def all(self) -> Array:
        """Mean squared displacement, (W,) [a0^2]."""
        return self.alone + self.left + self.together + self.about


def cluster_motion(
    positions: Array, lengths: ArrayLike, distance: float, lag: int
) -> ClusterMotion:
    """The parts of the squared displacement over windows of `lag` frames, one after the other.

    Args:
        positions: unwrapped, (T, N, 3) [a0].
        lengths: of the periodic box, (3,) [a0].
        distance: up to which two centres are bonded, at most half the box [a0].
        lag: frames.

    Raises:
        ValueError: for fewer than `lag` + 1 frames.
    """
    if len(positions) <= lag:
        raise ValueError(f"{len(positions)} frames: must be more than the lag, {lag}")
    ends = positions[::lag]
    bonds = [close_pairs(frame, lengths, distance)[1] for frame in ends]
    rows = [
        _window(end - begin, before, after)
        for begin, end, before, after in zip(
            ends[:-1], ends[1:], bonds[:-1], bonds[1:], strict=True
        )
    ]
    return ClusterMotion(*np.array(rows).T)


def _window(
    moved: Array, before: NDArray[np.intp], after: NDArray[np.intp]
) -> tuple[float, float, float, float, float]:
    """Of displacements (N, 3) and the bonds of the beginning and the end, (bonds, 2)."""
    count = len(moved)
    kept = before[np.isin(_keys(before, count), _keys(after, count))]
    bonded, stayed = np.zeros((2, count), dtype=bool)
    bonded[before.ravel()] = True
    stayed[kept.ravel()] = True
    graph = coo_matrix((np.ones(len(before)), before.T), shape=(count, count))
    _, label = connected_components(graph, directed=False)
    members = np.bincount(label[stayed], minlength=count)
    mean = np.zeros((count, 3))
    np.add.at(mean, label[stayed], moved[stayed])
    mean /= np.maximum(members, 1)[:, np.newaxis]
    square = (moved**2).sum(axis=1)
    together = float((mean[label[stayed]] ** 2).sum())
    return (
        float(square[~bonded].sum()) / count,
        float(square[bonded & ~stayed].sum()) / count,
        together / count,
        float((square[stayed]).sum() - together) / count,
        1 - len(kept) / len(before) if len(before) else 0.0,
    )


def _keys(pairs: NDArray[np.intp], count: int) -> NDArray[np.intp]:
    """A number for each pair, whichever is first."""
    ordered = np.sort(pairs, axis=1)
    return np.asarray(ordered[:, 0] * count + ordered[:, 1])

"""Sixfold bond-orientational order in two dimensions (delhommelle-2005, 6 and 7).

Neighbours are those of the Voronoi construction, by freud (which computes in single precision).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from analysis.arrays import Array
from analysis.voronoi_library import freud


@dataclass(frozen=True)
class BondOrder:
    """psi_6 of each frame, (T,).

    Attributes:
        mean: modulus of the mean over particles of the local order, (6): 1 for one crystal, about
            N^(-1/2) for a fluid. The paper's psi_6.
        mean_modulus: mean over particles of its modulus, which crystals of any orientation have.
    """

    mean: Array
    mean_modulus: Array


def local_bond_order(positions: Array, lengths: ArrayLike) -> NDArray[np.complex128]:
    """phi_6j of (7): the mean over the n_j neighbours of a particle of exp(6 i theta).

    Args:
        positions: (N, 2), wrapped or not.
        lengths: of the periodic box, (2,).

    Returns:
        (N,).
    """
    box = freud.box.Box.from_box(np.asarray(lengths, dtype=float))
    points = np.zeros((len(positions), 3))
    points[:, :2] = positions
    points = box.wrap(points)
    neighbours = freud.locality.Voronoi().compute((box, points)).nlist
    order = freud.order.Hexatic(k=6, weighted=False).compute((box, points), neighbours)
    return np.asarray(order.particle_order, dtype=complex)


def bond_order(positions: Array, lengths: ArrayLike) -> BondOrder:
    """psi_6 of each frame.

    Args:
        positions: (T, N, 2), wrapped or not.
        lengths: of the periodic box, (2,).
    """
    local = np.array([local_bond_order(frame, lengths) for frame in positions])
    return BondOrder(np.abs(local.mean(axis=1)), np.abs(local).mean(axis=1))

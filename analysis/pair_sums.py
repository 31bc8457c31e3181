"""Potential energy, pressure and configurational temperature of stored configurations.

What LAMMPS prints as it runs, from positions alone: for trajectories of any program.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from analysis.arrays import Array
from analysis.periodic import close_pairs

Derivatives = Callable[[Array], tuple[Array, Array, Array, Array]]


@dataclass(frozen=True)
class PairSeries:
    """Of each frame, (T,).

    Attributes:
        potential_energy: for each particle.
        pressure: its potential part, the virial over D V.
        force_squares, laplacians: sums over particles, whose means' ratio is T_conf.
    """

    potential_energy: Array
    pressure: Array
    force_squares: Array
    laplacians: Array


def pair_sums(
    positions: Array, lengths: ArrayLike, derivatives: Derivatives, cutoff: float
) -> PairSeries:
    """Sums over all pairs within a cutoff.

    Args:
        positions: (T, N, D), wrapped or not.
        lengths: of the periodic box, (D,), at least twice the cutoff.
        derivatives: energy and its derivatives by the distance, of distances (pairs,); of
            `lammps_inputs.potentials.soft_disk`, for one.
        cutoff: beyond which pairs do not interact.
    """
    rows = [_frame(frame, lengths, derivatives, cutoff) for frame in positions]
    return PairSeries(*np.array(rows).T)


def _frame(
    positions: Array, lengths: ArrayLike, derivatives: Derivatives, cutoff: float
) -> tuple[float, float, float, float]:
    particles, dimension = positions.shape
    separation, pairs = close_pairs(positions, lengths, cutoff)
    r = np.sqrt((separation**2).sum(axis=1))
    energy, slope, bend, _ = derivatives(r)
    pull = (-slope / r)[:, None] * separation
    forces = np.stack(
        [
            np.bincount(pairs[:, 0], component, particles)
            - np.bincount(pairs[:, 1], component, particles)
            for component in pull.T
        ]
    )
    volume = float(np.asarray(lengths, dtype=float).prod())
    return (
        float(energy.sum()) / particles,
        float(-(slope * r).sum()) / (dimension * volume),
        float((forces**2).sum()),
        float(2 * (bend + (dimension - 1) * slope / r).sum()),
    )

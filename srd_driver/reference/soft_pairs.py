"""Sums over explicit pairs: forces, T_conf and its gradient, in a periodic or sheared cell.

Every pair of particles is looked at. Arrays hold the particles first, (N, D); positions need not be
wrapped. Equations of delhommelle-2005.
"""

import functools
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lammps_inputs.system import Array

Indices = NDArray[np.intp]


class Potential(Protocol):
    """A pair potential with three derivatives, as `lammps_inputs.potentials.soft_disk` has."""

    @property
    def cutoff(self) -> float:
        """Distance beyond which it is zero."""
        ...

    def derivatives(self, r: ArrayLike) -> tuple[Array, Array, Array, Array]:
        """Energy and its first three derivatives at distances r."""
        ...


@dataclass(frozen=True)
class PairSums:
    """What a configuration of N particles gives.

    Attributes:
        energy: of all pairs.
        forces: minus its gradient, (N, D).
        virial: sum over pairs of r F(r), a tensor (D, D).
        laplacian: sum over particles of the Laplacian of the energy.
        laplacian_gradient: of that sum, (N, D).
        hessian_forces: the Hessian of the energy times the forces, (N, D).
    """

    energy: float
    forces: Array
    virial: Array
    laplacian: float
    laplacian_gradient: Array
    hessian_forces: Array

    @property
    def temperature(self) -> float:
        """T_conf of this configuration, the ratio of the sums in (4)."""
        return float((self.forces**2).sum() / self.laplacian)

    @property
    def temperature_gradient(self) -> Array:
        """dT_conf/dr_k = (-2 sum_i H_ki F_i - T_conf dL/dr_k) / L, (N, D)."""
        numerator = -2 * self.hessian_forces - self.temperature * self.laplacian_gradient
        return np.asarray(numerator / self.laplacian)


@functools.lru_cache(maxsize=1)
def _all_pairs(particles: int) -> tuple[Indices, Indices]:
    return np.triu_indices(particles, 1)


class SoftPairs:
    """Particles with one pair potential between all of them.

    Args:
        potential: of each pair.
        lengths: of the periodic cell, (D,), each more than twice the cutoff.

    Raises:
        ValueError: when a pair could interact twice.
    """

    def __init__(self, potential: Potential, lengths: ArrayLike) -> None:
        self.potential = potential
        self.lengths = np.asarray(lengths, dtype=float)
        if self.lengths.min() < 2 * potential.cutoff:
            raise ValueError(f"lengths {self.lengths}: less than twice {potential.cutoff}")

    def separations(self, positions: Array, offset: float = 0.0) -> tuple[Array, Array, Array]:
        """First and second of each pair within the cutoff, and its nearest separation (pairs, D).

        Args:
            positions: (N, D).
            offset: how far the upper image in y is ahead along x (Lees-Edwards).
        """
        first, second = _all_pairs(len(positions))
        separation = positions[first] - positions[second]
        rows = np.round(separation[:, 1] / self.lengths[1])
        separation[:, 0] -= offset * rows
        separation -= self.lengths * np.round(separation / self.lengths)
        near = (separation**2).sum(axis=1) < self.potential.cutoff**2
        return first[near], second[near], separation[near]

    def sums(self, positions: Array, offset: float = 0.0) -> PairSums:
        """All sums over the pairs of a configuration, arguments as of `separations`."""
        first, second, separation = self.separations(positions, offset)
        dimension = positions.shape[1]
        r = np.sqrt((separation**2).sum(axis=1))
        unit = separation / r[:, None]
        energy, slope, bend, third = self.potential.derivatives(r)

        def on_both(pair_vector: Array) -> Array:
            count = len(positions)
            return np.stack(
                [
                    np.bincount(first, c, count) - np.bincount(second, c, count)
                    for c in pair_vector.T
                ],
                axis=1,
            )

        forces = on_both(-slope[:, None] * unit)
        # of each particle of a pair, phi'' + (D - 1) phi'/r
        laplacian = 2 * (bend + (dimension - 1) * slope / r).sum()
        steepness = third + (dimension - 1) * (bend / r - slope / r**2)
        difference = forces[first] - forces[second]
        along = (difference * unit).sum(axis=1)[:, None] * unit
        product = bend[:, None] * along + (slope / r)[:, None] * (difference - along)
        return PairSums(
            energy=float(energy.sum()),
            forces=forces,
            virial=np.einsum("p,pa,pb->ab", -slope / r, separation, separation),
            laplacian=float(laplacian),
            laplacian_gradient=on_both(2 * steepness[:, None] * unit),
            hessian_forces=on_both(product),
        )

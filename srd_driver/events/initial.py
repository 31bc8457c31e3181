"""Initial velocities of the set temperature."""

import math

import numpy as np

from lammps_inputs.system import Array


def thermal_velocities(
    count: int, dimensions: int, walls: tuple[int, ...], temperature: float, seed: int
) -> Array:
    """Maxwell-Boltzmann velocities with the exact energy, and no momentum on periodic axes.

    The energy is kBT / 2 for each degree of freedom that is left, d N less the periodic axes.

    Returns:
        (count, dimensions), for spheres of mass 1.
    """
    periodic = [axis for axis in range(dimensions) if axis not in walls]
    velocities: Array = np.random.default_rng([seed, 1]).normal(size=(count, dimensions))
    velocities[:, periodic] -= velocities[:, periodic].mean(axis=0)
    freedom = dimensions * count - len(periodic)
    energy = float(np.sum(velocities**2))
    if energy > 0:
        velocities *= math.sqrt(freedom * temperature / energy)
    return velocities

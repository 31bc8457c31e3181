"""Kinetic temperature of a driven mixture, absolute and relative to each colour's stream.

delhommelle-2005 (1) takes the velocities as they are, flow included, and names the other choice.
"""

import numpy as np
from numpy.typing import ArrayLike

from analysis.arrays import Array


def kinetic_temperature(velocities: Array, masses: ArrayLike = 1.0) -> Array:
    """sum m v^2 / (D N), (1).

    Args:
        velocities: (T, N, D).
        masses: of all, or of each, (N,).

    Returns:
        (T,).
    """
    masses = np.broadcast_to(np.asarray(masses, dtype=float), velocities.shape[1])
    squares = np.einsum("n,tnd->t", masses, velocities**2)
    return np.asarray(squares / (velocities.shape[1] * velocities.shape[2]))


def stream_temperature(velocities: Array, colours: ArrayLike, masses: ArrayLike = 1.0) -> Array:
    """The same of velocities relative to the mean velocity of the particle's colour.

    Each colour's mean takes D degrees of freedom: sum m (v - u)^2 / (D (N - colours)).

    Args:
        velocities: (T, N, D).
        colours: (N,).
        masses: of all, or of each, (N,).

    Returns:
        (T,).
    """
    colours = np.asarray(colours)
    masses = np.broadcast_to(np.asarray(masses, dtype=float), velocities.shape[1])
    relative = velocities.astype(float)
    kinds = np.unique(colours)
    for kind in kinds:
        own = colours == kind
        stream = np.einsum("n,tnd->td", masses[own], velocities[:, own]) / masses[own].sum()
        relative[:, own] -= stream[:, None]
    particles = velocities.shape[1]
    scale = particles / (particles - len(kinds))
    return np.asarray(scale * kinetic_temperature(relative, masses))

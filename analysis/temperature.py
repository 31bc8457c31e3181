"""Temperature of the colloids, from their velocities about the mean drift."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def colloid_temperature(velocities: Array, mass: float) -> Array:
    """Kinetic temperature of the colloids in each frame.

    The drift is one velocity for all colloids and frames. It takes one of the T N degrees of
    freedom of each direction; a drift of each frame would take one of its N, and leave none of a
    single colloid.

    Args:
        velocities: (T, N, d), more than one in all [a0/t0].
        mass: of one colloid, M_c [m_f].

    Returns:
        (T,) [kBT]; its mean is the temperature.
    """
    frames, colloids, _ = velocities.shape
    samples = frames * colloids
    thermal = velocities - velocities.mean(axis=(0, 1))
    return np.asarray(mass * (thermal**2).mean(axis=(1, 2)) * samples / (samples - 1))

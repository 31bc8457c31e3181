"""Flow of the fluid across a slit: profile, parabola, Reynolds number (tabatabaei-2009, 3.2.6).

Profiles come as averages over bins of y and over sampling intervals. Each interval of a bin is
weighted by the particles it held, so that the mean over time is momentum over mass.
"""

import numpy as np

from analysis.arrays import Array


def momentum_profile(counts: Array, velocity: Array) -> Array:
    """Momentum of each bin in each interval over the bin's mean mass; its time mean is <v_x>.

    Args:
        counts: particles in each bin, (K, bins).
        velocity: their mean velocity along x, (K, bins) [a0/t0].

    Returns:
        (K, bins) [a0/t0]; 0 for a bin that is always empty.
    """
    mean = counts.mean(axis=0)
    return np.asarray(
        np.divide(counts * velocity, mean, out=np.zeros_like(velocity), where=mean > 0)
    )


def mean_velocity(counts: Array, velocity: Array) -> Array:
    """Mean velocity of the fluid along x in each interval, of all bins together.

    Args:
        counts: particles in each bin, (K, bins).
        velocity: their mean velocity along x, (K, bins) [a0/t0].

    Returns:
        (K,) [a0/t0]; an interval without fluid counts as 0.
    """
    total = counts.sum(axis=1)
    momentum = (counts * velocity).sum(axis=1)
    return np.asarray(np.divide(momentum, total, out=np.zeros_like(total), where=total > 0))


def parabola(y: Array, width: float) -> Array:
    """u(y) = 4 y (L_y - y) / L_y^2 averaged over bins: 0 at the walls, 1 on the mid-line.

    Args:
        y: centres of equal, adjacent bins, (bins,), at least 2 [a0].
        width: L_y, walls at 0 and L_y [a0].

    Returns:
        (bins,); the exact mean over the part of each bin between the walls, NaN where none is.
    """
    half = (y[1] - y[0]) / 2
    low, high = np.clip(y - half, 0, width), np.clip(y + half, 0, width)
    integral = _parabola_integral(high, width) - _parabola_integral(low, width)
    extent = high - low
    return np.asarray(np.divide(integral, extent, out=np.full_like(y, np.nan), where=extent > 0))


def _parabola_integral(y: Array, width: float) -> Array:
    return 4 / width**2 * (width * y**2 / 2 - y**3 / 3)


def fit_parabola(y: Array, width: float, counts: Array, velocity: Array) -> tuple[Array, Array]:
    """Least-squares v_x(y) = v_wall + (v_max - v_wall) u(y), u as in `parabola`.

    Symmetric about the mid-line, as the flow is. Bins are weighted by their mean particle number.
    The fit is linear, so the fit of the mean profile is the mean of the fits of the intervals, and
    their scatter over time gives its error.

    Args:
        y: centres of equal, adjacent bins, (bins,) [a0].
        width: L_y [a0].
        counts: particles in each bin, (K, bins).
        velocity: their mean velocity along x, (K, bins) [a0/t0].

    Returns:
        v_max and v_wall of each interval, each (K,) [a0/t0].

    Raises:
        ValueError: when fewer than 3 bins between the walls hold fluid.
    """
    shape = parabola(y, width)
    used = np.isfinite(shape) & (counts.mean(axis=0) > 0)
    if used.sum() < 3:
        raise ValueError("fewer than 3 bins hold fluid")
    basis = np.column_stack([shape[used], 1 - shape[used]])
    weights = np.sqrt(counts[:, used].mean(axis=0))
    momentum = momentum_profile(counts[:, used], velocity[:, used])
    v_max, v_wall = np.linalg.pinv(basis * weights[:, None]) @ (momentum * weights).T
    return v_max, v_wall


def reynolds_number(velocity: float, width: float, viscosity: float) -> float:
    """Re = v L / nu, tabatabaei-2009 (4.11).

    Args:
        velocity: mean velocity of the fluid [a0/t0].
        width: of the channel [a0].
        viscosity: kinematic [a0^2/t0].
    """
    return velocity * width / viscosity

"""Settling speed in the frames that are in use (hecht-2005, VIII A and 37)."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from analysis.blocking import Estimate
from analysis.line_fit import fit_polynomial

Array = NDArray[np.float64]


@dataclass(frozen=True)
class SettlingSpeeds:
    """Speed of the colloids downwards over each interval, by frame, (K,) [a0/t0].

    Attributes:
        zero_momentum: in which colloids and fluid together do not move, by mass.
        relative_to_fluid: less the mean velocity of the fluid.
        zero_volume_flux: in which they do not move by volume, as in a vessel with a bottom.
    """

    zero_momentum: Array
    relative_to_fluid: Array
    zero_volume_flux: Array


def settling_speeds(
    colloids: Array, fluid: Array, mean: Array, volume_fraction: float
) -> SettlingSpeeds:
    """The speeds from velocities along the pull, all in one frame, whichever.

    Args:
        colloids: mean velocity of the colloids over each interval, (K,) [a0/t0].
        fluid: of the fluid, (K,).
        mean: of both together, weighted by mass, (K,).
        volume_fraction: phi of the colloids: the volume flux is phi v_c + (1 - phi) v_f.
    """
    relative = colloids - fluid
    return SettlingSpeeds(colloids - mean, relative, (1 - volume_fraction) * relative)


def richardson_zaki(
    volume_fractions: ArrayLike, speeds: ArrayLike, errors: ArrayLike
) -> tuple[Estimate, Estimate]:
    """v_inf [a0/t0] and the exponent l of v = v_inf (1 - phi)^l (37), of the logarithms.

    The exponent depends on the frame of the speeds and on the range of phi: state both.

    Raises:
        ValueError: for too few speeds, or one that is not positive.
    """
    phi, speed, error = (np.asarray(a, dtype=float) for a in (volume_fractions, speeds, errors))
    if not (speed > 0).all():
        raise ValueError(f"speeds {speed}: must be positive")
    offset, exponent = fit_polynomial(np.log1p(-phi), np.log(speed), error / speed)
    assert offset.value is not None
    assert offset.error is not None
    single = float(np.exp(offset.value))
    return Estimate(single, single * offset.error), exponent

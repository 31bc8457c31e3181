"""Settling speed in the frames that are in use (hecht-2005, VIII A and 37)."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from analysis.arrays import Array
from analysis.estimate import Estimate
from analysis.line_fit import fit_polynomial


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
    volume_fractions: ArrayLike, speeds: Sequence[Estimate]
) -> tuple[Estimate, Estimate]:
    """v_inf [a0/t0] and the exponent l of v = v_inf (1 - phi)^l (37), of the logarithms.

    The exponent depends on the frame of the speeds and on the range of phi: state both.

    Raises:
        ValueError: for too few speeds, or one that is not positive.
    """
    for speed in speeds:
        if not speed.number > 0:
            raise ValueError(f"a speed of {speed.number}: must be positive")
    logarithms = [
        replace(v, value=math.log(v.number), error=v.standard_error / v.number) for v in speeds
    ]
    porosity = np.log1p(-np.asarray(volume_fractions, dtype=float))
    offset, exponent = fit_polynomial(porosity, logarithms).coefficients
    single = math.exp(offset.number)
    return replace(offset, value=single, error=single * offset.standard_error), exponent

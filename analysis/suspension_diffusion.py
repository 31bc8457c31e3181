"""Diffusion of colloids in a periodic box of fluid (hecht-2005, 34 to 36), and in an infinite one.

D by the mean squared displacement and by the correlation of velocities, all directions together,
about the mean drift. Velocities are displacements over sampling intervals: their sum (35) is then
exact for any interval, and for an interval of one collision it is the paper's.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from analysis.arrays import Array
from analysis.diffusion import (
    SEGMENTS,
    autocorrelation,
    mean_squared_displacement,
)
from analysis.estimate import Estimate, jackknife

CUBIC = 2.837297  # of the Ewald sum of a cubic lattice
TERMS = 50  # of (35), in collisions, as in IX B
LEAST_LAGS = 4
WAVES = 20  # of a box along an axis, either way


@dataclass(frozen=True)
class SuspensionDiffusion:
    """D of a colloid [a0^2/t0], and what it is made of.

    Attributes:
        times: of the lags, (lags,) [t0].
        msd: mean squared displacement in one direction, (lags,) [a0^2].
        integral: of (35) up to each lag, (lags,) [a0^2/t0].
        from_msd, green_kubo: D.
        kept: of a velocity at the longest lag, as a part of it: 0 where D is that of long times.
    """

    times: Array
    msd: Array
    integral: Array
    from_msd: Estimate
    green_kubo: Estimate
    kept: Estimate


def suspension_diffusion(positions: Array, interval: float, longest: float) -> SuspensionDiffusion:
    """D from unwrapped positions, its error by the jackknife over 8 segments of time.

    (36) is half the slope of the mean squared displacement between half of the longest lag and it;
    (35) is summed up to the longest lag. That is `longest`, or a quarter of a segment.

    Args:
        positions: (T, N, d) [a0].
        interval: between frames [t0].
        longest: lag [t0].

    Raises:
        ValueError: for too few frames.
    """
    length = len(positions) // SEGMENTS
    last = min(round(longest / interval), length // 4)
    if last < LEAST_LAGS:
        least = 4 * LEAST_LAGS * SEGMENTS
        raise ValueError(f"{len(positions)} frames; at least {least} are needed")
    drift = (positions[-1] - positions[0]).mean(axis=0) / (len(positions) - 1)
    paths = positions - drift * np.arange(len(positions))[:, None, None]
    paths = paths.reshape(len(paths), -1)  # every direction as a particle of its own
    cuts = [slice(n * length, (n + 1) * length) for n in range(SEGMENTS)]
    msds = np.array([mean_squared_displacement(paths[cut])[: last + 1] for cut in cuts])
    velocities = np.diff(paths, axis=0) / interval
    correlations = np.array([autocorrelation(velocities[cut])[: last + 1] for cut in cuts])
    integrals = interval * (np.cumsum(correlations, axis=1) - 0.5 * correlations[:, :1])
    times = np.arange(last + 1) * np.float64(interval)
    late = times >= 0.5 * times[-1]

    def slope(msd: Array) -> float:
        return float(np.polyfit(times[late], msd[late], 1)[0]) / 2

    def kept(correlation: Array) -> float:
        return float(correlation[-1] / correlation[0]) if correlation[0] else 0.0

    return SuspensionDiffusion(
        times,
        msds.mean(axis=0),
        np.asarray(integrals.mean(axis=0), dtype=float),
        jackknife(slope, msds),
        jackknife(lambda integral: float(integral[-1]), integrals),
        jackknife(kept, correlations),
    )


def infinite_box(diffusion: Estimate, viscosity: float, edge: float) -> Estimate:
    """D without the images of a cubic periodic box: kBT 2.837 / (6 pi eta L) more.

    B. Duenweg and K. Kremer, J. Chem. Phys. 99, 6983 (1993); I.-C. Yeh and G. Hummer, J. Phys.
    Chem. B 108, 15873 (2004).

    Args:
        diffusion: in the periodic box [a0^2/t0].
        viscosity: dynamic, eta [m_f/(a0 t0)].
        edge: of the box, L [a0].
    """
    if diffusion.value is None:
        return diffusion
    more = CUBIC / (6 * math.pi * viscosity * edge)
    return replace(diffusion, value=diffusion.value + more)


def outstanding_diffusion(
    diffusion: float, viscosity: float, density: float, edge: float, times: Array
) -> float:
    """What a periodic box and a finite lag take from D of a particle of a fluid, by mode coupling.

    A particle gives its momentum to shear waves, and meets it again while they decay and it
    diffuses itself: its velocity correlation is 2 kBT / (3 rho V) times the sum over the waves k of
    exp(-(nu + D) k^2 t) (B. Alder, D. Gass and T. Wainwright, J. Chem. Phys. 53, 3813, 1970; J.
    Erpenbeck and W. Wood, Phys. Rev. A 26, 1648, 1982). In an infinite box the sum is an integral;
    the difference, over all times, is 2.837 kBT / (6 pi rho (nu + D) L), as in `infinite_box`,
    where D is small beside nu. After a time t the waves of the box are still to come.

    Args:
        diffusion: D [a0^2/t0].
        viscosity: dynamic, rho nu [m_f/(a0 t0)].
        density: of mass, rho [m_f/a0^3].
        edge: of the cubic box, L [a0].
        times: at which half the slope of the mean squared displacement is taken, and averaged.
    """
    decay = viscosity / density + diffusion
    images = CUBIC / (6 * math.pi * density * decay * edge)
    n = np.arange(-WAVES, WAVES + 1) ** 2
    squares = np.sort((n[:, None, None] + n[:, None] + n).ravel())[1:]
    rates = decay * (2 * math.pi / edge) ** 2 * squares
    late = np.mean([np.sum(np.exp(-rates * t) / rates) for t in times])
    return images + 2 / (3 * density * edge**3) * float(late)

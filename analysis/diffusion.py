"""Diffusion of the colloids along the channel: MSD, VACF and what they say of single file.

Correlations by the Wiener-Khinchin theorem, O(T log T): P. de Buyl, "tidynamics", JOSS 3, 877
(2018).
"""

from dataclasses import dataclass

import numpy as np
from scipy import fft, integrate

from analysis.arrays import Array
from analysis.estimate import Estimate, jackknife

SEGMENTS = 8  # of the sampled time, for the jackknife
MIN_LAGS = 10  # in the last decade of lags, from a tenth of a segment's quarter to the quarter
SIGNIFICANT = 3  # errors; 8 segments leave heavy tails: random walks exceed 2 in one of 10 runs
RESOLVED_DECAY = 0.5  # the trapezoid rule is then at most 4 % off for an exponential VACF


def autocorrelation(series: Array) -> Array:
    """Mean over time origins and particles of s(t) s(t + lag).

    Args:
        series: (T, N).

    Returns:
        (T,), by lag in samples; lag l has T - l origins.
    """
    frames = len(series)
    size = fft.next_fast_len(2 * frames, real=True)  # padded: no wrap-around
    spectrum = fft.rfft(series, n=size, axis=0)
    products = fft.irfft((np.abs(spectrum) ** 2).mean(axis=1), n=size)[:frames]
    return np.asarray(products / np.arange(frames, 0, -1))


def mean_squared_displacement(x: Array) -> Array:
    """Mean over time origins and particles of (x(t + lag) - x(t))^2.

    Args:
        x: unwrapped positions, (T, N) [a0].

    Returns:
        (T,), by lag in samples [a0^2].
    """
    x = x - x.mean(axis=0)  # keeps digits: the result is a difference of squares of x
    frames = len(x)
    squares = (x**2).mean(axis=1)
    # sum over origins of x(t)^2 + x(t + lag)^2, from sums of the first and of the last T - lag
    ends = np.cumsum(squares)[::-1] + np.cumsum(squares[::-1])[::-1]
    msd = ends / np.arange(frames, 0, -1) - 2 * autocorrelation(x)
    msd[0] = 0.0
    return np.asarray(msd)


@dataclass(frozen=True)
class Diffusion:
    """Diffusion along x in the frame of the mean drift.

    Attributes:
        times: of the lags, (lags,) [t0].
        msd: mean squared displacement, (lags,) [a0^2].
        vacf: velocity autocorrelation, (lags,) [a0^2/t0^2].
        window: first and last time of the fits [t0].
        exponent: of msd ~ t^exponent in the window.
        subdiffusive: whether the exponent is below 1 by more than three of its errors.
        from_msd: D, half the slope of the MSD in the window [a0^2/t0]; None unless diffusive.
        from_vacf: D, the integral of the VACF to the window's end [a0^2/t0]; None unless
            diffusive and resolved in time.
    """

    times: Array
    msd: Array
    vacf: Array
    window: tuple[float, float]
    exponent: Estimate
    subdiffusive: bool
    from_msd: Estimate
    from_vacf: Estimate


def diffusion(x: Array, velocity: Array, interval: float) -> Diffusion:
    """MSD, VACF, exponent and diffusion coefficient, the mean drift of all colloids taken out.

    The sampled time is cut into 8 segments; lags go to a quarter of a segment, and the exponent
    and D are fitted in the last decade of lags. Errors are the jackknife over segments. The drift
    is one velocity, subtracted from every colloid: a lag t then loses a fraction
    t / (sampled time) of the MSD of a single colloid, 3 % at the longest, and less of many.

    Args:
        x: unwrapped positions along x, (T, N) [a0].
        velocity: along x, (T, N) [a0/t0].
        interval: between frames [t0].

    Raises:
        ValueError: for fewer than 320 frames, or colloids that all move with the drift.
    """
    length = len(x) // SEGMENTS
    last = length // 4
    if last < MIN_LAGS:
        needed = 4 * MIN_LAGS * SEGMENTS
        raise ValueError(
            f"run longer, at least {needed * interval:g} t0: {len(x)} frames; at least {needed} "
            "are needed"
        )
    drift = (x[-1] - x[0]).mean() / (len(x) - 1)
    x = x - drift * np.arange(len(x))[:, None]
    velocity = velocity - velocity.mean()
    cuts = [slice(n * length, (n + 1) * length) for n in range(SEGMENTS)]
    msds = np.array([mean_squared_displacement(x[cut])[: last + 1] for cut in cuts])
    vacfs = np.array([autocorrelation(velocity[cut])[: last + 1] for cut in cuts])

    lags = np.unique(np.geomspace(last / 10, last, MIN_LAGS).round().astype(int))
    times = np.linspace(0, last * interval, last + 1)
    if msds[:, lags].min() <= 0:
        raise ValueError("the colloids do not move about their drift")

    def exponent_of(msd: Array) -> float:
        return _slope(np.log(times[lags]), np.log(msd[lags]))

    def half_slope(msd: Array) -> float:
        return _slope(times[lags], msd[lags]) / 2

    def integral(vacf: Array) -> float:
        return float(integrate.trapezoid(vacf, times))

    exponent = jackknife(exponent_of, msds)
    below = SIGNIFICANT * exponent.standard_error
    subdiffusive = exponent.number < 1 - below
    from_msd, from_vacf = jackknife(half_slope, msds), jackknife(integral, vacfs)
    vacf = vacfs.mean(axis=0)
    if vacf[1] < RESOLVED_DECAY * vacf[0]:
        reason = f"the VACF falls to {vacf[1] / vacf[0]:.2g} of its start in one sampling interval"
        from_vacf = Estimate(None, None, reason)
    if subdiffusive:
        from_msd = from_vacf = Estimate(None, None, "subdiffusive")
    elif exponent.number > 1 + below:
        from_msd = from_vacf = Estimate(None, None, "superdiffusive: the drift is not uniform")
    window = (float(times[lags[0]]), float(times[lags[-1]]))
    return Diffusion(
        times, msds.mean(axis=0), vacf, window, exponent, subdiffusive, from_msd, from_vacf
    )


def _slope(x: Array, y: Array) -> float:
    return float(np.polynomial.polynomial.polyfit(x, y, 1)[1])

"""Means of correlated series, with errors that see slow motion (`analysis/spectrum_at_zero.py`).

Numbers from one run are not independent: a function of several means of one run, as the ratio of
two, goes through `function_of_means`; the difference of two frames is the mean of the difference.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike
from scipy import special

from analysis.arrays import Array
from analysis.estimate import Estimate, mean_of_independent
from analysis.spectrum_at_zero import Fluctuation, fluctuation_of_mean

Runs = ArrayLike | Sequence[ArrayLike]

FEWEST_SAMPLES = 6
KNOWN = 20  # correlation times in a run whose error is taken as known
ADVISED = 30


def mean(series: Runs, interval: float | None = None) -> Estimate:
    """Mean of equidistant, correlated samples with its error.

    Where a run is likely to be shorter than `KNOWN` times the slow motion in its error, the error
    is a lower bound, and the reason says how long a run must be; so it is of fewer than
    `FEWEST_SAMPLES` samples. A single sample has none.

    Args:
        series: samples of a run, (n,), or of several independent runs of one system, (n_i,) each;
            every sample has the same weight.
        interval: between samples [t0]; the advice is then in t0, else in samples.

    Raises:
        ValueError: for a sample that is not finite.
    """
    runs = _as_runs(series)
    if not runs:
        return Estimate(None, None, "no samples")
    samples = runs[0] if len(runs) == 1 else np.concatenate(runs)
    if not np.isfinite(samples).all():
        raise ValueError("a sample is not finite")
    value = float(samples.mean())
    if len(samples) == 1:
        return Estimate(value, None, "one sample has no error")
    if np.all(samples == samples[0]):
        return Estimate(value, 0.0)  # not the rounding of the mean
    if len(samples) < FEWEST_SAMPLES:
        few = f"lower bound: run longer, {len(samples)} samples are too few"
        return replace(mean_of_independent(samples), reason=few)
    fluctuation = fluctuation_of_mean(runs)
    error, freedom = fluctuation.student()
    return Estimate(value, error, _too_slow(fluctuation, len(samples), interval), freedom)


def correlation_time(series: Runs, interval: float = 1.0) -> Estimate:
    """Integrated autocorrelation time tau with its own error, from the same model as `mean`.

    tau = n (error of the mean)^2 / (2 variance): the mean of n samples is as good as one of
    n / (2 tau) independent ones. White noise has half a sample; correlations exp(-t/tau) that are
    long against a sample and short against the run have tau.

    Args:
        series: as for `mean`, at least `FEWEST_SAMPLES` samples.
        interval: between samples [t0].

    Returns:
        tau [t0, or samples], the median of its distribution and half of its 68 % interval.
    """
    runs = _as_runs(series)
    samples = np.concatenate(runs) if runs else np.empty(0)
    if len(samples) < FEWEST_SAMPLES:
        return Estimate(None, None, f"{len(samples)} samples are too few")
    if np.all(samples == samples[0]):
        return Estimate(None, None, "all samples are the same")
    fluctuation = fluctuation_of_mean(runs)
    low, median, high = fluctuation.variances([special.ndtr(-1), 0.5, special.ndtr(1)])
    scale = interval * len(samples) / (2 * float(samples.var(ddof=1)))
    reason = _too_slow(fluctuation, len(samples), interval)
    return Estimate(scale * median, scale * (high - low) / 2, reason)


def ratio(numerator: Runs, denominator: Runs, interval: float | None = None) -> Estimate:
    """Ratio of the means of two series that were sampled together; as `function_of_means`."""
    below = _as_runs(denominator)
    if below and np.concatenate(below).mean() == 0:
        return Estimate(None, None, "the denominator is zero")
    return function_of_means(lambda a, b: a / b, numerator, denominator, interval=interval)


def function_of_means(
    function: Callable[..., float], *series: Runs, interval: float | None = None
) -> Estimate:
    """A function of the means of series that were sampled together, with their covariances.

    To first order in the fluctuations, the function of the means fluctuates as the one series
    sum_i (df/dm_i) (x_i(t) - m_i) does, and has the error of its mean: correlations between the
    series and in time both count.

    Args:
        function: of as many numbers as there are series, smooth at their means.
        series: each as for `mean`, all of the same lengths.
        interval: as for `mean`.

    Raises:
        ValueError: for series of different lengths.
    """
    together = [_as_runs(one) for one in series]
    lengths = [[len(run) for run in runs] for runs in together]
    if any(other != lengths[0] for other in lengths):
        raise ValueError("series sampled together must have the same lengths")
    if not lengths[0]:
        return Estimate(None, None, "no samples")
    samples = np.array([np.concatenate(runs) for runs in together])
    means = samples.mean(axis=1)
    steps = 1e-5 * np.maximum(np.abs(means), samples.std(axis=1))
    gradient = np.zeros(len(means))
    for i in np.flatnonzero(steps):
        shift = np.zeros(len(means))
        shift[i] = steps[i]
        gradient[i] = (function(*(means + shift)) - function(*(means - shift))) / (2 * steps[i])
    linear = gradient @ (samples - means[:, None])
    fluctuation = mean(np.split(linear, np.cumsum(lengths[0])[:-1]), interval)
    return replace(fluctuation, value=float(function(*means)))


def _as_runs(series: Runs) -> list[Array]:
    """One run or several as a list of arrays, without empty ones."""
    if isinstance(series, list | tuple) and len(series) and np.ndim(series[0]) > 0:
        runs = [np.asarray(run, dtype=float) for run in series]
    else:
        runs = [*np.atleast_2d(np.asarray(series, dtype=float))]
    if any(run.ndim != 1 for run in runs):
        raise ValueError("a run is a one-dimensional series of samples")
    return [run for run in runs if len(run)]


def _too_slow(fluctuation: Fluctuation, samples: int, interval: float | None) -> str | None:
    """What to do about a run that is short for its slow motion."""
    motion = fluctuation.slower_than(samples / KNOWN)
    if motion is None:
        return None
    scale, unit = (1.0, "samples") if interval is None else (interval, "t0")
    slow = scale * motion
    return (
        f"lower bound: run longer, at least {two_digits(ADVISED * slow)} {unit}; motion of about "
        f"{two_digits(slow)} {unit} is slow for {scale * samples:.6g} {unit}"
    )


def two_digits(number: float) -> str:
    """Two digits, without a power of ten below a million: 2300, not 2.3e+03."""
    return f"{float(f'{number:.2g}'):g}"

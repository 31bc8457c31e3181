"""How far a time mean may be off: the spectrum of a series at frequency 0, from its slow modes.

The variance of a mean is the spectrum at frequency 0, where nothing is measured. A run of length T
has the cosine modes k = 1, 2, ... of frequency k/(2T), and the variance of each is the spectrum
there (U. K. Mueller, J. Bus. Econ. Stat. 32, 311 (2014), takes the error from the slowest of them;
P. Heidelberger and P. D. Welch, Commun. ACM 24, 233 (1981), extrapolate to 0). A slow motion that
is 1 % of the variance raises the lowest modes only, and can be most of the error.

The series is modelled as noise of a level a, whose spectrum rises by a factor r_1 below the
frequency 1/(2 pi tau_1), and again by r_2 at tau_2. Sums of exponentially decaying correlations
are of this form, and r < 1 holds anticorrelation. The likelihood of Gaussian modes (P. Whittle,
Ark. Mat. 2, 423 (1953)) is summed over a grid of (tau, r), each uniform in its logarithm, the steps
also absent, and integrated over a. What results is a distribution of the mean about its truth,
which holds what a run cannot know: steps so slow that it hardly resolves them. Its tails are
heavy for short runs, and few weights in the prior (`ABSENT`, `LONGEST`) make them; they were set
by the coverage of `benchmarks/interval_coverage.py`, whose results are in `docs/coverage.md`.

Several runs of one system count together: each has its modes, and the spread of their means about
the common mean is the measured part of mode 0.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy import fft, optimize, special, stats

from analysis.arrays import Array

MOST_MODES = 256  # of the lowest frequencies; an error from white noise is then known to 4 %
MOST_BLOCKS = 1024  # longer series are averaged to at most so many blocks first
SINGLE_MODES = 8  # the others are summed over bins of 15 %
TIMES = 0.55  # between two tau, in the logarithm
ABSENT = 0.65  # prior probability of each step to be absent
FALLING = 0.1  # prior probability of a present step to be a fall
RISES = np.geomspace(1.6, 1e5, 15)
FALLS = np.geomspace(0.5, 0.02, 4)
LONGEST = 1.5  # slowest tau of a rise, in lengths of all runs together
LONGEST_FALL = 0.1
NEGLIGIBLE = 1e-6  # weight beside the largest
SCALES = 100  # that the distributions are kept on
LIKELY = 0.25


@dataclass(frozen=True)
class Fluctuation:
    """The distribution of a mean about its truth: a mixture of Student's t.

    Attributes:
        scales: of its parts, increasing, (S,).
        weights: of its parts, their sum is 1, (S,).
        freedom: of each part, the number of modes.
        slow: times of the motion that makes the error, by its part in it, in samples; 0 where it
            is faster than the samples, increasing, (Q,), equally probable.
    """

    scales: Array
    weights: Array
    freedom: float
    slow: Array

    def slower_than(self, time: float) -> float | None:
        """The slow motion's time, where it is likely beyond a time; both in samples.

        Returns:
            the median of what lies beyond, None where less than `LIKELY` of the probability does.
        """
        beyond = self.slow[self.slow > time]
        if len(beyond) < LIKELY * len(self.slow):
            return None
        return float(np.median(beyond))

    def half_width(self, confidence: float) -> float:
        """Half of the interval with this probability."""

        def excess(log_width: float) -> float:
            tails = special.stdtr(self.freedom, -math.exp(log_width) / self.scales)
            return float(2 * self.weights @ tails) - (1 - confidence)

        low, high = math.log(self.scales[0]) - 6, math.log(self.scales[-1]) + 1
        while excess(high) > 0:
            high += 1
        return math.exp(optimize.brentq(excess, low, high, xtol=1e-4))

    def student(self) -> tuple[float, float]:
        """Scale and degrees of freedom of the one t with the same 68 and 95 % intervals."""
        one, two = self.half_width(special.ndtr(1) - special.ndtr(-1)), self.half_width(0.95)
        ratios, widths, freedoms = _student_widths()
        freedom = float(np.interp(two / one, ratios, freedoms))
        return one / float(np.interp(two / one, ratios, widths)), freedom

    def variances(self, probabilities: Sequence[float]) -> list[float]:
        """Quantiles of the variance of the mean."""
        centres = np.cumsum(self.weights) - self.weights / 2
        return [float(v) for v in np.interp(probabilities, centres, self.scales**2)]


def fluctuation_of_mean(runs: Sequence[Array]) -> Fluctuation:
    """The distribution of the mean of all samples of some runs.

    Args:
        runs: of one system, (n_i,) each, not all samples the same.
    """
    blocks, size = _block_means(runs)
    counts = np.array([len(run) for run in blocks])
    total = int(counts.sum())
    times = _times(int(counts.max()), total)
    grid = _grid(times)
    mean = float(np.concatenate(blocks).mean())
    power: list[Array] = []
    number: list[Array] = []
    shape: list[Array] = []
    zero = np.zeros(len(times))
    for count in np.unique(counts):
        same = np.array([run for run in blocks if len(run) == count])
        edges, variance = _mode_variances(int(count), times)
        squares = (fft.dct(same - mean, norm="ortho", axis=1) ** 2).sum(axis=0)
        power += [squares[:1], np.add.reduceat(squares[: edges[-1]], edges[:-1])]
        # the common mean is fitted
        number += [np.array([len(same) * (1 - count / total)]), len(same) * np.diff(edges)]
        shape.append(variance)
        zero += len(same) * count / total * variance[:, 0]
    spectra = grid.spectra(np.concatenate(shape, axis=1))
    ends = grid.spectra(zero[:, None])[:, 0]
    measured, modes = np.concatenate(power), np.concatenate(number)
    level, freedom = float(measured.sum()), float(modes.sum())
    # for every pair of steps: the sum over modes of power / (spectrum / a), then the likelihood
    inverse = (1 / spectra).astype(np.float32)
    sums = (inverse * (measured / level).astype(np.float32)) @ inverse.T
    alone = (grid.prior - np.log(spectra) @ modes / 2).astype(np.float32)
    logs = alone[:, None] + alone - np.float32(freedom / 2) * np.log(sums)
    weights = np.exp(logs - logs.max())
    first, second = np.nonzero(weights > NEGLIGIBLE)
    weight = weights[first, second].astype(float)
    weight /= weight.sum()
    variance = ends[first] * ends[second] * sums[first, second] * level / freedom / total
    variance *= total * size / sum(map(len, runs))  # of samples that fill no block
    own = grid.time * np.maximum(0.0, 1 - 1 / ends)  # by the part of the error that it makes
    slow = _quantiles(np.maximum(own[first], own[second]), weight)
    return Fluctuation(*_histogram(np.sqrt(variance), weight), freedom, size * slow)


def _block_means(runs: Sequence[Array]) -> tuple[list[Array], int]:
    """Means over blocks of as many samples, and that number."""
    size = max(1, 2 * max(map(len, runs)) // MOST_BLOCKS)
    return [
        run[: len(run) // size * size].reshape(-1, size).mean(axis=1)
        for run in runs
        if len(run) >= size
    ], size


@dataclass(frozen=True)
class _Grid:
    """The possible steps of the spectrum: none, and every (tau, r).

    Attributes:
        place: of each step's tau in the list of times, (G,).
        time: tau, in blocks, (G,).
        factor: r, 1 for none, (G,).
        prior: logarithm of the prior weight, (G,).
    """

    place: NDArray[np.int64]
    time: Array
    factor: Array
    prior: Array

    def spectra(self, variances: Array) -> Array:
        """1 + (r - 1) L for mode variances L of each tau, (times, B) -> (G, B)."""
        return np.asarray(1 + (self.factor[:, None] - 1) * variances[self.place])


def _times(longest: int, total: int) -> tuple[float, ...]:
    """The grid of tau, in blocks: from the fastest mode of the longest run on."""
    fastest = longest / (math.pi * min(max(longest - 1, 1), MOST_MODES))
    count = round(math.log(LONGEST * total / fastest) / TIMES) + 1
    return tuple(np.geomspace(fastest, LONGEST * total, max(4, count)))


@lru_cache(maxsize=64)
def _grid(times: tuple[float, ...]) -> _Grid:
    falling = sum(time <= LONGEST_FALL / LONGEST * times[-1] for time in times)
    rise = (1 - FALLING) / (len(times) * len(RISES))
    fall = FALLING / max(1, falling * len(FALLS))
    steps = [(0, 1.0, ABSENT)]
    steps += [(n, r, (1 - ABSENT) * rise) for n in range(len(times)) for r in RISES]
    steps += [(n, r, (1 - ABSENT) * fall) for n in range(falling) for r in FALLS]
    place, factor, weight = (np.array(column) for column in zip(*steps, strict=True))
    return _Grid(place, np.array(times)[place], factor, np.log(weight))


@lru_cache(maxsize=64)
def _mode_variances(count: int, times: tuple[float, ...]) -> tuple[NDArray[np.int64], Array]:
    """Variance of the cosine modes of correlations exp(-t/tau), in bins of modes.

    With w = pi k / T and L = 1/(1 + (w tau)^2) the double integral of
    cos(wt) cos(wt') exp(-|t - t'|/tau) gives L - 2 (tau/T) L^2 (1 - (-1)^k exp(-T/tau)), and
    1 - (tau/T)(1 - exp(-T/tau)) for k = 0; 1 is the spectrum at frequency 0. Discrete samples have
    2 sin(w/2) in place of w.

    Args:
        count: samples in the series.
        times: tau, in samples.

    Returns:
        edges of the bins of modes from 1 on, (B + 1,), and the variances, column 0 that of k = 0,
        (times, B + 1).
    """
    last = min(count - 1, MOST_MODES)
    edges = [1]
    while edges[-1] <= last:
        width = 1 if edges[-1] <= SINGLE_MODES else max(1, round(0.15 * edges[-1]))
        edges.append(min(edges[-1] + width, last + 1))
    bins = np.array(edges)
    widths = np.diff(bins)
    parity = np.where(widths == 1, 1.0 - 2.0 * (bins[:-1] % 2), 0.0)
    frequency = 2 * np.sin(np.pi * (bins[:-1] + (widths - 1) / 2) / (2 * count))
    tau = np.array(times)[:, None]
    lorentz = 1 / (1 + (frequency * tau) ** 2)
    left = np.exp(-count / tau)
    variance = lorentz - 2 * tau / count * lorentz**2 * (1 - parity * left)
    zero = 1 - tau / count * (1 - left)
    return bins, np.concatenate([zero, np.maximum(variance, 1e-12)], axis=1)


def _quantiles(values: Array, weights: Array) -> Array:
    """`SCALES` equally probable values."""
    order = np.argsort(values)
    places = np.searchsorted(np.cumsum(weights[order]), (np.arange(SCALES) + 0.5) / SCALES)
    return np.asarray(values[order[np.minimum(places, len(order) - 1)]])


def _histogram(scale: Array, weight: Array) -> tuple[Array, Array]:
    """The mixture on few scales, increasing."""
    logs = np.log(scale)
    width = max((logs.max() - logs.min()) / SCALES, 0.02)
    place = ((logs - logs.min()) / width).astype(int)
    weights = np.bincount(place, weight)
    used = weights > 0
    centres = np.bincount(place, weight * logs)[used] / weights[used]
    return np.exp(centres), np.asarray(weights[used], dtype=float)


@lru_cache(maxsize=1)
def _student_widths() -> tuple[Array, Array, Array]:
    """Of Student's t: 95 over 68 % interval, half of the 68 % interval, freedom."""
    freedoms = np.geomspace(4 * MOST_MODES, 1, 200)
    widths = np.asarray(stats.t.ppf(special.ndtr(1), freedoms))
    ratios = np.asarray(stats.t.ppf(0.975, freedoms)) / widths
    return ratios, widths, freedoms

"""Diffusivity by the likelihood of transitions between bins.

G. Hummer, New J. Phys. 7, 34 (2005), the method of carmer-2012's reference 2: (1) in bins of
width w is a rate matrix with R(i+1, i) = D(i+1/2) / w^2 sqrt(P(i+1) / P(i)) and detailed balance,
and its propagator exp(R t) gives the likelihood of the transitions seen in a lag t. Hummer's prior
makes neighbours alike; how much is chosen here by the evidence (D. MacKay, Neural Comput. 4, 415,
1992), in Laplace's approximation.
"""

from collections.abc import Sequence
from typing import Any

import emcee
import numpy as np
from MDAnalysis.analysis.base import AnalysisBase
from scipy.linalg import eigh
from scipy.optimize import minimize

from analysis.arrays import Array
from analysis.diffusivity.color import frame_time
from analysis.diffusivity.coordinates import Coordinate
from analysis.diffusivity.errors import DiffusivityError

MIN_CROSSINGS = 20  # between any two neighbouring bins
LEAST_DISPLACEMENT = 2.5  # bins in a lag: below, where in its bin a walker began matters
ROUGHNESS = tuple(np.geomspace(0.05, 5, 9))  # change of log D over a length of 1, rms: tried
_TINY = 1e-300


def _squares(bins: int) -> Array:
    """Square of the bins between two, (B, B)."""
    number = np.arange(bins)
    return np.asarray((number[:, None] - number[None, :]) ** 2, dtype=float)


class TransitionLikelihood:
    """Log-likelihood of transition counts as a function of log D at the faces between bins.

    Args:
        counts: transitions, (B, B), from column to row.
        population: equilibrium probabilities of the bins, (B,).
        width: of a bin.
        lag: time of a transition.
    """

    def __init__(self, counts: Array, population: Array, width: float, lag: float) -> None:
        self._counts, self._lag, self._scale = counts, lag, width**-2
        self._up = np.sqrt(population[1:] / population[:-1])
        self._root = np.sqrt(population)

    def rate_matrix(self, log_diffusivity: Array) -> Array:
        """P^-1/2 R P^1/2, symmetric by detailed balance, (B, B)."""
        rate = self._scale * np.exp(log_diffusivity)
        matrix = np.diag(rate, 1) + np.diag(rate, -1)
        matrix[np.arange(len(rate)), np.arange(len(rate))] -= rate * self._up
        after = np.arange(1, len(rate) + 1)
        matrix[after, after] -= rate / self._up
        return np.asarray(matrix)

    def value(self, log_diffusivity: Array) -> float:
        """Sum of counts times the logarithm of the propagator."""
        return self.value_and_gradient(log_diffusivity, gradient=False)[0]

    def value_and_gradient(
        self, log_diffusivity: Array, gradient: bool = True
    ) -> tuple[float, Array]:
        """The value and its derivative by each log D, from the derivative of the exponential."""
        if not np.all(np.abs(log_diffusivity) < 50):
            return -np.inf, np.zeros_like(log_diffusivity)
        values, vectors = eigh(self.rate_matrix(log_diffusivity))
        decay = np.exp(values * self._lag)
        kernel = np.maximum((vectors * decay) @ vectors.T, _TINY)
        scale = self._root[:, None] / self._root[None, :]
        value = float(np.sum(self._counts * np.log(kernel * scale)))
        if not gradient:
            return value, np.zeros(0)
        difference = values[:, None] - values[None, :]
        close = np.abs(difference) * self._lag < 1e-8
        divided = np.where(
            close,
            self._lag * decay[:, None],
            (decay[:, None] - decay[None, :]) / np.where(close, 1.0, difference),
        )
        inner = vectors.T @ (self._counts / kernel) @ vectors
        slope = vectors @ (inner * divided) @ vectors.T
        rate = self._scale * np.exp(log_diffusivity)
        n = np.arange(len(rate))
        total = slope[n, n + 1] + slope[n + 1, n]
        total -= slope[n, n] * self._up + slope[n + 1, n + 1] / self._up
        return value, np.asarray(rate * total)


class SmoothPosterior:
    """Log of likelihood times prior: differences of log D between faces are normal.

    Their variance is roughness^2 w, so that log D is a random walk, whatever the width of bins.
    """

    def __init__(self, likelihood: TransitionLikelihood, variance: float) -> None:
        self._likelihood, self._variance = likelihood, variance

    def value(self, log_diffusivity: Array) -> float:
        """Up to a constant."""
        prior = float(np.sum(np.diff(log_diffusivity) ** 2)) / (2 * self._variance)
        return self._likelihood.value(log_diffusivity) - prior

    def value_and_gradient(self, log_diffusivity: Array) -> tuple[float, Array]:
        """The value and its derivative by each log D."""
        value, gradient = self._likelihood.value_and_gradient(log_diffusivity)
        steps = np.diff(log_diffusivity)
        pull = np.diff(steps, prepend=0, append=0) / self._variance
        return value - float(np.sum(steps**2)) / (2 * self._variance), gradient + pull

    def evidence(self, best: Array, covariance: Array) -> float:
        """Logarithm of the integral over log D, by its value and curvature at the top."""
        sign, determinant = np.linalg.slogdet(covariance)
        if sign <= 0:
            return -np.inf
        normal = (len(best) - 1) * np.log(self._variance)
        return self.value(best) + 0.5 * float(determinant) - 0.5 * float(normal)


def smoothed(
    likelihood: TransitionLikelihood, width: float, start: Array
) -> tuple[SmoothPosterior, Array, Array]:
    """The posterior of the most evident roughness, its top and its covariance there."""
    tried = []
    for roughness in ROUGHNESS:
        posterior = SmoothPosterior(likelihood, roughness**2 * width)
        start, covariance = most_likely(posterior, start)
        tried.append((posterior.evidence(start, covariance), posterior, start, covariance))
    _, posterior, best, covariance = max(tried, key=lambda each: each[0])
    return posterior, best, covariance


def most_likely(
    likelihood: TransitionLikelihood | SmoothPosterior, start: Array
) -> tuple[Array, Array]:
    """log D of the highest value and its covariance from the curvature there."""

    def descent(x: Array) -> tuple[float, Array]:
        value, gradient = likelihood.value_and_gradient(x)
        return -value, -gradient

    best = minimize(descent, start, jac=True, method="L-BFGS-B", options={"maxiter": 2000}).x
    step = 1e-4
    curvature = np.array(
        [
            (descent(best + step * unit)[1] - descent(best - step * unit)[1]) / (2 * step)
            for unit in np.eye(len(best))
        ]
    )
    return best, np.linalg.pinv((curvature + curvature.T) / 2)


class BayesianDiffusivity(AnalysisBase):  # type: ignore[misc]
    """D at the faces between bins by likelihood, for several lags, with the posterior of one.

    Transitions are counted over windows that do not overlap. The prior has log D a random walk
    along the coordinate, as rough as the data make most probable, and the measured populations;
    `emcee` samples the posterior at the chosen lag. Short lags see motion that is not yet diffusive
    and the width of the bins, long ones wash the profile out: `results.by_lag` shows both.

    Args:
        coordinate: `AlongAxis` or `PairDistance`.
        low, high: range of the bins: the walls, or beyond which pairs are not followed.
        bins: number of bins.
        lags: in frames, increasing.
        lag: of the result, one of `lags`; by default the first in which walkers move by 2.5 bins
            or more, rms, and whose profile agrees with that of the next lag within the errors, rms;
            the last if none does.
        samples: steps of the sampler for each of its 2 (bins + 1) chains; 0 for the curvature only.
        seed: of the sampler.

    Attributes:
        results.positions: faces between bins (B - 1,).
        results.diffusivity, results.error: median and half the central 68 % of the posterior (with
            no samples: its top, and from the curvature there).
        results.interval: central 95 % of the posterior, (2, B - 1).
        results.lags, results.by_lag, results.errors_by_lag: lag times (L,), most probable D and
            its errors (L, B - 1).
        results.lag: the chosen one, in time.
        results.density: walkers per length of the coordinate, in the bins (B,).
    """

    def __init__(
        self,
        coordinate: Coordinate,
        low: float,
        high: float,
        *,
        bins: int = 20,
        lags: Sequence[int] = (1, 2, 4, 8, 16),
        lag: int | None = None,
        samples: int = 400,
        seed: int = 0,
        **options: Any,
    ) -> None:
        super().__init__(coordinate.trajectory, **options)
        if not low < high:
            raise DiffusivityError(f"low: {low:g}; it must be below high, {high:g}")
        if bins < 3:
            raise DiffusivityError(f"bins: {bins}; at least 3 are needed")
        self._lags = list(lags)
        if not self._lags or self._lags[0] < 1 or (np.diff(self._lags) <= 0).any():
            raise DiffusivityError(f"lags: {self._lags}; positive and increasing, in frames")
        if lag is not None and lag not in self._lags:
            raise DiffusivityError(f"lag: {lag}; it must be one of the lags, {self._lags}")
        self._coordinate, self._low, self._high = coordinate, low, high
        self._bins, self._lag, self._samples, self._seed = bins, lag, samples, seed
        self._width = (high - low) / bins

    def _prepare(self) -> None:
        self._counts = np.zeros((len(self._lags), self._bins * self._bins))
        self._number = np.zeros(self._bins)
        self._origins: list[Any] = [None] * len(self._lags)

    def _single_frame(self) -> None:
        scaled = (self._coordinate.values() - self._low) / self._width
        # walls are where they are only up to the rounding of the file
        place = np.floor(np.where(np.abs(scaled - self._bins) < 1e-4, self._bins - 0.5, scaled))
        place = np.where((place >= 0) & (place < self._bins), place, -1).astype(np.intp)
        self._number += np.bincount(place[place >= 0], minlength=self._bins)
        for n, lag in enumerate(self._lags):
            if self._frame_index % lag == 0:
                if self._origins[n] is not None:
                    kept = (place >= 0) & (self._origins[n] >= 0)
                    moved = place[kept] * self._bins + self._origins[n][kept]
                    self._counts[n] += np.bincount(moved, minlength=self._bins**2)
                self._origins[n] = place

    def _conclude(self) -> None:
        step = frame_time(self)
        counts = self._counts.reshape(-1, self._bins, self._bins)
        self.results.positions = self._low + self._width * np.arange(1, self._bins)
        self.results.density = self._number / (self.n_frames * self._width)
        if self._number.min() == 0:
            empty = self._low + self._width * (int(self._number.argmin()) + 0.5)
            raise DiffusivityError(f"no walker was ever in the bin at {empty:.4g}: fewer bins")
        population = self._number / self._number.sum()
        profiles, errors, posteriors = [], [], []
        for lag, count in zip(self._lags, counts, strict=True):
            crossings = [
                int((count[f:, :f]).sum() + (count[:f, f:]).sum()) for f in range(1, self._bins)
            ]
            if min(crossings) < MIN_CROSSINGS:
                raise DiffusivityError(
                    f"{min(crossings)} crossings of a face at a lag of {lag} frames; at least "
                    f"{MIN_CROSSINGS} are needed: a longer trajectory or shorter lags"
                )
            likelihood = TransitionLikelihood(count, population, self._width, lag * step)
            moved = self._width**2 * float((count * _squares(self._bins)).sum() / count.sum())
            guess = np.full(self._bins - 1, np.log(moved / (2 * lag * step)))
            posterior, guess, covariance = smoothed(likelihood, self._width, guess)
            profiles.append(np.exp(guess))
            errors.append(np.exp(guess) * np.sqrt(np.maximum(np.diag(covariance), 0)))
            posteriors.append(posterior)
        self.results.lags = np.array(self._lags) * step
        self.results.by_lag, self.results.errors_by_lag = np.array(profiles), np.array(errors)
        chosen = self._lags.index(self._lag) if self._lag else self._plateau()
        self.results.lag = float(self.results.lags[chosen])
        self._sample(posteriors[chosen], profiles[chosen], errors[chosen])

    def _plateau(self) -> int:
        """The first lag, longer than the bins show, that the next confirms; the last if none."""
        d, error = self.results.by_lag, self.results.errors_by_lag
        for n in range(len(d) - 1):
            moved = np.sqrt(2 * d[n].min() * self.results.lags[n])  # where it is slowest
            if moved < LEAST_DISPLACEMENT * self._width:
                continue
            spread = (d[n + 1] - d[n]) ** 2 / (error[n] ** 2 + error[n + 1] ** 2)
            if np.sqrt(np.mean(spread)) < 1:
                return n
        return len(d) - 1

    def _sample(self, posterior: SmoothPosterior, best: Array, error: Array) -> None:
        if self._samples == 0:
            self.results.diffusivity, self.results.error = best, error
            self.results.interval = best * np.exp(np.outer([-1.96, 1.96], error / best))
            return
        chains = 2 * (len(best) + 2)
        random = np.random.default_rng(self._seed)
        spread = 0.5 * error / best
        start = np.log(best) + spread * random.normal(size=(chains, len(best)))
        sampler = emcee.EnsembleSampler(chains, len(best), posterior.value)
        sampler.random_state = np.random.RandomState(self._seed).get_state()
        sampler.run_mcmc(start, self._samples)
        kept = np.exp(sampler.get_chain(discard=self._samples // 3, flat=True))
        low, lower, middle, upper, high = np.percentile(kept, [2.5, 16, 50, 84, 97.5], axis=0)
        self.results.diffusivity, self.results.error = middle, (upper - lower) / 2
        self.results.interval = np.array([low, high])

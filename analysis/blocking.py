"""Means of correlated series with their statistical errors, from blocking.

H. Flyvbjerg and H. G. Petersen, J. Chem. Phys. 91, 461 (1989): means over blocks of 2, 4, 8, ...
samples become independent once a block outlasts the correlation, and their scatter then is the
error. The block length is chosen by R. M. Lee et al., Phys. Rev. E 83, 066706 (2011).
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

MIN_BLOCKS = 6  # an error from m blocks is itself uncertain by 1/sqrt(2(m - 1)): 32 % with 6
MIN_BLOCK_LENGTH = 2  # in measured inefficiencies g: the error is then at most 20 % too small


@dataclass(frozen=True)
class Estimate:
    """A number and its standard error.

    `reason` says why either is None, or why the error is only a lower bound.
    """

    value: float | None
    error: float | None
    reason: str | None = None

    def scaled(self, factor: float) -> "Estimate":
        """The estimate in other units: value times the factor, error times its modulus."""
        value = None if self.value is None else self.value * factor
        error = None if self.error is None else self.error * abs(factor)
        return Estimate(value, error, self.reason)

    def as_json(self) -> dict[str, Any]:
        """`{value, error}`, and `reason` where there is one."""
        entry: dict[str, Any] = {"value": self.value, "error": self.error}
        if self.reason is not None:
            entry["reason"] = self.reason
        return entry


def blocking_curve(series: ArrayLike) -> tuple[NDArray[np.int64], Array]:
    """Standard error of the mean of a series, by block length.

    Args:
        series: equidistant samples, (n,), at least 2.

    Returns:
        block lengths 1, 2, 4, ... [samples] and the error from each, both (levels,); every level
        has at least two blocks. Samples that do not fill a last block are left out of it.

    Raises:
        ValueError: for fewer than 2 samples or an array that is not one-dimensional.
    """
    blocks = np.asarray(series, dtype=float)
    if blocks.ndim != 1 or len(blocks) < 2:
        raise ValueError(f"a series of at least 2 samples is needed, not shape {blocks.shape}")
    lengths, errors = [], []
    length = 1
    while len(blocks) >= 2:
        lengths.append(length)
        errors.append(float(np.sqrt(blocks.var(ddof=1) / len(blocks))))
        blocks = blocks[: len(blocks) // 2 * 2].reshape(-1, 2).mean(axis=1)
        length *= 2
    return np.array(lengths), np.array(errors)


def mean(series: ArrayLike) -> Estimate:
    """Mean of equidistant, correlated samples with its error.

    With g = (error from blocks of B / error from single samples)^2, the statistical inefficiency
    and at least 1, the block length is the smallest with B^3 > 2 n g^2 (Lee et al.), or, in a
    series too short for that, the longest that leaves `MIN_BLOCKS` blocks. When that block is
    shorter than `MIN_BLOCK_LENGTH` g the correlation is not resolved: the error is a lower bound,
    and the estimate says so; so it does of the plain error of fewer than `MIN_BLOCKS` samples. A
    single sample has none.

    Args:
        series: samples, (n,).
    """
    samples = np.asarray(series, dtype=float)
    if len(samples) == 0:
        return Estimate(None, None, "no samples")
    value = float(samples.mean())
    if np.all(samples == samples[0]):
        samples = np.zeros_like(samples)  # a constant has error 0, not the rounding of its mean
    if len(samples) == 1:
        return Estimate(value, None, "one sample has no error")
    if len(samples) < MIN_BLOCKS:
        error = float(samples.std(ddof=1) / np.sqrt(len(samples)))
        return Estimate(value, error, f"at least: {len(samples)} samples are too few")
    lengths, errors = blocking_curve(samples)
    if errors[0] == 0:
        return Estimate(value, 0.0)
    usable = len(samples) // lengths >= MIN_BLOCKS
    lengths, errors = lengths[usable], errors[usable]
    inefficiency = np.maximum(1.0, (errors / errors[0]) ** 2)
    plateau = lengths.astype(float) ** 3 > 2 * len(samples) * inefficiency**2
    level = int(np.argmax(plateau)) if plateau.any() else len(lengths) - 1
    error = float(errors[level])
    if lengths[level] < MIN_BLOCK_LENGTH * inefficiency[level]:
        return Estimate(value, error, f"at least: {len(samples)} samples are too correlated")
    return Estimate(value, error)


def mean_of_independent(samples: ArrayLike) -> Estimate:
    """Mean of independent samples, as of runs that differ in their seed, with its standard error.

    The error s / sqrt(n) is itself uncertain by 1 / sqrt(2 (n - 1)); below `MIN_BLOCKS` samples the
    estimate says so.

    Args:
        samples: (n,).
    """
    values = np.asarray(samples, dtype=float)
    if len(values) < 2:
        return mean(values)
    error = float(values.std(ddof=1) / np.sqrt(len(values)))
    uncertain = None
    if len(values) < MIN_BLOCKS:
        uncertain = f"error from {len(values)} samples, so uncertain itself"
    return Estimate(float(values.mean()), error, uncertain)


def ratio(numerator: ArrayLike, denominator: ArrayLike) -> Estimate:
    """Ratio of two time means, its error to first order in the fluctuations of both.

    Args:
        numerator, denominator: samples taken at the same times, (n,).
    """
    above, below = (np.asarray(series, dtype=float) for series in (numerator, denominator))
    scale = float(below.mean())
    if scale == 0:
        return Estimate(None, None, "the denominator is zero")
    value = float(above.mean()) / scale
    deviation = mean((above - value * below) / scale)
    return Estimate(value, deviation.error, deviation.reason)


def root(square: Estimate) -> Estimate:
    """Square root of an estimate that is not negative, its error to first order."""
    if square.value is None:
        return square
    value = float(np.sqrt(square.value))
    error = square.error
    if error is not None and value > 0:
        error /= 2 * value
    return Estimate(value, error, square.reason)

"""Stationary series of mean 0 whose correlations are known, for the tests of errors."""

import math

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

Array = NDArray[np.float64]


def autoregressive(time: float, samples: int, random: np.random.Generator) -> Array:
    """AR(1) of variance 1 with correlations exp(-t/time), (samples,); white noise for time 0."""
    factor = math.exp(-1 / time) if time > 0 else 0.0
    noise = random.normal(size=samples) * math.sqrt(1 - factor**2)
    noise[0] /= math.sqrt(1 - factor**2)
    return np.asarray(lfilter([1], [1, -factor], noise))


def two_times(
    fast: float, slow: float, share: float, samples: int, random: np.random.Generator
) -> Array:
    """Sum of two AR(1) of variance 1 - share and share, (samples,)."""
    quick = math.sqrt(1 - share) * autoregressive(fast, samples, random)
    return quick + math.sqrt(share) * autoregressive(slow, samples, random)


def exact_error(time: float, samples: int) -> float:
    """Standard deviation of the mean of n samples of AR(1), in closed form."""
    lags = np.arange(1, samples)
    correlations = (samples - lags) * math.exp(-1 / time) ** lags if time > 0 else 0.0 * lags
    return math.sqrt((samples + 2 * correlations.sum()) / samples**2)

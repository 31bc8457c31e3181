"""Whether velocities are Gaussian: skewness and kurtosis against those of independent samples."""

import math
from dataclasses import dataclass

import numpy as np
from scipy import stats

from analysis.arrays import Array
from analysis.estimate import Estimate

FALSE_ALARMS = 0.01  # of runs whose velocities are Gaussian, all directions together
LEAST = 100  # samples in each direction


@dataclass(frozen=True)
class Normality:
    """Of each direction, (d,).

    Attributes:
        samples: taken as independent, in each direction.
        p_values: of D'Agostino and Pearson's test.
        excess_kurtosis: 0 for a Gaussian.
        kurtosis_error: sqrt(24 / n).
        normal: no p-value is below the false-alarm rate divided by the directions.
    """

    samples: int
    p_values: Array
    excess_kurtosis: Array
    kurtosis_error: float
    normal: bool


def normality(velocities: Array, apart: int) -> Normality:
    """The test on every so-many-th frame, between which velocities have forgotten themselves.

    Each frame's mean is taken off, for drifts.

    Args:
        velocities: (T, N, d).
        apart: frames.

    Raises:
        ValueError: for fewer than 100 samples in a direction.
    """
    chosen = velocities[::apart]
    samples = chosen.shape[0] * chosen.shape[1]
    if samples < LEAST:
        raise ValueError(f"{samples} independent velocities; at least {LEAST} are needed")
    flat = (chosen - chosen.mean(axis=1, keepdims=True)).reshape(samples, -1)
    p_values = np.asarray(stats.normaltest(flat, axis=0).pvalue)
    return Normality(
        samples,
        p_values,
        np.asarray(stats.kurtosis(flat, axis=0)),
        float(np.sqrt(24 / samples)),
        bool(p_values.min() > FALSE_ALARMS / flat.shape[1]),
    )


def normal_probability(skewness: Estimate, excess_kurtosis: Estimate) -> float:
    """How probable a skewness and a kurtosis as large are of a Gaussian: chi^2 of both.

    Raises:
        ValueError: when one of them has no error.
    """
    deviates = skewness.deviation(0.0), excess_kurtosis.deviation(0.0)
    return math.exp(-0.5 * (deviates[0] ** 2 + deviates[1] ** 2))

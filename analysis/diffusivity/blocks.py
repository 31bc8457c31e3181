"""Errors from blocks of time: the delete-one jackknife."""

from collections.abc import Callable

import numpy as np
from scipy.stats import t as student

from analysis.arrays import Array


def jackknife(statistic: Callable[..., Array], *sums: Array) -> tuple[Array, Array]:
    """A function of sums over blocks, and its standard error.

    Args:
        statistic: of the sums over all blocks, which it gets one by one.
        sums: each (blocks, ...).
    """
    count = len(sums[0])
    totals = [each.sum(axis=0) for each in sums]
    value = statistic(*totals)
    without = np.array(
        [
            statistic(*(total - each[n] for total, each in zip(totals, sums, strict=True)))
            for n in range(count)
        ]
    )
    error = np.sqrt((count - 1) / count * ((without - without.mean(axis=0)) ** 2).sum(axis=0))
    return value, error


def quantile_95(blocks: int) -> float:
    """Errors that make a 95 % interval: Student's t of blocks - 1 degrees of freedom."""
    return float(student.ppf(0.975, blocks - 1))

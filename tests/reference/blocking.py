"""Error bars of correlated series by blocking."""

import numpy as np
from numpy.typing import NDArray


def mean_and_error(series: NDArray[np.float64], blocks: int = 20) -> tuple[float, float]:
    """Mean, and its standard error from the scatter of the means of so many blocks."""
    length = len(series) // blocks
    means = series[: length * blocks].reshape(blocks, length).mean(axis=1)
    return float(means.mean()), float(means.std(ddof=1) / np.sqrt(blocks))

"""g(r) of spheres in a periodic box, and its peaks."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.signal import find_peaks

from analysis.arrays import Array
from analysis.periodic import close_pairs

PROMINENCE = 5  # standard errors by which a peak stands out


@dataclass(frozen=True)
class RadialDistribution:
    """g(r): 1 where pairs are as frequent as for independent particles.

    Attributes:
        distance: middle of the bins, (bins,) [a0].
        g, error: (bins,); the error is from the scatter of the frames, as if independent.
        peaks: distances of the maxima that stand out, the innermost first [a0].
        frames: g of each frame, (T, bins).
    """

    distance: Array
    g: Array
    error: Array
    peaks: Array
    frames: Array


def radial_distribution(
    positions: Array, lengths: ArrayLike, bin_width: float, largest: float
) -> RadialDistribution:
    """g(r) of all frames up to a distance.

    Args:
        positions: (T, N, 3), wrapped or not; N at least 2.
        lengths: of the periodic box, (3,).
        bin_width: [a0].
        largest: distance, at most half the box [a0].
    """
    frames, count, _ = positions.shape
    edges = np.arange(0.0, largest + 0.5 * bin_width, bin_width)
    histograms = np.empty((frames, len(edges) - 1))
    for number, frame in enumerate(positions):
        separation, _ = close_pairs(frame, lengths, edges[-1])
        histograms[number] = np.histogram(np.sqrt((separation**2).sum(axis=1)), edges)[0]
    shells = 4 / 3 * math.pi * np.diff(edges**3)
    volume = float(np.prod(np.asarray(lengths, dtype=float)))
    ideal = 0.5 * count * (count - 1) * shells / volume
    each = histograms / ideal
    g = each.mean(axis=0)
    error = each.std(axis=0, ddof=1) / math.sqrt(frames) if frames > 1 else np.sqrt(g / ideal)
    noise = np.maximum(error, np.sqrt(1 / (frames * ideal)))
    candidates, found = find_peaks(g, prominence=1e-9)
    stand_out = found["prominences"] > PROMINENCE * noise[candidates]
    middle = 0.5 * (edges[1:] + edges[:-1])
    return RadialDistribution(middle, g, error, middle[candidates[stand_out]], each)

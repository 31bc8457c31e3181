"""Signs that a finished run went wrong although nothing stopped it."""

import numpy as np
from scipy.spatial import KDTree

from analysis.arrays import Array
from analysis.estimate import Estimate
from run_files.manifest import Box

SIGNIFICANT = 3  # standard errors beyond the limit
OVERLAP = 0.95  # of the diameter: 34 kBT of the 48-24 repulsion, out of thermal reach


def temperature_warnings(what: str, temperature: Estimate, limit: float) -> tuple[str, ...]:
    """A temperature that is off kBT = 1 by more than the limit and three of its errors."""
    if temperature.value is None:
        return ()
    off = abs(temperature.value - 1) - SIGNIFICANT * (temperature.error or 0.0)
    if off <= limit:
        return ()
    return (
        f"the temperature of the {what} is {temperature.value:.4g} +- "
        f"{temperature.error or 0:.2g}, off 1 by more than {limit:.0%}",
    )


def closest_approach(positions: Array, box: Box, within: float) -> float:
    """Smallest distance of two particles in all frames, infinite if none comes within reach [a0].

    Args:
        positions: unwrapped, (T, N, d) [a0].
        box: periodic or not along each axis.
        within: reach of the search [a0].
    """
    frames, count, dimensions = positions.shape
    edges = np.where(box.periodic, box.sizes, 0.0)  # 0: no images
    wrapped = np.where(edges > 0, np.mod(positions, np.where(edges > 0, edges, 1.0)), positions)
    wrapped[wrapped == edges] = 0.0  # a negative rounding error was rounded up to the edge
    # frames side by side along an axis of their own, out of each other's reach
    places = np.empty((frames, count, dimensions + 1))
    places[:, :, 0] = 2 * within * np.arange(frames)[:, np.newaxis]
    places[:, :, 1:] = wrapped
    points = places.reshape(-1, dimensions + 1)
    pairs = KDTree(points, boxsize=np.append(0.0, edges)).query_pairs(within, output_type="ndarray")
    if not len(pairs):
        return np.inf
    apart = (points[pairs[:, 0]] - points[pairs[:, 1]])[:, 1:]
    apart -= edges * np.round(np.divide(apart, edges, out=np.zeros_like(apart), where=edges > 0))
    return float(np.sqrt((apart**2).sum(axis=1)).min())


def overlap_warnings(positions: Array, box: Box, diameter: float) -> tuple[str, ...]:
    """Colloids nearer to each other than their repulsion lets them come at kBT = 1."""
    closest = closest_approach(positions, box, OVERLAP * diameter)
    if not closest < OVERLAP * diameter:
        return ()
    return (
        f"two colloids came within {closest:.4g} of each other, less than {OVERLAP:g} of "
        f"their diameter {diameter:g}: they overlap",
    )

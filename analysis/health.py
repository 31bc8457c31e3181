"""Signs that a finished run went wrong although nothing stopped it."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from analysis.blocking import Estimate

Array = NDArray[np.float64]

FLUID_TEMPERATURE = 0.01  # off kBT by more is told; fix srd rescales to 0.993
COLLOID_TEMPERATURE = 0.05
SIGNIFICANT = 3  # standard errors beyond the limit
OVERLAP = 0.95  # of the diameter: 34 kBT of the 48-24 repulsion, out of thermal reach
NEIGHBOURS = 3  # along x that may touch a colloid in a narrow channel


def temperature_warnings(fluid: Estimate, colloids: Estimate | None) -> Iterator[str]:
    """A temperature that is not kBT = 1 beyond its error: time step, thermostat or field."""
    for name, estimate, limit in (
        ("the fluid", fluid, FLUID_TEMPERATURE),
        ("the colloids", colloids, COLLOID_TEMPERATURE),
    ):
        if estimate is None or estimate.value is None:
            continue
        off = abs(estimate.value - 1) - SIGNIFICANT * (estimate.error or 0.0)
        if not off <= limit:
            yield (
                f"the temperature of {name} is {estimate.value:.4g} +- {estimate.error or 0:.2g}, "
                f"off 1 by more than {limit:.0%}"
            )


def closest_approach(positions: Array, length: float) -> float:
    """Smallest distance of two colloids in all frames [a0].

    Args:
        positions: (T, N, 2), N at least 2; x may be unwrapped [a0].
        length: of the periodic x axis [a0].
    """
    wrapped = positions.copy()
    wrapped[:, :, 0] %= length
    order = np.argsort(wrapped[:, :, 0], axis=1)
    wrapped = np.take_along_axis(wrapped, order[:, :, np.newaxis], axis=1)
    closest = np.inf
    for n in range(1, min(NEIGHBOURS, positions.shape[1] - 1) + 1):
        apart = np.roll(wrapped, -n, axis=1) - wrapped
        apart[:, :, 0] -= length * np.round(apart[:, :, 0] / length)
        closest = min(closest, float(np.hypot(apart[:, :, 0], apart[:, :, 1]).min()))
    return closest


def overlap_warnings(positions: Array, length: float, diameter: float) -> Iterator[str]:
    """Colloids nearer to each other than their repulsion lets them come at kBT = 1."""
    if positions.shape[1] < 2:
        return
    closest = closest_approach(positions, length)
    if not closest >= OVERLAP * diameter:
        yield (
            f"two colloids came within {closest:.4g} of each other, less than {OVERLAP:g} of "
            f"their diameter {diameter:g}: they overlap"
        )

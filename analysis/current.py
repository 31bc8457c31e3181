"""Currents of driven mixtures, flow profiles by colour, viscosity of a shear flow."""

import numpy as np
from numpy.typing import ArrayLike

from analysis.arrays import Array
from analysis.correlated_mean import mean
from analysis.estimate import Estimate


def current(velocities: Array, signs: ArrayLike) -> Array:
    """Mean of the colour times v_x: how fast the two colours pass each other, halved.

    Args:
        velocities: along the field, (T, N).
        signs: with which each particle couples to the field, +1 or -1, (N,).

    Returns:
        (T,).
    """
    return np.asarray((velocities * np.asarray(signs)).mean(axis=1))


def displacement_current(positions: Array, signs: ArrayLike, times: ArrayLike) -> Array:
    """The current over each interval, by how far particles have come: kicks between do not matter.

    Args:
        positions: along the field, not wrapped, (T, N).
        signs: as of `current`, (N,).
        times: (T,).

    Returns:
        (T - 1,).
    """
    separation = (positions * np.asarray(signs)).mean(axis=1)
    return np.asarray(np.diff(separation) / np.diff(np.asarray(times)))


def mobility(current_series: ArrayLike, field: float) -> Estimate:
    """Mean current over the force on each particle.

    Args:
        current_series: (T,).
        field: the force, not zero.

    Raises:
        ValueError: at zero field.
    """
    if field == 0:
        raise ValueError("field 0: the mobility needs a field")
    return mean(current_series).scaled(1 / field)


def flow_profiles(
    heights: Array, velocities: Array, colours: ArrayLike, width: float, bins: int
) -> tuple[Array, Array, Array]:
    """Particles and their mean velocity in layers across the field, by colour.

    Args:
        heights: position across the field, (T, N), wrapped or not.
        velocities: along the field, (T, N).
        colours: (N,).
        width: of the periodic box across the field.
        bins: layers.

    Returns:
        centres of the layers, (bins,); mean number of particles, (colours, bins); their mean
        velocity, (colours, bins), NaN in a layer that no particle of the colour was in. Colours
        are sorted.
    """
    colours = np.asarray(colours)
    layer = np.minimum((heights % width) / width * bins, bins - 1).astype(np.intp)
    counts, speeds = [], []
    for kind in np.unique(colours):
        own = np.broadcast_to(colours == kind, layer.shape)
        count = np.bincount(layer[own], minlength=bins)
        momentum = np.bincount(layer[own], velocities[own], bins)
        counts.append(count / len(heights))
        speeds.append(np.where(count > 0, momentum / np.maximum(count, 1), np.nan))
    return (np.arange(bins) + 0.5) * width / bins, np.array(counts), np.array(speeds)


def viscosity(pressure_xy: ArrayLike, rate: float) -> Estimate:
    """-<P_xy> over the shear rate.

    Args:
        pressure_xy: component xy of the pressure tensor, velocities relative to the flow, (T,).
        rate: dv_x/dy, not zero.

    Raises:
        ValueError: at zero rate.
    """
    if rate == 0:
        raise ValueError("rate 0: the viscosity needs a flow")
    return mean(pressure_xy).scaled(-1 / rate)

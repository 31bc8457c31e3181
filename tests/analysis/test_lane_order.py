from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from analysis.lane_order import (
    REACH,
    colour_structure,
    lane_order,
    lane_order_near,
    lane_order_printed,
)

Array = NDArray[np.float64]

COLOURS = np.arange(200) % 2


def brute_force(
    positions: Array,
    colours: NDArray[Any],
    lengths: list[float],
    axes: list[int],
    reach: float = np.inf,
) -> Array:
    """Every pair of every frame, delhommelle-2005, II."""
    frames, particles, dimension = positions.shape
    spacing = (particles / np.prod(lengths)) ** (-1 / dimension)
    alone = np.zeros(frames)
    for t in range(frames):
        for i in range(particles):
            distances = [np.inf]
            for j in range(particles):
                if colours[i] != colours[j]:
                    d = positions[t, i] - positions[t, j]
                    d -= lengths * np.round(d / lengths)
                    if np.sqrt((d**2).sum()) <= reach:
                        distances.append(np.sqrt((d[axes] ** 2).sum()))
            alone[t] += min(distances) > spacing
    return np.asarray(alone / particles)


@pytest.mark.parametrize("lengths", [[9.0, 14.0], [4.0, 6.0, 9.0]])
def test_brute_force(lengths: list[float]) -> None:
    random = np.random.default_rng(0)
    positions = random.uniform(-10, 20, (3, 60, len(lengths)))
    colours = np.arange(60) < 4  # few of one colour, so that phi is neither 0 nor 1
    across = list(range(1, len(lengths)))
    expected = brute_force(positions, colours, lengths, across)
    assert lane_order(positions, colours, lengths).tolist() == expected.tolist()
    assert 0 < expected.mean() < 1
    along = brute_force(positions, colours, lengths, [0])
    assert lane_order_printed(positions, colours, lengths).tolist() == along.tolist()
    near = brute_force(positions, colours, lengths, across, REACH[len(lengths)])
    assert lane_order_near(positions, colours, lengths) == pytest.approx(near, rel=1e-12)
    assert near.mean() > expected.mean()


def stripes(axis: int, dimension: int = 2) -> tuple[Array, Array]:
    """200 particles at random, the colours in two halves of the box along an axis with gaps."""
    random = np.random.default_rng(1)
    lengths = np.full(dimension, 200 ** (1 / dimension))
    positions = random.uniform(0, 1, (4, 200, dimension))
    positions[:, :, axis] = 0.1 + 0.3 * positions[:, :, axis] + 0.5 * COLOURS
    return positions * lengths, lengths


@pytest.mark.parametrize("dimension", [2, 3])
def test_lanes_along_the_field_and_the_erratum(dimension: int) -> None:
    """Two lanes along x: the lateral distance sees them, the printed one, along x, does not."""
    positions, lengths = stripes(1, dimension)
    assert lane_order(positions, COLOURS, lengths).tolist() == [1] * 4
    assert lane_order_near(positions, COLOURS, lengths).tolist() == [1] * 4
    assert lane_order_printed(positions, COLOURS, lengths).max() < 0.02
    bands, _ = stripes(0, dimension)
    assert lane_order_printed(bands, COLOURS, lengths).tolist() == [1] * 4
    assert lane_order(bands, COLOURS, lengths).max() < 0.1


@pytest.mark.parametrize("bands", [2, 6])
def test_colour_structure_of_bands(bands: int) -> None:
    """Uniform bands of one colour each: the amplitude of a square wave, 2/pi, times N."""
    y = (np.arange(6000) + 0.5) / 6000
    colours = (y * bands).astype(int) % 2
    x = np.random.default_rng(3).uniform(0, 9, 6000)
    positions = np.stack([x, 7.0 * y], axis=1)[None]
    structure = colour_structure(positions, colours, [9.0, 7.0])
    assert structure == pytest.approx([6000 * (2 / np.pi) ** 2], rel=1e-3)


def test_colour_structure_of_random_colours() -> None:
    """Squares of each of 4 waves are exponential, of mean 1: the largest has the mean 25/12."""
    random = np.random.default_rng(4)
    positions = random.uniform(0, 30, (4000, 100, 2))
    structure = colour_structure(positions, np.arange(100) % 2, [30.0, 30.0])
    error = structure.std() / np.sqrt(len(structure))
    assert abs(structure.mean() - 25 / 12) < 4 * error


def test_a_well_mixed_gas() -> None:
    """None of 448 particles of the other colour within a spacing: (1 - 2/sqrt(896))^448."""
    random = np.random.default_rng(2)
    lengths = np.sqrt([896.0, 896.0])
    positions = random.uniform(0, lengths, (20, 896, 2))
    order = lane_order(positions, np.arange(896) % 2, lengths)
    assert order.mean() < 1e-3


def test_a_well_mixed_gas_among_neighbours() -> None:
    """None of 448 in the part |y| < 1 of a circle of radius 1.5."""
    random = np.random.default_rng(5)
    lengths = np.sqrt([896.0, 896.0])
    positions = random.uniform(0, lengths, (60, 896, 2))
    order = lane_order_near(positions, np.arange(896) % 2, lengths)
    area = 2 * (np.sqrt(1.5**2 - 1) + 1.5**2 * np.arcsin(1 / 1.5))
    error = order.std(ddof=1) / np.sqrt(len(order))
    assert abs(order.mean() - (1 - area / 896) ** 448) < 4 * error
    assert error < 0.002


def test_the_distance_is_periodic() -> None:
    # one pair, 9.5 apart across a box of 10, spacing sqrt(50): 0.5 through the boundary
    positions = np.array([[[0.0, 0.2], [5.0, 9.7]]])
    assert lane_order(positions, [1, -1], [10.0, 10.0]).tolist() == [0]
    assert lane_order_printed(positions, [1, -1], [10.0, 10.0]).tolist() == [0]


def test_one_colour_is_refused() -> None:
    with pytest.raises(ValueError, match="1 colours: lanes need two"):
        lane_order(np.zeros((1, 2, 2)), [1, 1], [10.0, 10.0])

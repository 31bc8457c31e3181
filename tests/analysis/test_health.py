"""The checks of a finished run, on the smallest cases that can fail them."""

import numpy as np
import pytest

from analysis.estimate import Estimate
from analysis.health import closest_approach, overlap_warnings, temperature_warnings
from analysis.measures import colloid_temperature, fluid_temperature
from run_files.manifest import Box

SLIT = Box(sizes=(40.0, 10.0), periodic=(True, False))
FLUID, COLLOIDS = fluid_temperature.TOLERANCE, colloid_temperature.TOLERANCE


@pytest.mark.parametrize(
    ("temperature", "limit", "told"),
    [
        (Estimate(1.0, 0.01), FLUID, False),
        (Estimate(0.993, 0.0001), FLUID, False),
        (Estimate(1.02, 0.004), FLUID, False),  # may be chance
        (Estimate(1.02, 0.003), FLUID, True),
        (Estimate(0.9, 0.001), FLUID, True),
        (Estimate(1.04, 0.001), COLLOIDS, False),
        (Estimate(1.2, 0.04), COLLOIDS, True),
        (Estimate(float("nan"), None), COLLOIDS, True),
        (Estimate(None, None, "no samples"), COLLOIDS, False),
    ],
)
def test_temperatures(temperature: Estimate, limit: float, told: bool) -> None:
    warnings = temperature_warnings("stars", temperature, limit)
    named = ["the temperature of the stars"] if told else []
    assert [text.split(" is ")[0] for text in warnings] == named


def test_closest_approach_across_the_periodic_end_and_over_a_neighbour() -> None:
    """0.5 and 39.5 are 1 apart in a box of 40; 10 and 10.2 have 10.1, far in y, between them."""
    positions = np.array([[[0.5, 5.0], [39.5, 5.0], [20.0, 5.0]]])
    assert closest_approach(positions, SLIT, within=4.0) == pytest.approx(1.0)
    zigzag = np.array([[[10.0, 2.0], [50.1, 9.0], [10.2, 2.0], [25.0, 5.0]]])
    assert closest_approach(zigzag, SLIT, within=4.0) == pytest.approx(0.2)


def test_walls_have_no_images() -> None:
    positions = np.array([[[5.0, 0.2], [5.0, 9.8]]])
    assert closest_approach(positions, SLIT, within=4.0) == np.inf
    periodic = Box(sizes=(40.0, 10.0), periodic=(True, True))
    assert closest_approach(positions, periodic, within=4.0) == pytest.approx(0.4)


@pytest.mark.parametrize(
    "box",
    [
        SLIT,
        Box(sizes=(40.0, 10.0, 12.0), periodic=(True, True, True)),
        Box(sizes=(40.0, 10.0, 12.0), periodic=(True, False, True)),
    ],
    ids=str,
)
def test_closest_approach_is_that_of_all_pairs(box: Box) -> None:
    """In several frames at once, of unwrapped positions: the least over the double loop."""
    random = np.random.default_rng(3)
    sizes, periodic = np.array(box.sizes), np.array(box.periodic)
    for _ in range(20):
        positions = random.random((3, 6, len(sizes))) * sizes
        positions += np.where(periodic, 60 * random.random(len(sizes)) - 10, 0.0)
        apart = positions[:, :, None] - positions[:, None]
        apart -= np.where(periodic, sizes * np.round(apart / sizes), 0.0)
        distance = np.linalg.norm(apart, axis=-1) + 1e9 * np.eye(6)
        assert closest_approach(positions, box, within=4.9) == pytest.approx(
            distance.min() if distance.min() <= 4.9 else np.inf
        )


def test_overlap_is_told_beyond_thermal_reach() -> None:
    touching = np.array([[[10.0, 5.0], [13.9, 5.0]]])
    assert not overlap_warnings(touching, SLIT, 4.0)
    assert not overlap_warnings(touching[:, :1], SLIT, 4.0)
    (told,) = overlap_warnings(touching * [1, 1] - [[[0, 0], [0.2, 0]]], SLIT, 4.0)
    assert told.startswith("two colloids came within 3.7 of each other")

"""The checks of a finished run, on the smallest cases that can fail them."""

import numpy as np
import pytest

from analysis.blocking import Estimate
from analysis.health import closest_approach, overlap_warnings, temperature_warnings

HEALTHY = Estimate(1.0, 0.01)


@pytest.mark.parametrize(
    ("fluid", "colloids", "named"),
    [
        (HEALTHY, HEALTHY, []),
        (HEALTHY, None, []),
        (Estimate(0.993, 0.0001), None, []),
        (Estimate(1.02, 0.004), None, []),  # may be chance
        (Estimate(1.02, 0.003), None, ["the fluid"]),
        (Estimate(0.9, 0.001), Estimate(1.2, 0.04), ["the fluid", "the colloids"]),
        (Estimate(1.0, 0.001), Estimate(float("nan"), None), ["the colloids"]),
    ],
)
def test_temperatures(fluid: Estimate, colloids: Estimate | None, named: list[str]) -> None:
    found = list(temperature_warnings(fluid, colloids))
    assert [text.split(" is ")[0] for text in found] == [f"the temperature of {n}" for n in named]


def test_closest_approach_across_the_periodic_end_and_over_a_neighbour() -> None:
    """0.5 and 39.5 are 1 apart in a box of 40; 10 and 10.2 have 10.1, far in y, between them."""
    positions = np.array([[[0.5, 5.0], [39.5, 5.0], [20.0, 5.0]]])
    assert closest_approach(positions, 40.0) == pytest.approx(1.0)
    zigzag = np.array([[[10.0, 2.0], [50.1, 9.0], [10.2, 2.0], [25.0, 5.0]]])
    assert closest_approach(zigzag, 40.0) == pytest.approx(0.2)


def test_closest_approach_is_that_of_all_pairs() -> None:
    random = np.random.default_rng(3)
    for _ in range(20):
        x = random.random((1, 6)) * 60 - 10
        positions = np.stack([x, np.full_like(x, 5.0)], axis=-1)
        apart = x[0][:, None] - x[0]
        apart = np.abs(apart - 40 * np.round(apart / 40)) + 1e9 * np.eye(6)
        assert closest_approach(positions, 40.0) == pytest.approx(apart.min())


def test_overlap_is_told_beyond_thermal_reach() -> None:
    touching = np.array([[[10.0, 5.0], [13.9, 5.0]]])
    assert not list(overlap_warnings(touching, 40.0, 4.0))
    assert not list(overlap_warnings(touching[:, :1], 40.0, 4.0))
    (told,) = overlap_warnings(touching * [1, 1] - [[[0, 0], [0.2, 0]]], 40.0, 4.0)
    assert told.startswith("two colloids came within 3.7 of each other")

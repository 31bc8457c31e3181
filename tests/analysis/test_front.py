"""Density of a chain in bins, and fronts of known place and width."""

import numpy as np
import pytest
from scipy.special import ndtr

from analysis.front import coarse_density, fit_front, places


def test_even_chain_has_an_even_density_in_bins_of_any_size() -> None:
    chain = 2.5 + 5.0 * np.arange(300.0)
    for size in (3.0, 10.0, 20.0):
        inside = coarse_density(chain, np.arange(100, 1400, size), width=10)
        assert inside == pytest.approx(0.02)


def test_density_by_hand_and_number_is_kept() -> None:
    # centres 1, 3, 7: shares 0-2, 2-5, 5-9
    x = np.array([7.0, 1.0, 3.0])
    assert coarse_density(x, [0, 2, 5, 9], width=1) == pytest.approx([1 / 2, 1 / 3, 1 / 4])
    assert coarse_density(x, [-5, 0, 1, 20], width=10) * 10 * [5, 1, 19] == pytest.approx(
        [0, 0.5, 2.5]
    )


def test_places_are_the_inverse() -> None:
    x = np.sort(np.random.default_rng(1).uniform(0, 400, 50))
    edges = np.arange(-40.0, 440.1, 0.25)
    middles = (x[1:] + x[:-1]) / 2  # ends of the shares
    density = coarse_density(x, edges, width=10)
    assert places(density, edges, 10, [float(n) for n in range(1, 50)]) == pytest.approx(
        middles, abs=0.26
    )


@pytest.mark.parametrize("side", [1, -1])
def test_fit_finds_a_front_under_noise(side: int) -> None:
    x = np.arange(0, 400, 10.0) + 5
    rng = np.random.default_rng(2)
    density = 0.02 * ndtr(side * (x - 180) / 35) + rng.normal(0, 2e-4, len(x))
    front = fit_front(x, density, side)
    assert front.position == pytest.approx(180, abs=2)
    assert front.width == pytest.approx(35, abs=2)
    assert front.level == pytest.approx(0.02, rel=0.02)


def test_a_sharp_end_is_no_wider_than_a_bin() -> None:
    chain = 2.5 + 5.0 * np.arange(300.0)
    edges = np.arange(1300, 1600.1, 10)
    front = fit_front((edges[1:] + edges[:-1]) / 2, coarse_density(chain, edges, 10), side=-1)
    assert front.position == pytest.approx(1500, abs=5)
    assert front.width < 5

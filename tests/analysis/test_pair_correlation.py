import numpy as np
import pytest
from scipy import stats

from analysis.pair_correlation import pair_correlation

LENGTH = 40.0


def test_two_points_across_the_boundary() -> None:
    # 39 and 1 are 2 apart: both ordered pairs in the bin (2 +- 0.5), 20 bins, 2 pairs in all
    distance, g = pair_correlation(np.array([[39.0, 1.0]]), LENGTH, 1.0)
    assert distance[:3].tolist() == [0.5, 1.5, 2.5]
    assert g.tolist() == [0.0, 0.0, 20.0] + [0.0] * 17


def test_unwrapped_positions_give_the_same() -> None:
    x = np.random.default_rng(0).uniform(0, LENGTH, (5, 4))
    far = x + LENGTH * np.array([0, 3, -2, 100])
    assert pair_correlation(far, LENGTH, 1.0)[1] == pytest.approx(
        pair_correlation(x, LENGTH, 1.0)[1]
    )


def test_ideal_gas_is_one_everywhere() -> None:
    frames, points = 4000, 5
    x = np.random.default_rng(1).uniform(0, LENGTH, (frames, points))
    _, g = pair_correlation(x, LENGTH, 1.0)
    # independent pairs: Poisson counts; 20 bins, false-alarm rate 1e-4 in all (4.6 deviations)
    assert np.abs(g - 1).max() < 4.6 / np.sqrt(frames * points * (points - 1) / 2 / 20)
    assert g.mean() == pytest.approx(1, rel=1e-12)  # every pair is counted once


def test_hard_rods_on_a_ring_have_the_exact_correlation() -> None:
    """Tonks gas: the k-th neighbour is at k sigma + (L - N sigma) Beta(k, N - k)."""
    random = np.random.default_rng(2)
    frames, rods, sigma = 20_000, 5, 4.0
    free = LENGTH - rods * sigma
    gaps = sigma + free * random.dirichlet(np.ones(rods), frames)
    x = np.cumsum(gaps, axis=1) + random.uniform(0, LENGTH, (frames, 1))
    bins = 40
    _, g = pair_correlation(x, LENGTH, LENGTH / 2 / bins)
    edges = np.linspace(0, LENGTH / 2, bins + 1)
    exact = np.zeros(bins)
    for k in range(1, rods):
        neighbour = stats.beta(k, rods - k, loc=k * sigma, scale=free)
        exact += np.diff(neighbour.cdf(edges)) - np.diff(neighbour.cdf(LENGTH - edges))
    exact *= bins / (rods - 1)
    assert exact[:8] == pytest.approx(np.zeros(8))  # no two rods closer than 4
    # counts of ordered pairs are twice those of pairs; pairs of one frame correlate at most fully,
    # two by two: 2 x Poisson; 40 bins, false-alarm rate 1e-4 (4.7 deviations)
    pairs = exact * frames * rods * (rods - 1) / 2 / bins
    assert np.all(np.abs(g - exact) <= 4.7 * 2 * np.sqrt(pairs) / pairs.max() * exact.max())


def test_single_point() -> None:
    with pytest.raises(ValueError, match="at least 2 points"):
        pair_correlation(np.zeros((3, 1)), LENGTH, 1.0)

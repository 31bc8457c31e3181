import numpy as np
import pytest

from analysis.density_fluctuations import cluster_sizes, number_variance, structure_factor


def test_the_structure_factor_of_a_lattice() -> None:
    """N at the wave vectors of the lattice, 0 at others."""
    i, j = np.meshgrid(np.arange(4), np.arange(3), indexing="ij")
    positions = np.stack([i, j], -1).reshape(1, -1, 2).astype(float)
    waves, s = structure_factor(positions, [4.0, 3.0], 4)
    assert len(waves) == (9 * 9 - 1) / 2
    numbers = np.round(waves * [4, 3] / (2 * np.pi)).astype(int)
    bragg = (numbers % [4, 3] == 0).all(axis=1)
    assert s[bragg] == pytest.approx(12)
    assert s[~bragg] == pytest.approx(0, abs=1e-12)


def test_the_structure_factor_by_brute_force() -> None:
    random = np.random.default_rng(0)
    positions = random.uniform(0, [5, 6, 7], (2, 20, 3))
    waves, s = structure_factor(positions, [5.0, 6.0, 7.0], 1)
    for k, value in zip(waves, s, strict=True):
        total = sum(
            np.cos(k @ (frame[a] - frame[b]))
            for frame in positions
            for a in range(20)
            for b in range(20)
        )
        assert value == pytest.approx(total / 2 / 20)


def test_uncorrelated_particles() -> None:
    random = np.random.default_rng(1)
    positions = random.uniform(0, 10, (2000, 50, 2))
    _, s = structure_factor(positions, [10.0, 10.0], 2)
    assert s == pytest.approx(1, abs=5 / np.sqrt(2000))  # |.|^2 is exponential
    assert number_variance(positions, [10.0, 10.0], 4) == pytest.approx(1 - 1 / 16, rel=0.03)


def test_the_number_variance_by_hand() -> None:
    corners = np.array([[[0.5, 0.5], [1.5, 0.5], [0.5, 1.5], [-0.5, 1.5]]])
    assert number_variance(corners, [2.0, 2.0], 2) == 0
    assert number_variance(0 * corners, [2.0, 2.0], 2) == 3  # 4, 0, 0, 0: variance 3, mean 1


def test_clusters_by_hand_and_by_brute_force() -> None:
    chain = np.array([[0.1, 0], [9.5, 0], [1.2, 0], [5, 5], [5, 5.9]])
    assert cluster_sizes(chain, [10.0, 10.0], 1.2).tolist() == [3, 2]
    random = np.random.default_rng(2)
    positions = random.uniform(0, 10, (60, 2))
    separation = positions[:, None] - positions
    separation -= 10 * np.round(separation / 10)
    near = np.sqrt((separation**2).sum(axis=2)) <= 1.1
    label = np.arange(60)
    for _ in range(60):
        label = np.array([label[row].min() for row in near])
    expected = sorted(np.unique(label, return_counts=True)[1], reverse=True)
    assert cluster_sizes(positions, [10.0, 10.0], 1.1).tolist() == expected

import numpy as np
import pytest
from scipy.spatial import Delaunay

from analysis.bond_order import bond_order, local_bond_order


def triangular(columns: int, rows: int) -> tuple[np.ndarray, np.ndarray]:
    """A perfect triangular lattice of spacing 1 and its box."""
    i, j = np.meshgrid(np.arange(columns), np.arange(rows), indexing="ij")
    positions = np.stack([i + 0.5 * (j % 2), j * np.sqrt(3) / 2], -1).reshape(-1, 2)
    return positions, np.array([columns, rows * np.sqrt(3) / 2])


def test_a_perfect_crystal() -> None:
    random = np.random.default_rng(0)
    positions, lengths = triangular(10, 12)
    # shaken by 1e-6: not degenerate
    frames = np.array([positions + random.normal(0, 1e-6, positions.shape) - 40.0])
    order = bond_order(frames, lengths)
    assert order.mean == pytest.approx([1], abs=1e-4)
    assert order.mean_modulus == pytest.approx([1], abs=1e-4)


def test_a_compressed_triangular_lattice_by_hand() -> None:
    """Two bonds along x, four at +- atan(2 h)."""
    i, j = np.meshgrid(np.arange(8), np.arange(8), indexing="ij")
    shift = 0.5 * (j % 2)
    height = 0.7
    positions = np.stack([i + shift, j * height], -1).reshape(-1, 2).astype(float)
    theta = np.arctan2(height, 0.5)
    expected = (2 + 4 * np.cos(6 * theta)) / 6
    local = local_bond_order(positions, [8.0, 8 * height])
    assert local == pytest.approx(np.full(64, expected), abs=1e-4)


def test_brute_force_by_a_triangulation_of_all_images() -> None:
    random = np.random.default_rng(1)
    count, lengths = 60, np.array([9.0, 7.0])
    positions = random.uniform(0, lengths, (count, 2))
    shifts = np.array([[a, b] for a in (0, -1, 1) for b in (0, -1, 1)]) * lengths
    images = (positions[None] + shifts[:, None]).reshape(-1, 2)  # the first are the particles
    start, neighbours = Delaunay(images).vertex_neighbor_vertices
    expected = np.empty(count, dtype=complex)
    for k in range(count):
        bonds = images[neighbours[start[k] : start[k + 1]]] - images[k]
        expected[k] = np.exp(6j * np.arctan2(bonds[:, 1], bonds[:, 0])).mean()
    assert local_bond_order(positions, lengths) == pytest.approx(expected, abs=1e-4)


def test_two_crystals_turned_by_30_degrees_cancel_in_the_mean_only() -> None:
    local = np.array([1.0, -1.0])  # exp(6 i 30 degrees) = -1
    assert abs(local.mean()) == 0
    assert np.abs(local).mean() == 1
    random = np.random.default_rng(2)
    gas = random.uniform(0, 30, (10, 900, 2))
    order = bond_order(gas, [30.0, 30.0])
    assert order.mean.mean() < 3 / np.sqrt(900)
    assert 0.3 < order.mean_modulus.mean() < 0.45

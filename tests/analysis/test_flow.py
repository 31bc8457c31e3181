import math

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import quad

from analysis import correlated_mean, flow
from tests.analysis.known import known
from tests.analysis.run_writer import half_cells

Array = NDArray[np.float64]

WIDTH = 10.0


def slit_velocity(y: float, v_max: float, v_wall: float) -> float:
    return v_wall + (v_max - v_wall) * 4 * y * (WIDTH - y) / WIDTH**2


def bin_means(y: Array, v_max: float, v_wall: float) -> Array:
    return np.array(
        [quad(slit_velocity, c - 0.25, c + 0.25, args=(v_max, v_wall))[0] / 0.5 for c in y]
    )


def test_fit_is_exact_for_bin_averages_of_a_parabola() -> None:
    y = half_cells(WIDTH)
    velocity = np.tile(bin_means(y, 0.3, 0.02), (3, 1))
    v_max, v_wall = flow.fit_parabola(y, WIDTH, np.full_like(velocity, 50.0), velocity)
    assert v_max == pytest.approx(np.full(3, 0.3), rel=1e-12)
    assert v_wall == pytest.approx(np.full(3, 0.02), rel=1e-12)


def test_last_bin_is_cut_by_the_wall() -> None:
    width = 10.2  # the last half-cell bin holds fluid from 10.0 to 10.2 only
    low, high = 10.0, 10.2
    mean = quad(lambda y: 4 * y * (width - y) / width**2, low, high)[0] / (high - low)
    assert flow.parabola(half_cells(10.4), width)[-1] == pytest.approx(mean, rel=1e-12)


def test_bin_outside_the_walls_is_not_fitted() -> None:
    y = half_cells(WIDTH + 1)
    velocity = np.full((2, len(y)), 9.0)
    velocity[:, :-2] = bin_means(half_cells(WIDTH), 0.3, 0.0)
    v_max, _ = flow.fit_parabola(y, WIDTH, np.full_like(velocity, 50.0), velocity)
    assert v_max == pytest.approx([0.3, 0.3])


def test_empty_intervals_carry_no_weight() -> None:
    y = half_cells(WIDTH)
    velocity = np.tile(bin_means(y, 0.3, 0.0), (4, 1))
    counts = np.full_like(velocity, 50.0)
    velocity[1, 3] = counts[1, 3] = 0.0  # LAMMPS writes 0 for a bin without particles
    v_max, v_wall = flow.fit_parabola(y, WIDTH, counts, velocity)
    assert v_max.mean() == pytest.approx(0.3, rel=1e-12)
    assert v_wall.mean() == pytest.approx(0.0, abs=1e-12)


def test_bins_weigh_as_much_as_they_hold() -> None:
    y = half_cells(WIDTH)
    velocity = np.tile(bin_means(y, 0.3, 0.0), (2, 1))
    counts = np.full_like(velocity, 50.0)
    velocity[:, 9], counts[:, 9] = 9.0, 1e-6
    v_max, _ = flow.fit_parabola(y, WIDTH, counts, velocity)
    assert v_max == pytest.approx([0.3, 0.3], rel=1e-6)


def test_mean_velocity_is_weighted_by_particles() -> None:
    counts, velocity = np.array([[1.0, 3.0], [0.0, 0.0]]), np.array([[4.0, 8.0], [0.0, 0.0]])
    assert flow.mean_velocity(counts, velocity).tolist() == [7.0, 0.0]
    assert flow.momentum_profile(counts, velocity).mean(axis=0).tolist() == [4.0, 8.0]


def test_pulls_of_the_maximum_are_standard_normal() -> None:
    random = np.random.default_rng(4)
    y, repeats = half_cells(WIDTH), 200
    exact = bin_means(y, 0.1, 0.0)
    pulls = []
    for _ in range(repeats):
        velocity = exact + 0.05 * random.normal(size=(512, len(y)))
        v_max, _ = flow.fit_parabola(y, WIDTH, np.full_like(velocity, 50.0), velocity)
        value, error = known(correlated_mean.mean(v_max))
        pulls.append((value - 0.1) / error)
    # false-alarm rate 1e-5 each; errors from 32 blocks: Student's t has deviation 1.03
    assert abs(np.mean(pulls)) < 4.4 / math.sqrt(repeats)
    assert abs(np.std(pulls) - 1.03) < 4.4 / math.sqrt(2 * repeats)


def test_too_few_bins() -> None:
    with pytest.raises(ValueError, match="fewer than 3 bins"):
        flow.fit_parabola(np.array([2.5, 7.5]), WIDTH, np.ones((4, 2)), np.ones((4, 2)))


def test_reynolds_number_by_hand() -> None:
    assert flow.reynolds_number(0.2, 10.0, 5.0) == pytest.approx(0.4)

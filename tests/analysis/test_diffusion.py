import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.signal import lfilter

from analysis.diffusion import autocorrelation, diffusion, mean_squared_displacement
from tests.analysis.known import known

Array = NDArray[np.float64]


def double_loop(x: Array, product: Callable[[Array, Array], Any]) -> list[float]:
    frames = len(x)
    return [
        np.mean([product(x[t], x[t + lag]) for t in range(frames - lag)]) for lag in range(frames)
    ]


def test_fft_is_the_double_loop() -> None:
    x = np.random.default_rng(0).normal(size=(37, 3)) + 10.0
    msd = double_loop(x, lambda a, b: np.mean((b - a) ** 2))
    assert mean_squared_displacement(x) == pytest.approx(msd, rel=1e-11, abs=1e-12)
    vacf = double_loop(x, lambda a, b: np.mean(a * b))
    assert autocorrelation(x) == pytest.approx(vacf, rel=1e-11)


def test_ballistic_motion() -> None:
    x = 3.0 * np.arange(50.0)[:, None]
    assert mean_squared_displacement(x) == pytest.approx(9.0 * np.arange(50) ** 2, rel=1e-10)
    assert autocorrelation(np.full((50, 2), 3.0)) == pytest.approx(np.full(50, 9.0))


def test_msd_keeps_its_digits_far_from_the_origin() -> None:
    x = 1e6 + 1e-3 * np.random.default_rng(0).normal(size=(100, 1)).round(3)
    near = mean_squared_displacement(x - 1e6)
    assert mean_squared_displacement(x) == pytest.approx(near, rel=1e-6)


def test_random_walk_with_drift() -> None:
    random = np.random.default_rng(1)
    frames, colloids, step, interval = 2000, 6, 0.1, 0.5
    x = np.cumsum(step * random.normal(size=(frames, colloids)), axis=0)
    x += 0.7 * interval * np.arange(frames)[:, None]
    found = diffusion(x, random.normal(size=x.shape), interval)
    expected = step**2 / (2 * interval)
    assert not found.subdiffusive
    assert found.window == (3.0, 31.0)
    value, error = known(found.from_msd)
    assert error < 0.15 * expected
    assert abs(value - expected) < 4 * error
    exponent, error = known(found.exponent)
    assert abs(exponent - 1) < 4 * error
    assert found.from_vacf.value is None
    assert "in one sampling interval" in (found.from_vacf.reason or "")


def test_pulls_of_the_diffusion_coefficient() -> None:
    random = np.random.default_rng(2)
    pulls, alarms, hits, repeats = [], 0, 0, 200
    for _ in range(repeats):
        x = np.cumsum(random.normal(size=(800, 4)), axis=0)
        found = diffusion(x, random.normal(size=x.shape), 1.0)
        if found.from_msd.value is None:
            alarms += 1
        else:
            value, error = known(found.from_msd)
            pulls.append((value - 0.5) / error)
            hits += abs(found.from_msd.deviation(0.5)) < 1.96
    # 8 segments: Student's t with 7 degrees of freedom has deviation 1.18. The drift that is
    # taken out costs at most 3 %, a third of an error
    assert abs(np.mean(pulls)) < 1 / 3 + 4.4 / math.sqrt(repeats)
    assert 0.7 < np.std(pulls) < 1.5
    assert 0.90 < hits / len(pulls) < 0.99
    # a walk is called anomalous in about one of 40 runs; 16 of 200 has a chance below 1e-4
    assert alarms < 16


def ornstein_uhlenbeck(
    random: np.random.Generator, frames: int, colloids: int, relaxation: float
) -> tuple[Array, Array]:
    """Velocities of unit variance and exponential VACF, and their sums as positions."""
    factor = math.exp(-1 / relaxation)
    noise = random.normal(size=(frames, colloids)) * math.sqrt(1 - factor**2)
    velocity = lfilter([1], [1, -factor], noise, axis=0)
    return np.cumsum(velocity, axis=0), velocity


def test_both_coefficients_agree_when_the_vacf_is_resolved() -> None:
    random = np.random.default_rng(3)
    relaxation = 5.0
    x, velocity = ornstein_uhlenbeck(random, 40_000, 10, relaxation)
    drift = 0.5
    x, velocity = x + drift * np.arange(len(x))[:, None], velocity + drift
    found = diffusion(x, velocity, 1.0)
    expected = 0.5 / math.tanh(0.5 / relaxation)  # the trapezoid sum of exp(-t / relaxation)
    value, error = known(found.from_vacf)
    assert error < 0.15 * expected
    assert abs(value - expected) < 4 * error
    value, error = known(found.from_msd)
    assert abs(value - expected) < 4 * error
    assert found.vacf[5] / found.vacf[0] == pytest.approx(math.exp(-1), abs=0.02)


def single_file(random: np.random.Generator, frames: int, points: int) -> Array:
    """Walkers that exchange labels when they meet: sorted independent walks on a line."""
    start = np.arange(points) * 2.0
    return np.sort(start + np.cumsum(random.normal(size=(frames, points)), axis=0), axis=1)


def test_single_file_is_subdiffusive_and_has_no_coefficient() -> None:
    random = np.random.default_rng(4)
    x = single_file(random, 4000, 400)[:, 150:250]  # the middle of a long file
    found = diffusion(x, random.normal(size=x.shape), 1.0)
    assert found.subdiffusive
    assert found.exponent.value == pytest.approx(0.5, abs=0.1)
    assert found.from_msd.value is None
    assert found.from_msd.reason == "subdiffusive"
    assert found.from_vacf.value is None


def test_colloids_of_different_speed_are_superdiffusive() -> None:
    random = np.random.default_rng(5)
    frames = np.arange(800)[:, None]
    x = frames * np.array([0.1, 0.3]) + 0.01 * random.normal(size=(800, 2))
    found = diffusion(x, random.normal(size=x.shape), 1.0)
    assert not found.subdiffusive
    assert found.from_msd.reason == "superdiffusive: the drift is not uniform"


def test_too_few_frames() -> None:
    with pytest.raises(ValueError, match="319 frames; at least 320 are needed"):
        diffusion(np.zeros((319, 1)), np.zeros((319, 1)), 1.0)


def test_colloids_at_rest() -> None:
    with pytest.raises(ValueError, match="do not move about their drift"):
        diffusion(np.zeros((320, 2)), np.zeros((320, 2)), 1.0)

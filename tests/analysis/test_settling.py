from pathlib import Path

import numpy as np
import pytest

from analysis import RunDirectory
from analysis.settling import co_moving, settling_series, settling_speed
from analysis.temperature import colloid_temperature
from tests.analysis.run_writer import write_channel


def test_ballistic_colloids() -> None:
    times = np.arange(11) * 0.5
    x = np.array([0.0, 7.0]) + times[:, None] * np.array([0.1, 0.3])
    assert settling_speed(x, 0.5) == pytest.approx(np.full(10, 0.2))


def test_co_moving_frame_by_hand() -> None:
    # one colloid of mass 30 at speed 4 among 10 fluid particles at rest: P/M = 120/40 = 3
    assert co_moving(np.array([4.0]), np.array([3.0])).tolist() == [1.0]


def test_temperature_of_two_colloids_by_hand() -> None:
    # only y counts: M (1 + 9) / 2
    velocities = np.array([[[7.0, 1.0], [8.0, -3.0]]])
    assert colloid_temperature(velocities, mass=5.0) == pytest.approx([25.0])


def test_temperature_is_free_of_the_drift() -> None:
    random = np.random.default_rng(3)
    mass, samples = 125.0, 40_000
    velocities = random.normal(size=(samples, 1, 2)) / np.sqrt(mass) + [0.5, 0.0]
    # variance of the mean of 40000 squared normal deviates: 2/40000; 4.4 deviations (1e-5)
    found = colloid_temperature(velocities, mass).mean()
    assert found == pytest.approx(1.0, abs=4.4 * np.sqrt(2 / samples))


def test_series_of_a_run(tmp_path: Path) -> None:
    # output each t = 1, equilibration to t = 5: of 9 intervals the last 4 lie after it
    times = np.arange(10.0)[:, None, None]
    positions = np.array([[5.0, 5.0]]) + times * [0.25, 0.0]  # exact in float32
    write_channel(tmp_path / "run", positions, np.zeros((10, 1, 2)), np.full(9, 0.1))
    series = settling_series(RunDirectory(tmp_path / "run"))
    assert series.times == pytest.approx(np.arange(1.0, 10.0))
    assert series.rest == pytest.approx(np.full(9, 0.25))
    assert series.co_moving == pytest.approx(np.full(9, 0.15))
    assert series.used.tolist() == [False] * 5 + [True] * 4

"""Temperatures, currents, profiles and viscosity of driven mixtures."""

import numpy as np
import pytest

from analysis.current import current, flow_profiles, mobility, viscosity
from analysis.kinetic_temperature import kinetic_temperature, stream_temperature

SIGNS = np.array([1, -1, 1, -1])
LANES = np.array([[[2.0, 0.5], [-2.0, 0.5], [2.0, -0.5], [-2.0, -0.5]]])  # (1, 4, 2)


def test_lanes_at_constant_speed_by_hand() -> None:
    # sum v^2 = 4 (4 + 1/4) over 2 x 4; relative to the streams 4 / 4 over 2 (4 - 2)
    assert kinetic_temperature(LANES) == pytest.approx([17 / 8])
    assert stream_temperature(LANES, SIGNS) == pytest.approx([1 / 4])
    assert kinetic_temperature(LANES, 2.0) == pytest.approx([17 / 4])
    assert current(LANES[:, :, 0], SIGNS).tolist() == [2]


def test_temperatures_of_particles_of_unlike_masses() -> None:
    random = np.random.default_rng(0)
    masses = np.where(np.arange(50) % 2, 1.0, 3.0)
    velocities = random.normal(0, np.sqrt(0.8 / masses)[:, None], (4000, 50, 3))
    assert kinetic_temperature(velocities, masses).mean() == pytest.approx(0.8, rel=0.006)
    drift = np.where(masses == 1, 2.0, -1.0)[:, None] * [1, 0, 0]
    relative = stream_temperature(velocities + drift, masses == 1, masses)
    assert relative.mean() == pytest.approx(0.8, rel=0.006)  # 3 deviations of sqrt(2 / 6e5)
    brute = []
    for frame in velocities[:3] + drift:
        total = 0.0
        for own in (masses == 1, masses == 3):
            mean = (
                sum(m * v for m, v in zip(masses[own], frame[own], strict=True)) / masses[own].sum()
            )
            total += sum(
                m * ((v - mean) ** 2).sum() for m, v in zip(masses[own], frame[own], strict=True)
            )
        brute.append(total / (3 * 48))
    assert relative[:3] == pytest.approx(brute)


def test_mobility() -> None:
    estimate = mobility([2.0, 4.0] * 8, 1.5)
    assert estimate.value == pytest.approx(2)
    with pytest.raises(ValueError, match="needs a field"):
        mobility([1.0], 0)


def test_profiles_by_hand_and_by_brute_force() -> None:
    heights = np.array([[0.1, 5.1, -9.0, 15.0]])  # in a box of 10: layers 0, 2, 0, 2 of 4
    y, counts, speeds = flow_profiles(heights, LANES[:, :, 0] * [[1, 1, 2, 2]], SIGNS, 10.0, 4)
    assert y.tolist() == [1.25, 3.75, 6.25, 8.75]
    assert counts.tolist() == [[0, 0, 2, 0], [2, 0, 0, 0]]  # of -1, then of +1
    np.testing.assert_array_equal(speeds[1], [3, np.nan, np.nan, np.nan])
    random = np.random.default_rng(1)
    heights, velocities = random.uniform(-30, 30, (7, 40)), random.normal(size=(7, 40))
    colours = random.integers(0, 2, 40)
    _, counts, speeds = flow_profiles(heights, velocities, colours, 8.0, 5)
    for kind in (0, 1):
        for layer in range(5):
            inside = [
                velocities[t, i]
                for t in range(7)
                for i in range(40)
                if colours[i] == kind and int((heights[t, i] % 8) / 1.6) == layer
            ]
            assert counts[kind, layer] == pytest.approx(len(inside) / 7)
            assert speeds[kind, layer] == pytest.approx(np.mean(inside))


def test_viscosity() -> None:
    assert viscosity([-3.0, -5.0] * 8, 2.0).value == 2
    with pytest.raises(ValueError, match="needs a flow"):
        viscosity([1.0], 0)

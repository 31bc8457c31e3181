import math

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import quad
from scipy.signal import lfilter

from analysis.shear_wave import decay_viscosity, wave_amplitude
from tests.analysis.known import known
from tests.analysis.run_writer import half_cells

Array = NDArray[np.float64]

WIDTH, VISCOSITY = 32.0, 0.755
RATE = VISCOSITY * (2 * math.pi / WIDTH) ** 2


def test_amplitude_is_exact_for_bin_averages() -> None:
    y = half_cells(WIDTH)
    wave = [
        quad(lambda s: 0.3 * math.sin(2 * math.pi * s / WIDTH), c - 0.25, c + 0.25)[0] / 0.5
        for c in y
    ]
    amplitude = wave_amplitude(y, WIDTH, np.ones((2, len(y))), np.array([wave, wave]))
    assert amplitude == pytest.approx([0.3, 0.3], rel=1e-10)


@pytest.mark.parametrize("samples", [1, 10])
def test_decay_without_noise(samples: int) -> None:
    # one interval averages `samples` points: a constant factor, the rate stays
    amplitude = 0.1 * np.exp(-RATE * np.arange(1, 200 * samples + 1) / samples)
    means = amplitude.reshape(200, samples).mean(axis=1)
    means += 1e-9 * np.random.default_rng(0).normal(size=200)
    found = decay_viscosity(means, 1.0, samples, WIDTH)
    assert found.value == pytest.approx(VISCOSITY, rel=1e-6)


def decaying_wave(random: np.random.Generator, intervals: int, samples: int) -> Array:
    """A wave of amplitude 1 on the thermal noise of 32 x 32 cells of 10 particles."""
    variance = 2 / (10 * WIDTH**2)
    factor = math.exp(-RATE / samples)
    noise = random.normal(size=intervals * samples) * math.sqrt(variance * (1 - factor**2))
    noise[0] += factor * (1.0 + math.sqrt(variance) * random.normal())
    amplitude = lfilter([1], [1, -factor], noise).reshape(intervals, samples)
    return np.asarray(amplitude.mean(axis=1))


@pytest.mark.parametrize("samples", [1, 10])
def test_pulls_are_standard_normal(samples: int) -> None:
    random = np.random.default_rng(5)
    repeats = 150
    pulls, errors = [], []
    for _ in range(repeats):
        found = decay_viscosity(decaying_wave(random, 200, samples), 1.0, samples, WIDTH)
        value, error = known(found)
        pulls.append((value - VISCOSITY) / error)
        errors.append(error / VISCOSITY)
    assert np.median(errors) < 0.03
    # false-alarm rate 1e-5 each
    assert abs(np.mean(pulls)) < 4.4 / math.sqrt(repeats)
    assert abs(np.std(pulls) - 1) < 4.4 / math.sqrt(2 * repeats)


def test_intervals_of_a_short_decay_hold_the_truth() -> None:
    random = np.random.default_rng(7)
    repeats = 300
    hits = sum(
        abs(decay_viscosity(decaying_wave(random, 12, 10), 1.0, 10, WIDTH).deviation(VISCOSITY))
        < 1.96
        for _ in range(repeats)
    )
    # 94 % of them; normal intervals would hold 89 %. False-alarm rate 1e-4
    assert 0.885 < hits / repeats < 0.985


def test_averaging_must_not_be_taken_for_sampling() -> None:
    """Means over intervals treated as single samples would be biased far beyond the error."""
    random = np.random.default_rng(6)
    factor = math.exp(-RATE)
    noise = random.normal(size=200_000)
    amplitude = lfilter([1], [1, -factor], noise).reshape(-1, 20).mean(axis=1)
    right, error = known(decay_viscosity(amplitude, 20.0, 20, WIDTH))
    assert abs(right - VISCOSITY) < 4.4 * error
    wrong, error = known(decay_viscosity(amplitude, 20.0, 1, WIDTH))
    assert abs(wrong - VISCOSITY) > 10 * error


def test_too_few_intervals() -> None:
    found = decay_viscosity(np.ones(9), 1.0, 1, WIDTH)
    assert found.value is None
    assert found.reason == "9 intervals are too few; 10 are needed"


def test_growth_is_no_decay() -> None:
    found = decay_viscosity(np.exp(0.1 * np.arange(100.0)), 1.0, 1, WIDTH)
    assert found.value is None
    assert found.reason == "the decay is not resolved by the sampled times"

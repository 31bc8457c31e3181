import math

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.signal import lfilter

from analysis.blocking import Estimate, blocking_curve, mean, mean_of_independent
from tests.analysis.known import known

Array = NDArray[np.float64]

PULL_BOUND = 4.4  # two-sided false-alarm rate 1e-5 for a normal deviate


def autoregressive(phi: float, samples: int, random: np.random.Generator) -> Array:
    """AR(1) of unit variance, stationary from the start."""
    noise = random.normal(size=samples) * math.sqrt(1 - phi**2)
    noise[0] /= math.sqrt(1 - phi**2)
    return lfilter([1], [1, -phi], noise)


def exact_error(phi: float, samples: int) -> float:
    """Standard deviation of the mean of n samples of AR(1), in closed form."""
    lags = np.arange(1, samples)
    return math.sqrt((samples + 2 * ((samples - lags) * phi**lags).sum()) / samples**2)


def test_curve_of_a_square_wave_by_hand() -> None:
    # single samples +-1 scatter by s^2 = 4/3, n = 4; means of pairs are all 0
    lengths, errors = blocking_curve([1.0, -1.0, 1.0, -1.0])
    assert lengths.tolist() == [1, 2]
    assert errors == pytest.approx([math.sqrt(4 / 3 / 4), 0.0])


@pytest.mark.parametrize("phi", [0.0, 0.5, 0.9])
def test_error_of_ar1_is_the_closed_form(phi: float) -> None:
    random = np.random.default_rng(1)
    samples, repeats = 4096, 60
    squares = [known(mean(autoregressive(phi, samples, random)))[1] ** 2 for _ in range(repeats)]
    # variance of a variance from m blocks is 2/(m - 1): m >= 12 here, so the mean over 60 repeats
    # scatters by 5.5 %; the bias of blocks of finite length adds at most 10 %
    assert math.sqrt(np.mean(squares)) == pytest.approx(exact_error(phi, samples), rel=0.15)


def test_naive_error_of_ar1_would_be_wrong() -> None:
    naive = blocking_curve(autoregressive(0.9, 4096, np.random.default_rng(1)))[1][0]
    assert exact_error(0.9, 4096) / naive == pytest.approx(math.sqrt(19), rel=0.1)


def test_pulls_are_standard_normal() -> None:
    random = np.random.default_rng(2)
    found = [known(mean(autoregressive(0.5, 4096, random))) for _ in range(200)]
    pulls = np.array([value / error for value, error in found])
    assert abs(pulls.mean()) < PULL_BOUND / math.sqrt(200)
    # errors from 22 blocks or more: Student's t has a standard deviation of 1.05 at most
    assert abs(pulls.std() - 1.03) < PULL_BOUND / math.sqrt(2 * 200)


def test_correlation_longer_than_the_series_gives_a_lower_bound() -> None:
    ramp = np.linspace(0.0, 1.0, 1000)
    estimate = mean(ramp)
    assert estimate.value == pytest.approx(0.5)
    assert estimate.reason == "at least: 1000 samples are too correlated"
    # the longest blocks that leave six: 128 samples, 7 means of a ramp 0.128 apart
    assert estimate.error == pytest.approx(0.1282 * math.sqrt(14 / 3 / 7), rel=0.01)


def test_a_single_sample_has_no_error() -> None:
    assert mean([3.0]) == Estimate(3.0, None, "one sample has no error")


def test_few_samples_have_their_plain_error_as_a_lower_bound() -> None:
    # 0, 1, 0, 1, 0 about 2/5: variance 0.3 of each, 0.06 of the mean
    estimate = mean(np.arange(5) % 2)
    assert estimate.value == pytest.approx(0.4)
    assert estimate.error == pytest.approx(math.sqrt(0.06))
    assert estimate.reason == "at least: 5 samples are too few"


@pytest.mark.parametrize(("count", "reason"), [(5, "error from 5 samples"), (6, None)])
def test_independent_samples_have_their_plain_error(count: int, reason: str | None) -> None:
    estimate = mean_of_independent(np.arange(count) % 2)
    assert estimate.value == pytest.approx((count // 2) / count)
    assert estimate.error == pytest.approx(math.sqrt(0.3 / count))
    assert (estimate.reason or "").startswith(reason or "")
    assert (estimate.reason is None) == (reason is None)
    assert mean_of_independent([1.0]) == Estimate(1.0, None, "one sample has no error")


def test_no_samples() -> None:
    assert mean([]) == Estimate(None, None, "no samples")


def test_constant_has_no_error() -> None:
    value, error = known(mean([0.1] * 100))
    assert value == pytest.approx(0.1)
    assert error == 0.0


def test_curve_refuses_a_single_sample() -> None:
    with pytest.raises(ValueError, match="at least 2 samples"):
        blocking_curve([1.0])


def test_json_of_an_estimate() -> None:
    assert Estimate(1.0, 0.1).as_json() == {"value": 1.0, "error": 0.1}
    assert Estimate(1.0, None, "why").as_json() == {"value": 1.0, "error": None, "reason": "why"}


def test_scaled_by_a_negative_factor_keeps_the_error_positive() -> None:
    assert Estimate(1.0, 0.1).scaled(-2) == Estimate(-2.0, 0.2)

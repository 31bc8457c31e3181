import math

import numpy as np
import pytest
from scipy import stats

from analysis.estimate import (
    Estimate,
    jackknife,
    joint_freedom,
    mean_of_independent,
    mean_of_repeats,
)

THREE, FIVE = Estimate(3.0, 0.3), Estimate(5.0, 0.4)


@pytest.mark.parametrize(
    ("result", "value", "error"),
    [
        (THREE + FIVE, 8.0, 0.5),
        (THREE - FIVE, -2.0, 0.5),
        (1 - THREE, -2.0, 0.3),
        (THREE + 1, 4.0, 0.3),
        (THREE * FIVE, 15.0, math.hypot(0.3 * 5, 0.4 * 3)),
        (2 * THREE, 6.0, 0.6),
        (-THREE, -3.0, 0.3),
        (THREE / FIVE, 0.6, 0.6 * math.hypot(0.1, 0.08)),
        (6 / THREE, 2.0, 0.2),
        (THREE / -2, -1.5, 0.15),
        (Estimate(9.0, 0.6).sqrt(), 3.0, 0.1),
        (Estimate(0.0, 0.01).sqrt(), 0.0, 0.1),
        (THREE.scaled(-2), -6.0, 0.6),
    ],
)
def test_arithmetic_by_hand(result: Estimate, value: float, error: float) -> None:
    assert (result.value, result.error) == pytest.approx((value, error))
    assert result.reason is None
    assert result.freedom == math.inf


def test_errors_of_a_function_are_those_of_a_sample() -> None:
    random = np.random.default_rng(1)
    a, b = 3 + 0.03 * random.normal(size=100_000), 5 + 0.04 * random.normal(size=100_000)
    one, other = Estimate(3.0, 0.03), Estimate(5.0, 0.04)
    expected = (np.sqrt(a / b) * (a - b)).std()
    # sqrt(a/b) and a - b are not independent: the arithmetic is told apart from the truth here
    assert ((one / other).sqrt() * (one - other)).error != pytest.approx(expected, rel=0.05)
    assert (one / other).sqrt().error == pytest.approx(np.sqrt(a / b).std(), rel=0.02)
    assert (one * other - 1).error == pytest.approx((a * b).std(), rel=0.02)


def test_reasons_are_carried_once() -> None:
    poor, poorer = Estimate(1.0, 0.1, "short"), Estimate(2.0, None, "one run")
    assert (poor - poorer) == Estimate(-1.0, None, "short; one run")
    assert (poor + poor).reason == "short"
    assert (poor * Estimate(None, None, "no gravity")) == Estimate(None, None, "short; no gravity")
    assert Estimate(None, None, "no gravity").sqrt().reason == "no gravity"


def test_what_cannot_be_computed_says_so() -> None:
    assert Estimate(None, None, "division by 0") == (THREE / 0)
    assert Estimate(-1.0, 0.1).sqrt().reason == "the square root of a negative number"
    assert (THREE / Estimate(0.1, 0.1)).reason == "the divisor is 0 within 2 of its errors"
    with pytest.raises(ValueError, match="no value: no gravity"):
        _ = Estimate(None, None, "no gravity").number
    with pytest.raises(ValueError, match="no error: not measured"):
        _ = Estimate(1.0, None).standard_error
    with pytest.raises(ValueError, match=r"confidence = 1\.5: must be between 0 and 1"):
        THREE.interval(1.5)


def test_intervals_are_those_of_students_t() -> None:
    low, high = Estimate(1.0, 0.1, freedom=4).interval(0.95)
    assert (low, high) == pytest.approx((1 - 0.2776, 1 + 0.2776), abs=1e-4)  # a table's 2.776
    assert THREE.half_width(0.6827) == pytest.approx(0.3, rel=1e-4)


def test_deviation_is_normal_whatever_the_freedom() -> None:
    # both are as improbable as 1.96 normal standard deviations
    assert Estimate(1.2776, 0.1, freedom=4).deviation(1.0) == pytest.approx(1.96, abs=1e-3)
    assert Estimate(0.804, 0.1).deviation(1.0) == pytest.approx(-1.96, abs=1e-9)
    assert THREE.deviation(FIVE) == pytest.approx(-4.0)
    assert Estimate(1.0, 0.0).deviation(1.0) == 0.0
    assert Estimate(2.0, 0.0).deviation(1.0) == math.inf


def test_freedom_of_a_sum() -> None:
    # Welch-Satterthwaite: two equal variances with 4 each have 8; one that is all keeps its own
    assert joint_freedom([1.0, 1.0], [4.0, 4.0]) == pytest.approx(8.0)
    assert joint_freedom([1.0, 0.0], [4.0, 1.0]) == pytest.approx(4.0)
    assert joint_freedom([1.0, 1.0], [4.0, math.inf]) == pytest.approx(16.0)
    assert joint_freedom([0.0], [4.0]) == math.inf
    difference = Estimate(1.0, 0.1, freedom=4) - Estimate(1.0, 0.1, freedom=4)
    assert difference.freedom == pytest.approx(8.0)
    assert Estimate(4.0, 0.1, freedom=5).sqrt().freedom == 5


def test_json_and_back() -> None:
    assert Estimate(1.0, 0.1).as_json() == {"value": 1.0, "error": 0.1}
    for estimate in (Estimate(1.0, 0.1, "short", 7.5), Estimate(1.0, None, "why"), THREE):
        assert Estimate.of_json(estimate.as_json() | {"theory": 2.0}) == estimate


@pytest.mark.parametrize(("count", "reason"), [(5, "error from 5 samples"), (6, None)])
def test_independent_samples_have_their_plain_error(count: int, reason: str | None) -> None:
    # 0, 1, 0, 1, 0 about 2/5: variance 0.3 of each, 0.06 of the mean
    estimate = mean_of_independent(np.arange(count) % 2)
    assert estimate.value == pytest.approx((count // 2) / count)
    assert estimate.error == pytest.approx(math.sqrt(0.3 / count))
    assert estimate.freedom == count - 1
    assert (estimate.reason or "").startswith(reason or "")
    assert (estimate.reason is None) == (reason is None)
    assert mean_of_independent([1.0]) == Estimate(1.0, None, "one sample has no error")
    assert mean_of_independent([]) == Estimate(None, None, "no samples")


def test_repeats_by_hand() -> None:
    # spread s^2/R = 2/2 = 1 with freedom 1; own errors sum e^2/R^2 = 8/4 = 2 with 4 + 4
    repeats = [Estimate(1.0, 2.0, freedom=4), Estimate(3.0, 2.0, freedom=4)]
    mean = mean_of_repeats(repeats)
    assert (mean.value, mean.error) == pytest.approx((2.0, math.sqrt((1 * 1 + 8 * 2) / 9)))
    assert mean.freedom == pytest.approx(9.0)
    assert mean.reason is None


def test_repeats_beyond_their_errors_have_their_spread() -> None:
    mean = mean_of_repeats([Estimate(v, 0.01, freedom=20) for v in (0.0, 1.0, 2.0)])
    assert mean.error == pytest.approx(1 / math.sqrt(3))
    assert mean.freedom == 2
    assert "the repeats spread beyond their own errors" in (mean.reason or "")


def test_repeats_that_lack_something() -> None:
    nothing = Estimate(None, None, "subdiffusive")
    assert mean_of_repeats([nothing, nothing]) == nothing
    assert mean_of_repeats([THREE, nothing]) == Estimate(3.0, 0.3, "1 of 2 repeats tell")
    lone = mean_of_repeats([Estimate(1.0, None, "short"), Estimate(3.0, 0.1)])
    assert (lone.value, lone.error, lone.freedom) == pytest.approx((2.0, 1.0, 1.0))


def test_repeats_are_covered() -> None:
    random = np.random.default_rng(3)
    hits, trials = 0, 1000
    for _ in range(trials):
        errors = np.sqrt(random.chisquare(4, size=3) / 4)
        repeats = [Estimate(random.normal(), e, freedom=4) for e in errors]
        hits += abs(mean_of_repeats(repeats).deviation(0.0)) < 1.96
    # four binomial deviations of 0.7 % about 95 %, and 1 % for the runs whose errors are given up
    assert 0.92 < hits / trials < 0.98


def test_jackknife_of_a_mean_is_its_plain_error() -> None:
    segments = np.array([[1.0, 0.0], [2.0, 0.0], [6.0, 0.0]])
    estimate = jackknife(lambda row: float(row.sum()), segments)
    assert (estimate.value, estimate.freedom) == (3.0, 2)
    assert estimate.error == pytest.approx(stats.sem([1.0, 2.0, 6.0]))

import math
import re
from collections.abc import Callable

import numpy as np
import pytest

from analysis.correlated_mean import correlation_time, function_of_means, mean, ratio
from analysis.estimate import Estimate
from analysis.line_fit import fit_polynomial
from tests.analysis.processes import Array, autoregressive, exact_error, two_times


@pytest.mark.parametrize("time", [0.0, 1.5, 10.0])
def test_error_of_ar1_is_the_closed_form(time: float) -> None:
    random = np.random.default_rng(1)
    samples, repeats = 4096, 40
    errors = [mean(autoregressive(time, samples, random)).standard_error for _ in range(repeats)]
    # each error is known to 4 to 10 %; prior weight on slower motion adds some percent
    assert np.median(errors) == pytest.approx(exact_error(time, samples), rel=0.12)


def test_slow_motion_of_one_percent_is_seen() -> None:
    """Most of the error lies in 1 % of the variance: blocks of the fast time would miss it."""
    random = np.random.default_rng(2)
    samples, fast, slow, share = 20_000, 1.0, 500.0, 0.01
    truth = math.sqrt(
        (1 - share) * exact_error(fast, samples) ** 2 + share * exact_error(slow, samples) ** 2
    )
    errors = [mean(two_times(fast, slow, share, samples, random)).standard_error for _ in range(40)]
    assert truth > 2 * exact_error(fast, samples)
    assert np.median(errors) == pytest.approx(truth, rel=0.2)


PROCESSES: dict[str, Callable[[int, np.random.Generator], Array]] = {
    "white": lambda n, random: random.normal(size=n),
    "AR(1), 1/200": lambda n, random: autoregressive(n / 200, n, random),
    "AR(1), 0.1": lambda n, random: autoregressive(0.1 * n, n, random),
    "AR(1), 0.2": lambda n, random: autoregressive(0.2 * n, n, random),
    "AR(1), 0.3": lambda n, random: autoregressive(0.3 * n, n, random),
    "1 % slow": lambda n, random: two_times(1.0, n / 20, 0.01, n, random),
    "10 % slow": lambda n, random: two_times(1.0, n / 20, 0.1, n, random),
    "50 % slow": lambda n, random: two_times(1.0, n / 20, 0.5, n, random),
}


@pytest.mark.statistics
@pytest.mark.parametrize("name", PROCESSES)
def test_intervals_hold_the_truth(name: str) -> None:
    random = np.random.default_rng(4)
    trials = 600
    hits = sum(
        low < 0 < high
        for low, high in (mean(PROCESSES[name](1000, random)).interval() for _ in range(trials))
    )
    # 90 to 98 % is asked for, give or take three binomial deviations
    assert 0.90 - 0.037 < hits / trials < 0.98 + 0.017


@pytest.mark.statistics
def test_intervals_of_a_difference_and_of_a_slope_hold_the_truth() -> None:
    random = np.random.default_rng(5)
    trials, difference, slope = 300, 0, 0
    x = np.arange(6.0)
    for _ in range(trials):
        points = [mean(autoregressive(50.0, 2000, random)) for _ in x]
        low, high = (points[0] - points[1]).interval()
        difference += low < 0 < high
        low, high = fit_polynomial(x, points).slope.interval()
        slope += low < 0 < high
    assert 0.87 < difference / trials < 0.999
    assert 0.87 < slope / trials < 0.999


def test_short_run_says_how_long_it_must_be() -> None:
    series = autoregressive(300.0, 1000, np.random.default_rng(6))
    estimate = mean(series, interval=0.5)
    assert re.match(r"lower bound: run longer, at least \d+ t0;", estimate.reason or "")
    assert "is slow for 500 t0" in (estimate.reason or "")
    assert estimate.freedom < 5
    assert "samples; motion of" in (mean(series).reason or "")


def test_false_alarms_of_short_runs_are_rare() -> None:
    random = np.random.default_rng(7)
    white = [mean(random.normal(size=500)) for _ in range(60)]
    short = [mean(autoregressive(100.0, 500, random)) for _ in range(60)]
    assert sum(estimate.reason is not None for estimate in white) < 10
    assert sum(estimate.reason is not None for estimate in short) > 54


def test_runs_together_know_what_each_does_not() -> None:
    """Ten runs of ten correlation times each: the spread of their means is an error too."""
    random = np.random.default_rng(8)
    sets = [[autoregressive(100.0, 1000, random) for _ in range(10)] for _ in range(10)]
    together, alone = [mean(runs) for runs in sets], [mean(runs[0]) for runs in sets]
    assert together[0].value == pytest.approx(np.mean(sets[0]))
    exact = exact_error(100.0, 1000) / math.sqrt(10)
    assert np.median([e.standard_error for e in together]) == pytest.approx(exact, rel=0.15)
    assert all(estimate.reason is None for estimate in together)
    assert sum(estimate.reason is not None for estimate in alone) > 7
    assert np.median([e.freedom for e in together]) > 3 * np.median([e.freedom for e in alone])


def test_runs_that_differ_beyond_their_motion_are_not_one_long_run() -> None:
    random = np.random.default_rng(9)
    runs = [random.normal() + 0.1 * random.normal(size=500) for _ in range(10)]
    estimate = mean(runs)
    spread = np.std([run.mean() for run in runs], ddof=1) / math.sqrt(10)
    assert estimate.error == pytest.approx(spread, rel=0.4)
    assert estimate.freedom < 20


def test_runs_of_different_length_weigh_by_their_samples() -> None:
    random = np.random.default_rng(10)
    runs = [random.normal(size=n) for n in (3000, 1000, 40, 1)]
    estimate = mean(runs)
    assert estimate.value == pytest.approx(np.concatenate(runs).mean())
    assert estimate.error == pytest.approx(1 / math.sqrt(4041), rel=0.2)


@pytest.mark.parametrize("time", [3.0, 30.0])
def test_correlation_time_of_ar1(time: float) -> None:
    random = np.random.default_rng(11)
    times = [correlation_time(autoregressive(time, 10_000, random), 0.5) for _ in range(20)]
    exact = 10_000 * exact_error(time, 10_000) ** 2 / 2
    assert np.mean([t.number for t in times]) == pytest.approx(0.5 * exact, rel=0.15)
    deviations = [(t.number - 0.5 * exact) / t.standard_error for t in times]
    assert np.std(deviations) == pytest.approx(1.0, abs=0.5)


def test_correlation_time_of_white_noise_is_half_a_sample() -> None:
    random = np.random.default_rng(12)
    times = [correlation_time(random.normal(size=10_000)) for _ in range(10)]
    # 256 modes tell it to 9 %
    assert np.mean([t.number for t in times]) == pytest.approx(0.5, rel=0.1)
    assert 0.02 < np.median([t.standard_error for t in times]) < 0.1


def test_anticorrelated_series_has_a_small_error() -> None:
    noise = np.random.default_rng(13).normal(size=4001)
    series = noise[1:] - 0.8 * noise[:-1]  # the spectrum at 0 is (1 - 0.8)^2
    assert mean(series).error == pytest.approx(0.2 / math.sqrt(4000), rel=0.3)


def test_ratio_of_one_run_knows_the_covariance() -> None:
    random = np.random.default_rng(14)
    below = 2 + 0.1 * autoregressive(5.0, 4000, random)
    above = 3 * below + 0.01 * random.normal(size=4000)
    found = ratio(above, below)
    assert found.value == pytest.approx(3.0, abs=1e-3)
    assert found.error == pytest.approx(0.01 / 2 / math.sqrt(4000), rel=0.2)
    independent = mean(above) / mean(below)
    assert independent.standard_error > 10 * found.standard_error


def test_function_of_one_mean_is_linear() -> None:
    series = 5 + autoregressive(2.0, 1000, np.random.default_rng(15))
    found, plain = function_of_means(lambda m: 3 * m - 1, series), mean(series)
    assert found.value == pytest.approx(3 * plain.number - 1)
    assert found.error == pytest.approx(3 * plain.standard_error, rel=1e-4)
    square = function_of_means(lambda m: m**2, series)
    assert square.error == pytest.approx(2 * plain.number * plain.standard_error, rel=1e-4)


def test_function_of_means_of_several_runs() -> None:
    random = np.random.default_rng(16)
    a = [1 + random.normal(size=n) for n in (500, 300)]
    b = [run + 0.0 for run in a]
    found = function_of_means(lambda p, q: p - q, a, b)
    assert (found.value, found.error) == pytest.approx((0.0, 0.0), abs=1e-12)
    with pytest.raises(ValueError, match="the same lengths"):
        function_of_means(lambda p, q: p - q, a, b[:1])


def test_what_is_no_series() -> None:
    assert mean([]) == Estimate(None, None, "no samples")
    assert mean([3.0]) == Estimate(3.0, None, "one sample has no error")
    constant = mean([0.1] * 100)
    assert (constant.value, constant.error) == pytest.approx((0.1, 0.0))
    assert ratio([1.0, 2.0], [0.0, 0.0]) == Estimate(None, None, "the denominator is zero")
    assert correlation_time([1.0]).reason == "1 samples are too few"
    assert correlation_time([1.0] * 9).reason == "all samples are the same"
    with pytest.raises(ValueError, match="not finite"):
        mean([1.0, math.nan])
    with pytest.raises(ValueError, match="one-dimensional"):
        mean(np.zeros((2, 3, 4)))


def test_few_samples_have_their_plain_error_as_a_lower_bound() -> None:
    # 0, 1, 0, 1, 0 about 2/5: variance 0.3 of each, 0.06 of the mean
    estimate = mean(np.arange(5) % 2)
    assert (estimate.value, estimate.error) == pytest.approx((0.4, math.sqrt(0.06)))
    assert estimate.reason == "lower bound: run longer, 5 samples are too few"
    assert estimate.freedom == 4


def test_ramp_is_no_mean() -> None:
    assert (mean(np.linspace(0.0, 1.0, 1000)).reason or "").startswith(
        "lower bound: run longer, at least "
    )

import math

import numpy as np
import pytest
from scipy.optimize import curve_fit

from analysis.estimate import Estimate
from analysis.line_fit import fit_polynomial, fit_runs, weighted_mean


def test_line_through_two_points_by_hand() -> None:
    # slope (5 - 3)/2 = 1, its error sqrt(0.3^2 + 0.4^2)/2; intercept 3 with the error of y(0)
    fit = fit_polynomial([0.0, 2.0], [Estimate(3.0, 0.3), Estimate(5.0, 0.4, "short")])
    assert (fit.slope.value, fit.slope.error) == pytest.approx((1.0, 0.25))
    assert (fit.intercept.value, fit.intercept.error) == pytest.approx((3.0, 0.3))
    assert fit.slope.reason == "short"


@pytest.mark.parametrize(("scatter", "enlarged"), [(0.1, False), (5.0, True)])
def test_errors_are_those_of_scipy(scatter: float, enlarged: bool) -> None:
    random = np.random.default_rng(1)
    x, error = np.linspace(1e-3, 0.1, 9), random.uniform(0.1, 0.5, 9)
    y = 2 - 30 * x + 400 * x**2 + scatter * error * random.normal(size=9)
    points = [Estimate(value, e) for value, e in zip(y, error, strict=True)]
    coefficients = fit_polynomial(x, points, degree=2).coefficients
    best, covariance = curve_fit(
        lambda x, a, b, c: a + b * x + c * x**2, x, y, sigma=error, absolute_sigma=not enlarged
    )
    assert [e.value for e in coefficients] == pytest.approx(best, rel=1e-5)
    assert [e.error for e in coefficients] == pytest.approx(np.sqrt(np.diag(covariance)), rel=1e-5)


def test_chi_squared_of_a_line_by_hand() -> None:
    # one mean of 1, 3 and 5 with errors 2: deviations of one error on either side
    y = [Estimate(value, 2.0) for value in (1.0, 3.0, 5.0)]
    flat = fit_polynomial([0.0, 1.0, 2.0], y, degree=0)
    assert (flat.coefficients[0].value, flat.chi_squared, flat.freedom) == pytest.approx((3, 2, 2))
    line = fit_polynomial([0.0, 1.0, 2.0], y)
    assert line([0.0, 4.0]) == pytest.approx([1.0, 9.0])
    assert line.chi_squared == pytest.approx(0.0, abs=1e-20)
    assert flat.quality == "chi^2 = 2.0 for 2 degrees of freedom"


def test_freedom_of_a_slope() -> None:
    # the slope of two points is their difference: two equal variances with 4 each have 8
    fit = fit_polynomial([0.0, 1.0], [Estimate(1.0, 0.1, freedom=4), Estimate(2.0, 0.1, freedom=4)])
    assert fit.slope.freedom == pytest.approx(8.0)
    assert fit.intercept.freedom == pytest.approx(4.0)
    exact = fit_polynomial([0.0, 1.0], [Estimate(1.0, 0.1), Estimate(2.0, 0.1)])
    assert exact.slope.freedom == math.inf


def test_lines_of_runs_by_hand() -> None:
    # slopes 1 and 3, intercepts 0 and 2: means 2 and 1, errors |difference| / 2
    intercept, slope = fit_runs([0.0, 1.0, 2.0], [[0.0, 1.0, 2.0], [2.0, 5.0, 8.0]])
    assert (slope.value, slope.error, slope.freedom) == pytest.approx((2.0, 1.0, 1.0))
    assert (intercept.value, intercept.error) == pytest.approx((1.0, 1.0))
    lone = fit_runs([0.0, 1.0], [0.0, 4.0])
    assert lone[1].value == pytest.approx(4.0)
    assert lone[1].error is None


def test_mean_weighted_by_errors_by_hand() -> None:
    mean = weighted_mean([Estimate(1.0, 1.0), Estimate(6.0, 0.5)])  # weights 1 and 4
    assert (mean.value, mean.error) == pytest.approx((5.0, 1 / np.sqrt(5)))
    # Meier: shares 0.2 and 0.8, 1 + 4 (0.16/4 + 0.16/4)
    poor = weighted_mean([Estimate(1.0, 1.0, freedom=4), Estimate(6.0, 0.5, freedom=4)])
    assert poor.error == pytest.approx(math.sqrt(1.32 / 5))


def test_weighted_mean_of_poor_errors_is_covered() -> None:
    random = np.random.default_rng(2)
    hits, trials = 0, 1000
    for _ in range(trials):
        errors = np.sqrt(random.chisquare(6, size=5) / 6)
        mean = weighted_mean([Estimate(random.normal(), e, freedom=6) for e in errors])
        hits += abs(mean.deviation(0.0)) < 1.96
    # Meier's correction is of first order in 1/freedom: with 6 the intervals are a little short
    assert 0.89 < hits / trials < 0.97


@pytest.mark.parametrize(
    ("x", "error"),
    [([1.0, 1.0], [0.1, 0.1]), ([1.0, 2.0], [0.1, 0.0]), ([1.0, 2.0], [0.1, None])],
)
def test_what_determines_no_line(x: list[float], error: list[float]) -> None:
    with pytest.raises(ValueError, match=r"points|error"):
        fit_polynomial(x, [Estimate(0.0, error[0]), Estimate(1.0, error[1])])


def test_mean_needs_errors() -> None:
    with pytest.raises(ValueError, match="error"):
        weighted_mean([Estimate(1.0, None, "one sample has no error")])
    with pytest.raises(ValueError, match="needs an estimate"):
        weighted_mean([])

import numpy as np
import pytest
from scipy.optimize import curve_fit

from analysis.blocking import Estimate
from analysis.line_fit import fit_polynomial, weighted_mean


def test_line_through_two_points_by_hand() -> None:
    # slope (5 - 3)/2 = 1, its error sqrt(0.3^2 + 0.4^2)/2; intercept 3 with the error of y(0)
    intercept, slope = fit_polynomial([0.0, 2.0], [3.0, 5.0], [0.3, 0.4])
    assert (slope.value, slope.error) == pytest.approx((1.0, 0.25))
    assert (intercept.value, intercept.error) == pytest.approx((3.0, 0.3))


@pytest.mark.parametrize(("scatter", "enlarged"), [(0.1, False), (5.0, True)])
def test_errors_are_those_of_scipy(scatter: float, enlarged: bool) -> None:
    random = np.random.default_rng(1)
    x, error = np.linspace(1e-3, 0.1, 9), random.uniform(0.1, 0.5, 9)
    y = 2 - 30 * x + 400 * x**2 + scatter * error * random.normal(size=9)
    found = fit_polynomial(x, y, error, degree=2)
    best, covariance = curve_fit(
        lambda x, a, b, c: a + b * x + c * x**2, x, y, sigma=error, absolute_sigma=not enlarged
    )
    assert [e.value for e in found] == pytest.approx(best, rel=1e-5)
    assert [e.error for e in found] == pytest.approx(np.sqrt(np.diag(covariance)), rel=1e-5)


def test_mean_weighted_by_errors_by_hand() -> None:
    mean = weighted_mean([Estimate(1.0, 1.0), Estimate(6.0, 0.5)])  # weights 1 and 4
    assert (mean.value, mean.error) == pytest.approx((5.0, 1 / np.sqrt(5)))


@pytest.mark.parametrize(
    ("x", "error"),
    [([1.0, 1.0], [0.1, 0.1]), ([1.0, 2.0], [0.1, 0.0]), ([1.0, 2.0], [0.1, np.nan])],
)
def test_what_determines_no_line(x: list[float], error: list[float]) -> None:
    with pytest.raises(ValueError, match=r"points|error"):
        fit_polynomial(x, [0.0, 1.0], error)


def test_mean_needs_errors() -> None:
    with pytest.raises(ValueError, match="error"):
        weighted_mean([Estimate(1.0, None, "one sample has no error")])

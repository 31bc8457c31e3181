"""Straight lines and parabolas through measured points, weighted by their errors."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from analysis.blocking import Estimate


def fit_polynomial(x: ArrayLike, y: ArrayLike, error: ArrayLike, degree: int = 1) -> list[Estimate]:
    """Weighted least squares of independent points.

    Where the points scatter about the fit more than their errors say, chi^2 per degree of freedom
    above 1, the errors of the coefficients are enlarged by its square root (Birge's ratio): errors
    of points are too small where a run is short for its slowest motion.

    Args:
        x: (n,).
        y: measured at x, (n,).
        error: standard errors of y, positive, (n,).
        degree: of the polynomial; needs degree + 1 different x.

    Returns:
        coefficients of 1, x, x^2, ..., (degree + 1,), with their standard errors.

    Raises:
        ValueError: for too few points or errors that are not positive.
    """
    places, values, errors = (np.asarray(a, dtype=float) for a in (x, y, error))
    if len(np.unique(places)) <= degree:
        raise ValueError(f"{len(places)} points do not determine a polynomial of degree {degree}")
    if not (np.isfinite(errors).all() and (errors > 0).all()):
        raise ValueError("every point needs a positive error")
    powers = np.arange(degree + 1)
    scale = np.abs(places).max() ** powers  # so that the columns are of one size
    design = (places[:, None] ** powers / scale) / errors[:, None]
    inverse = np.linalg.pinv(design)
    coefficients = inverse @ (values / errors) / scale
    deviations = np.sqrt((inverse**2).sum(axis=1)) / scale
    freedom = len(places) - degree - 1
    if freedom > 0:
        residuals = (values - places[:, None] ** powers @ coefficients) / errors
        deviations *= max(1.0, float(np.sqrt(residuals @ residuals / freedom)))
    return [Estimate(float(c), float(d)) for c, d in zip(coefficients, deviations, strict=True)]


def weighted_mean(estimates: Sequence[Estimate]) -> Estimate:
    """Mean of independent estimates of one number, weighted by their errors.

    Raises:
        ValueError: for none, or an error that is missing or not positive.
    """
    values = [estimate.value for estimate in estimates]
    errors = [estimate.error for estimate in estimates]
    if not values or not all(error and error > 0 for error in errors):
        raise ValueError("every estimate needs a positive error")
    weights = 1 / np.array(errors, dtype=float) ** 2
    mean = float(weights @ np.array(values, dtype=float) / weights.sum())
    return Estimate(mean, float(1 / np.sqrt(weights.sum())))

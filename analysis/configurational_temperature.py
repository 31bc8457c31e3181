"""Configurational temperature from series of its two sums (delhommelle-2005, 4)."""

from analysis.arrays import Array
from analysis.correlated_mean import mean
from analysis.estimate import Estimate


def ratio_of_means(numerator: Array, denominator: Array) -> Estimate:
    """<a> / <b> of two correlated series, with the error of a - R b over <b>.

    Args:
        numerator: a, (T,).
        denominator: b, (T,), of a mean that is not zero.

    Raises:
        ValueError: when the mean of the denominator is zero.
    """
    bottom = float(denominator.mean())
    if bottom == 0:
        raise ValueError("the mean of the denominator is zero")
    ratio = float(numerator.mean()) / bottom
    scatter = mean((numerator - ratio * denominator) / bottom)
    return Estimate(ratio, scatter.error, scatter.reason)


def configurational_temperature(force_squares: Array, laplacians: Array) -> Estimate:
    """T_conf = <sum F_i^2> / <sum Laplacian_i>, a ratio of means as printed.

    Args:
        force_squares: sum over particles of the squared force of the potential, (T,).
        laplacians: sum over particles of the Laplacian of the potential energy, (T,).
    """
    return ratio_of_means(force_squares, laplacians)

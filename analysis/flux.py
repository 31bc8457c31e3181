"""Current of settling colloids J(rho) = rho v(rho), and the ASEP form of the thesis (5.1-5.3)."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from analysis.blocking import Estimate
from analysis.line_fit import fit_polynomial

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PolynomialFit:
    """A weighted fit and how well it holds.

    Attributes:
        coefficients: of 1, x, x^2, ... with their errors.
        chi_squared: sum over points of ((measured - fitted) / error)^2.
        freedom: points less coefficients.
    """

    coefficients: tuple[Estimate, ...]
    chi_squared: float
    freedom: int

    def __call__(self, x: ArrayLike) -> Array:
        """The polynomial at x, same shape."""
        values = [float(c.value or 0.0) for c in self.coefficients]
        return np.asarray(np.polynomial.polynomial.polyval(np.asarray(x, dtype=float), values))

    @property
    def quality(self) -> str:
        """`chi^2 = 3.1 for 4 degrees of freedom`."""
        return f"chi^2 = {self.chi_squared:.1f} for {self.freedom} degrees of freedom"


def fit_quality(x: ArrayLike, y: Sequence[Estimate], degree: int = 1) -> PolynomialFit:
    """Polynomial through measured points, with chi^2.

    Args:
        x: (n,).
        y: measured there, each with a positive error, (n,).
        degree: of the polynomial.

    Raises:
        ValueError: as `fit_polynomial`.
    """
    values = np.array([one.value for one in y], dtype=float)
    errors = np.array([one.error for one in y], dtype=float)
    coefficients = tuple(fit_polynomial(x, values, errors, degree))
    fit = PolynomialFit(coefficients, 0.0, len(values) - degree - 1)
    chi_squared = float((((values - fit(x)) / errors) ** 2).sum())
    return PolynomialFit(coefficients, chi_squared, fit.freedom)


def current(density: float, speed: Estimate) -> Estimate:
    """J = rho v [1/(a0 t0)]."""
    return speed.scaled(density)


@dataclass(frozen=True)
class AsepForm:
    """J = (p - q) rho (1 - rho / rho_full), (5.1) in the units of the channel.

    Attributes:
        bias: p - q [a0/t0]; negative: the holes of the ASEP run along +x.
        full: density at which the current vanishes again, rho of a full lattice [1/a0^2].
    """

    bias: float
    full: float

    def current(self, density: ArrayLike) -> Array:
        """J(rho), same shape [1/(a0 t0)]."""
        rho = np.asarray(density, dtype=float)
        return np.asarray(self.bias * rho * (1 - rho / self.full))


def asep_form(slope: float, intercept: float, frame: float) -> AsepForm:
    """The ASEP that (5.3) is: J = rho (c rho + c' - V) in a frame that moves at V.

    Printed with p = c/(v_cm - c'); right is J = -(V - c') rho (1 - c rho/(V - c')): p - q = c' - V
    and rho_full = (V - c')/c. For V > c' the bias is negative, J is convex in every frame, and its
    shocks have the high density on the left, as at the head of a chain that falls along +x.

    Args:
        slope, intercept: c [a0^3/t0] and c' [a0/t0] of v = c rho + c' at rest.
        frame: V, not c' [a0/t0].
    """
    return AsepForm(intercept - frame, (frame - intercept) / slope)

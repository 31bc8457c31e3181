"""Gear's fourth-order predictor-corrector, with which delhommelle-2005 integrates (II).

C. W. Gear, Numerical Initial Value Problems in Ordinary Differential Equations (1971): dy/dt = f(y)
with the scaled derivatives dt^k y^(k) / k!, k = 0 to 4, predicted by their Taylor series and
corrected by the one evaluation of f.
"""

import math
from collections.abc import Callable

import numpy as np

from lammps_inputs.system import Array

CORRECTION = np.array([251 / 720, 1, 11 / 12, 1 / 3, 1 / 24])
PASCAL = np.array([[math.comb(k, j) for k in range(5)] for j in range(5)], dtype=float)


class Gear:
    """y(t) of dy/dt = f(y), one evaluation a step.

    Args:
        slope: f.
        start: y(0), (n,).
        dt: the step.
    """

    def __init__(self, slope: Callable[[Array], Array], start: Array, dt: float) -> None:
        self.slope, self.dt = slope, dt
        self.series = self._begin(start)

    @property
    def y(self) -> Array:
        """The solution now, (n,)."""
        return np.asarray(self.series[0])

    def step(self) -> None:
        """Predict, evaluate, correct."""
        predicted = PASCAL @ self.series
        error = self.dt * self.slope(predicted[0]) - predicted[1]
        self.series = predicted + CORRECTION[:, None] * error

    def _begin(self, start: Array) -> Array:
        """Derivatives from slopes at -2, -1, 0, 1, 2 steps, which Runge-Kutta finds."""
        slopes = {0: self.slope(start)}
        for direction in (-1, 1):
            y = start
            for count in (1, 2):
                y = runge_kutta(self.slope, y, direction * self.dt)
                slopes[direction * count] = self.slope(y)
        s = {k: self.dt * v for k, v in slopes.items()}
        second = (s[-2] - 8 * s[-1] + 8 * s[1] - s[2]) / 12
        third = (-s[-2] + 16 * s[-1] - 30 * s[0] + 16 * s[1] - s[2]) / 12
        fourth = (-s[-2] + 2 * s[-1] - 2 * s[1] + s[2]) / 2
        return np.array([start, s[0], second / 2, third / 6, fourth / 24])


def runge_kutta(slope: Callable[[Array], Array], y: Array, dt: float) -> Array:
    """y(t + dt) by the classical method of fourth order."""
    a = slope(y)
    b = slope(y + dt / 2 * a)
    c = slope(y + dt / 2 * b)
    d = slope(y + dt * c)
    return y + dt / 6 * (a + 2 * b + 2 * c + d)

"""Viscosity from the decay of a shear wave v_x = A(t) sin(2 pi y / L_y) in a periodic fluid."""

import math

import numpy as np
from scipy.linalg import cholesky_banded, solve_banded
from scipy.optimize import minimize_scalar

from analysis.arrays import Array
from analysis.estimate import Estimate
from analysis.flow import momentum_profile

MIN_INTERVALS = 10  # below, the likelihood is no parabola and its curvature no error


def wave_amplitude(y: Array, width: float, counts: Array, velocity: Array) -> Array:
    """Amplitude A of sin(2 pi y / L_y) in each interval, from bin averages.

    Args:
        y: centres of equal bins that fill the width, (bins,) [a0].
        width: L_y [a0].
        counts: particles in each bin, (K, bins).
        velocity: their mean velocity along x, (K, bins) [a0/t0].

    Returns:
        (K,) [a0/t0].
    """
    # the mean of sin(ky) over a bin of width h is sin(ky) at its centre times sinc(kh/2)
    wave = np.sin(2 * np.pi * y / width) * np.sinc((y[1] - y[0]) / width)
    return np.asarray(momentum_profile(counts, velocity) @ wave / (wave @ wave))


def decay_viscosity(amplitude: Array, interval: float, samples: int, width: float) -> Estimate:
    """Kinematic viscosity nu = gamma / k^2, k = 2 pi / L_y, of a decaying wave.

    Linearised fluctuating hydrodynamics: A obeys dA/dt = -gamma A + white noise, so wave and
    thermal noise decay at one rate, and A at the samples is an AR(1) process with factor
    exp(-gamma dt). Of its means over intervals, D_n = A_(n+1) - exp(-gamma interval) A_n no longer
    holds the wave and is Gaussian noise correlated with D_(n+-1) only. gamma has the greatest
    likelihood of all D_n, their noise strength eliminated; its error is the likelihood's
    curvature, with as many degrees of freedom as there are D_n, less one for the strength. The
    whole record counts, also where the wave is lost in noise.

    Args:
        amplitude: means over consecutive sampling intervals, (K,) [a0/t0].
        interval: the sampling interval [t0].
        samples: evenly spaced samples in each mean, at least 1.
        width: L_y [a0].

    Returns:
        nu [a0^2/t0]; no value for too few intervals or a rate that they do not resolve.
    """
    count = len(amplitude)
    if count < MIN_INTERVALS:
        return Estimate(None, None, f"{count} intervals are too few; {MIN_INTERVALS} are needed")

    def cost(log_rate: float) -> float:
        return _minus_log_likelihood(math.exp(log_rate), amplitude, interval, samples)

    slowest, fastest = math.log(0.05 / (count * interval)), math.log(5 / interval)
    best = float(minimize_scalar(cost, bounds=(slowest, fastest), method="bounded").x)
    step = 0.01
    curvature = (cost(best + step) - 2 * cost(best) + cost(best - step)) / step**2
    if min(best - slowest, fastest - best) < step or curvature <= 0:
        return Estimate(None, None, "the decay is not resolved by the sampled times")
    viscosity = math.exp(best) * (width / (2 * math.pi)) ** 2
    return Estimate(viscosity, viscosity / math.sqrt(curvature), None, count - 2)


def _minus_log_likelihood(rate: float, amplitude: Array, interval: float, samples: int) -> float:
    decay = math.exp(-rate * interval)
    sample_decay = decay ** (1 / samples)
    # autocovariance of means over `samples` points of a stationary AR(1) process of variance 1
    lags = np.arange(1, samples)
    variance = (samples + 2 * float(((samples - lags) * sample_decay**lags).sum())) / samples**2
    block = float((sample_decay ** np.arange(samples)).mean())
    first = sample_decay * block**2
    second = first * decay
    # D_n = A_(n+1) - decay A_n: covariance tridiagonal, of these two numbers
    diagonal = variance * (1 + decay**2) - 2 * decay * first
    neighbour = first * (1 + decay**2) - decay * (variance + second)
    noise = amplitude[1:] - decay * amplitude[:-1]
    covariance = np.empty((2, len(noise)))
    covariance[0], covariance[1] = neighbour, diagonal
    factor = cholesky_banded(covariance)
    lower = np.array([factor[1], np.append(factor[0, 1:], 0.0)])
    white = solve_banded((1, 0), lower, noise)
    log_determinant = 2 * float(np.log(factor[1]).sum())
    return 0.5 * (len(noise) * math.log(float(white @ white)) + log_determinant)

"""Matrix-product stationary state of the open ASEP, as independent truth up to L of order 10^3.

Weights of configurations are <W| X_1 ... X_L |V> with X = D on a particle and E on a vacancy, where
D E - (q/p) E D = D + E, <W|(alpha E - gamma D) = p <W|, (beta D - delta E)|V> = p |V>.  Here D and
E act as the tridiagonal matrices of Uchiyama, Sasamoto and Wadati (J. Phys. A 37, 4985 (2004)), in
the basis where <W| and |V> are the first unit vector: L sites need only the first L + 1 rows.

Nothing is shared with `lattice.generator`: no vector of configurations appears.
"""

from __future__ import annotations

import math

import numpy as np

from lattice.models import RateError, Vector


def _kappa(rate_in: float, rate_out: float, q: float) -> tuple[float, float]:
    """Roots kappa+ >= 0 and kappa- in (-1, 0] of `rate_in` x^2 - (1-q-in+out) x - out = 0."""
    middle = 1 - q - rate_in + rate_out
    root = math.sqrt(middle**2 + 4 * rate_in * rate_out)
    return (middle + root) / (2 * rate_in), (middle - root) / (2 * rate_in)


class _Algebra:
    """Tridiagonal D and E, first `size` rows: diagonals, upper and lower neighbours."""

    def __init__(self, q: float, ends: tuple[float, float, float, float], size: int) -> None:
        alpha, beta, gamma, delta = ends
        (a, c), (b, d) = _kappa(alpha, gamma, q), _kappa(beta, delta, q)
        n = np.arange(size)
        product = a * b * c * d
        with np.errstate(under="ignore"):
            qn = q ** n.astype(float)  # 0**0 = 1: the TASEP is the limit q -> 0
            before = np.concatenate([[1.0], qn[:-1]])  # q^(n-1), unused at n = 0
            squared = qn * qn
        outer = np.concatenate([[1.0], 1 - before[1:] * qn[1:] * product])  # 1 - q^(2n-1) abcd
        even = 1 - squared * product
        if min(np.abs(outer).min(), np.abs(even).min(), abs(1 - q * product)) < 1e-12:
            raise RateError(
                "alpha beta = q^n gamma delta: the matrix-product representation is singular"
            )

        def diagonal(b: float, d: float, a: float, c: float) -> Vector:
            s, t = b + d, b * d * (a + c)
            values = (
                before
                / ((1 - before**2 * product) * even)
                * (
                    t
                    + s * q
                    - product * s * before
                    - (t + product * s) * qn
                    - t * q * qn
                    + product * t * before * qn
                    + product * s * squared
                )
            )
            values[0] = (s - t) / (1 - product)
            return np.asarray(values)

        coupling = (1 - q * qn) / (even**2 * (1 - q * squared * product) * outer)
        coupling[1:] *= 1 - before[1:] * product
        for x in (a * b, a * c, a * d, b * c, b * d, c * d):
            coupling *= 1 - qn * x
        up, low = 1 / (1 - qn * a * c), coupling / (1 - qn * b * d)
        self.d = (1 + diagonal(b, d, a, c), up, -qn * b * d * low)
        self.e = (1 + diagonal(a, c, b, d), -qn * a * c * up, low)

    @staticmethod
    def times(matrix: tuple[Vector, Vector, Vector], vector: Vector) -> Vector:
        """Matrix |vector>."""
        diagonal, upper, lower = matrix
        result = diagonal * vector
        result[:-1] += upper[:-1] * vector[1:]
        result[1:] += lower[:-1] * vector[:-1]
        return np.asarray(result)

    @classmethod
    def after(cls, vector: Vector, matrix: tuple[Vector, Vector, Vector]) -> Vector:
        """<vector| matrix."""
        diagonal, upper, lower = matrix
        return cls.times((diagonal, lower, upper), vector)


def asep_stationary(
    sites: int,
    p: float,
    q: float,
    alpha: float,
    beta: float,
    gamma: float = 0.0,
    delta: float = 0.0,
) -> tuple[float, Vector]:
    """Exact stationary current (to the right) and density profile, shape (L,), of the open ASEP.

    Arguments as in `lattice.models.asep`; L = `sites`, cost O(L^2).  J = p Z_{L-1}/Z_L and
    <n_k> = <W|C^{k-1} D C^{L-k}|V>/Z_L with C = D + E, Z_L = <W|C^L|V>.
    Raises `RateError` for p = q, where this representation does not exist, for alpha or beta zero,
    and in the singular cases alpha beta = q^n gamma delta.
    """
    rates = {"p": p, "q": q, "alpha": alpha, "beta": beta, "gamma": gamma, "delta": delta}
    for name, rate in rates.items():
        if not (math.isfinite(rate) and rate >= 0):
            raise RateError(f"rate {name} = {rate}: must be finite and not negative")
    if p == q:
        raise RateError("p = q: the symmetric process has no such representation")
    if q > p:  # seen in a mirror
        current, profile = asep_stationary(sites, q, p, delta, gamma, beta, alpha)
        return -current, profile[::-1]
    if alpha == 0 or beta == 0:
        raise RateError("alpha and beta must be positive")
    ends = (alpha / p, beta / p, gamma / p, delta / p)
    algebra = _Algebra(q / p, ends, sites + 1)
    total = tuple(x + y for x, y in zip(algebra.d, algebra.e, strict=True))
    assert len(total) == 3
    first = np.zeros(sites + 1)
    first[0] = 1.0
    # C^j |V>, each rescaled to unit norm; the scales enter only the current
    rights, scales = [first], []
    for _ in range(sites):
        vector = algebra.times(total, rights[-1])
        scales.append(float(np.linalg.norm(vector)))
        rights.append(vector / scales[-1])
    ratio = rights[sites - 1][0] / (rights[sites][0] * scales[-1])  # Z_{L-1}/Z_L, C in (1-q) units
    profile = np.empty(sites)
    left = first
    for k in range(sites):
        ahead = rights[sites - k - 1]
        particle = left @ algebra.times(algebra.d, ahead)
        vacancy = left @ algebra.times(algebra.e, ahead)
        profile[k] = particle / (particle + vacancy)
        left = algebra.after(left, total)
        left = left / np.linalg.norm(left)
    return float(p * (1 - q / p) * ratio), profile

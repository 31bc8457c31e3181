"""Completing a partial set of rates to a model whose shock random-walks.

For given fugacities and a given ratio r or c, every condition of `lattice.shocks` is linear in the
rates, in the field D of (2.30), in d1 and d2 and in the end rates: stationarity in both phases, the
nine bond equations (2.71), the ends (2.31, 2.32) and, if wanted, the closure at k = 0 and k = L.
Whether nonnegative rates exist is therefore a linear programme, and its answer is exact.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.optimize import linprog

from lattice.models import (
    BULK_NAMES,
    FUGACITY_POWER,
    LEFT_NAMES,
    PT_RATES,
    RIGHT_NAMES,
    STATES,
    TRANSITIONS,
    LatticeGas,
    RateError,
    Vector,
    charge_gas,
    checked_rates,
    generator_matrix,
    internal_state_gas,
)


class NoNonnegativeRates(RateError):
    """No nonnegative rates complete the given ones to a shock that random-walks."""


@dataclass(frozen=True)
class ShockModel:
    """Rates by name, as in a FILE, of a model on the shock manifold for the fugacities z1, z2."""

    family: Literal["charge", "internal-state"]
    rates: dict[str, float]
    left: dict[str, float]
    right: dict[str, float]
    z1: float
    z2: float

    def gas(self) -> LatticeGas:
        """The model these rates define."""
        build = charge_gas if self.family == "charge" else internal_state_gas
        return build(self.rates, self.left, self.right)


def complete_shock(
    family: Literal["charge", "internal-state"],
    z1: float,
    z2: float,
    rates: Mapping[str, float],
    left: Mapping[str, float] | None = None,
    right: Mapping[str, float] | None = None,
    ratio: float | None = None,
    ends: bool = True,
) -> ShockModel:
    """Complete some rates to a model in which the shock z1 | z2 random-walks (2.62).

    Rates named in `rates`, `left` and `right` keep their value; the others are chosen nonnegative,
    as many as possible of them positive up to the largest given rate (1 if none is given).  With
    `ends` the shock closes at k = 0 and k = L too.  `ratio` is r of (2.25) or c of (2.81); the
    two-sided charge shock fixes it at X/(1+X)^2, X = z2/z1 (2.174), and c may stand in `rates`.
    If `rates` names h1.., r1.. or c the completion is PT invariant, with w.. it need not be.

    Raises `NoNonnegativeRates` if no choice exists, `RateError` on bad rates or a missing ratio,
    `ArithmeticError` where a choice at the edge of existence cannot be told from none.
    """
    if not (np.isfinite([z1, z2]).all() and min(z1, z2) >= 0 and z1 != z2):
        raise RateError(f"fugacities z1 = {z1}, z2 = {z2}: must be nonnegative and different")
    bulk = {name: float(value) for name, value in rates.items() if name != "c"}
    ratio = _ratio(family, z1, z2, rates, ratio)
    pt = family == "internal-state" and not any(name[:1] == "w" for name in bulk)
    names = tuple(PT_RATES) if pt else BULK_NAMES[family]
    given = {
        **{name: checked_rates(bulk, names, family)[name] for name in bulk},
        **{name: checked_rates(left or {}, LEFT_NAMES, family)[name] for name in left or {}},
        **{name: checked_rates(right or {}, RIGHT_NAMES, family)[name] for name in right or {}},
    }
    solution = _solve(_Equations(family, names, ratio, z1, z2, ends), given)
    if solution is None:
        raise NoNonnegativeRates(
            f"no nonnegative rates complete the given ones to a {family} shock with z1 = {z1}, "
            f"z2 = {z2}, {'r' if family == 'charge' else 'c'} = {ratio:.6g}"
            + (" that closes at the ends" if ends else "")
        )
    return ShockModel(
        family,
        {name: solution[name] for name in names}
        | ({"c": ratio} if family == "internal-state" else {}),
        {name: solution[name] for name in LEFT_NAMES},
        {name: solution[name] for name in RIGHT_NAMES},
        z1,
        z2,
    )


def _ratio(
    family: str, z1: float, z2: float, rates: Mapping[str, float], ratio: float | None
) -> float:
    if family == "internal-state":
        ratio = rates.get("c", ratio)
        if ratio is None:
            raise RateError("c, the ratio of B to A (2.81), is missing")
    elif z1 > 0 and z2 > 0:
        forced = z1 * z2 / (z1 + z2) ** 2
        if ratio is not None and abs(ratio - forced) > 1e-12:
            raise RateError(f"r = {ratio}: the two-sided shock needs r = {forced} (2.174)")
        ratio = forced
    elif ratio is None:
        raise RateError("the one-sided shock leaves r of (2.25) free: give ratio")
    if not (np.isfinite(ratio) and ratio > 0):
        raise RateError(f"ratio {ratio}: must be positive")
    return float(ratio)


class _Equations:
    """The conditions as a homogeneous linear map of (rates, D, d1, d2, end rates)."""

    def __init__(
        self,
        family: Literal["charge", "internal-state"],
        names: tuple[str, ...],
        ratio: float,
        z1: float,
        z2: float,
        ends: bool,
    ) -> None:
        self.bulk_names, self.ends, self.ratio = names, ends, ratio
        self.rate_names = (*names, *LEFT_NAMES, *RIGHT_NAMES)
        self.size = len(STATES[family])
        powers = np.array(FUGACITY_POWER[family])
        weights = [np.array([1.0, 1.0, ratio]) * z**powers for z in (z1, z2)]
        self.first, self.second = (w / w.sum() for w in weights)
        self.vacant = STATES[family].index("0")
        # after the rates: D of the two particle states, then d1, d2, e0, eL
        self.width = len(self.rate_names) + 2 + 4

    def matrix(self) -> Vector:
        """Coefficients, shape (equations, unknowns)."""
        return np.column_stack([self._residuals(unit) for unit in np.eye(self.width)])

    def _residuals(self, unknowns: Vector) -> Vector:
        rate = dict(zip(self.rate_names, unknowns, strict=False))
        d_a, d_b, d1, d2, e0, el = unknowns[len(self.rate_names) :]
        field = np.insert([d_a, d_b], self.vacant, 0.0)
        bulk = generator_matrix(self.size**2, self._pairs(rate))
        left = generator_matrix(self.size, self._end(rate, "alpha", "gamma"))
        right = generator_matrix(self.size, self._end(rate, "delta", "beta"))
        one, two = self.first, self.second
        telescoping = np.subtract.outer(field, field).ravel()
        rows = [bulk @ np.kron(p, p) - telescoping * np.kron(p, p) for p in (one, two)]
        here = np.kron(one, two)
        rows.append(
            bulk @ here
            - (telescoping - field @ one + field @ two) * here
            - d1 * (np.kron(two, two) - here)
            - d2 * (np.kron(one, one) - here)
        )
        rows.append(left @ one + (field - field @ one) * one)
        rows.append(right @ two - (field - field @ two) * two)
        if self.ends:
            rows.append(left @ two + (field - field @ two) * two - e0 * (one - two))
            rows.append(right @ one - (field - field @ one) * one - el * (two - one))
        return np.concatenate(rows)

    def _pairs(self, rate: Mapping[str, float]) -> dict[tuple[int, int], float]:
        pairs: dict[tuple[int, int], float] = {}
        for name in self.bulk_names:
            for w, power in PT_RATES.get(name, ((name, 0),)):
                pairs[int(w[1]) - 1, int(w[2]) - 1] = rate[name] * self.ratio**power
        return pairs

    @staticmethod
    def _end(rate: Mapping[str, float], into: str, out: str) -> dict[tuple[int, int], float]:
        moves = {}
        for number, (final, initial) in TRANSITIONS.items():
            moves[final, initial] = rate[into + number]
            moves[initial, final] = rate[out + number]
        return moves


def _solve(equations: _Equations, given: Mapping[str, float]) -> dict[str, float] | None:
    """Nonnegative solution with as many positive rates as possible, or None."""
    matrix, names = equations.matrix(), equations.rate_names
    count, width = len(names), equations.width
    cap = max([*given.values(), 0.0]) or 1.0
    # maximise sum(s), 0 <= s <= cap, s <= rate: spreads the rates instead of leaving most at zero
    fields = [(None, None)] * 2
    bounds = [(given.get(n, 0.0), given.get(n)) for n in names] + fields + [(0, None)] * 4
    bounds += [(0, cap)] * count
    spread = np.hstack([-np.eye(count), np.zeros((count, 6)), np.eye(count)])
    result = linprog(
        np.concatenate([np.zeros(width), -np.ones(count)]),
        A_ub=spread,
        b_ub=np.zeros(count),
        A_eq=np.hstack([matrix, np.zeros((len(matrix), count))]),
        b_eq=np.zeros(len(matrix)),
        bounds=bounds,
        method="highs",
    )
    if result.status == 2:  # infeasible
        return None
    if not result.success:
        raise RuntimeError(f"linear programme: {result.message}")
    unknowns = np.array(result.x, dtype=float)[:width]
    # the programme is solved to 1e-7; put the unknowns that are free and not at a bound on the
    # equations to rounding
    fixed = np.array([n in given for n in names] + [False] * 6)
    unknowns[:count] = [given.get(n, u) for n, u in zip(names, unknowns[:count], strict=True)]
    fields_at = np.arange(count, count + 2)
    at_zero = unknowns < 1e-6 * cap
    at_zero[fields_at] = False
    unknowns[at_zero & ~fixed] = 0.0
    free = ~(fixed | at_zero)
    for _ in range(2):
        unknowns[free] -= np.linalg.lstsq(matrix[:, free], matrix @ unknowns, rcond=1e-12)[0]
    unknowns[:count][np.abs(unknowns[:count]) < 1e-13 * cap] = 0.0
    if np.abs(matrix @ unknowns).max() > 1e-11 * cap or unknowns[:count].min() < 0:
        raise ArithmeticError("rates exist, but could not be computed to rounding")
    return {name: float(value) for name, value in zip(names, unknowns, strict=False)}

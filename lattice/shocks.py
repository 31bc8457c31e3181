"""Shock measures: is the product measure stationary, does the shock random-walk, at which rates.

A shock measure |k> has fugacity z1 on sites 1..k and z2 on k+1..L, (2.61) or (2.97).  On special
manifolds of rates it evolves into other shock measures only,

    d|k>/dt = d1 |k-1> + d2 |k+1> - (d1 + d2) |k>,                                        (2.62)

so that the shock position is a random walk hopping left at d1 and right at d2, for all times.
Whether it does is decided locally.  In the product measure P of one fugacity the bond generator
must telescope, W (P x P) = (D_k - D_{k+1}) (P x P) (2.30), with a one-site field D = F n^A + F' n^B
(2.33, 2.34), or -E n^A - E' n^B (2.93).  The boundaries must absorb what is left at the ends, which
is (2.38)-(2.41) or (2.95)-(2.96), and what remains of W|k> acts on the shock's own bond: nine
equations (2.71) for d1 and d2.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.polynomial import Polynomial
from scipy.linalg import expm
from scipy.optimize import nnls

from lattice import generator
from lattice.models import FUGACITY_POWER, LatticeGas, RateError, Vector

Side = Literal["left", "right"]

#: A condition holds if its residual is below this fraction of the largest rate: rounding of rates
#: given with 15 digits, times the few hundred operations of a full generator.
HOLDS = 1e-10
#: Boundary rates that miss the stated fugacity by more than this fraction contradict it.
CONTRADICTS = 1e-6


@dataclass(frozen=True)
class Condition:
    """One equation a model must satisfy: `residual` is left minus right side, as a rate."""

    equation: str
    statement: str
    residual: float


def divergence_field(model: LatticeGas) -> Vector:
    """Field D by state, shape (s,), of W (P x P) = (D_k - D_{k+1}) (P x P), zero when vacant.

    (F, 0, F') of (2.33, 2.34) or (0, -E, -E') of (2.93), read off the pairs of a particle and a
    vacancy, where it does not depend on the fugacity.
    """
    marginal = model.marginal(1.0)
    pair = np.kron(marginal, marginal)
    flow = (model.bulk @ pair).reshape(model.size, model.size)
    vacant = model.states.index("0")
    field = np.zeros(model.size)
    present = marginal > 0
    field[present] = flow[present, vacant] / (marginal[present] * marginal[vacant])
    return field


def bond_residual(model: LatticeGas, z: float) -> Vector:
    """Nine residuals of (2.30) or (2.92) on a bond in the product measure of z, shape (s^2,)."""
    marginal, field = model.marginal(z), divergence_field(model)
    pair = np.kron(marginal, marginal)
    telescoping = np.subtract.outer(field, field).ravel()
    return np.asarray(model.bulk @ pair - telescoping * pair)


def end_residual(model: LatticeGas, z: float, side: Side) -> Vector:
    """Residual of (2.31), (2.32), (2.98) or (2.99) at one end, by state, shape (s,)."""
    matrix = model.left if side == "left" else model.right
    if matrix is None:
        raise RateError("a periodic chain has no ends")
    marginal, field = model.marginal(z), divergence_field(model)
    flow = (field - field @ marginal) * marginal
    return np.asarray(matrix @ marginal + (flow if side == "left" else -flow))


def boundary_fugacity(model: LatticeGas, side: Side) -> float:
    """The fugacity that the boundary rates hold: common root of (2.38, 2.39) or their like.

    Zero, which any end holds that brings in nothing else, is taken only if it is the only one.
    Raises `RateError` where the rates are inconsistent (no common root) or leave it open (several).
    """
    matrix = model.left if side == "left" else model.right
    if matrix is None:
        raise RateError("a periodic chain has no ends: give z1")
    sign = 1.0 if side == "left" else -1.0
    field = divergence_field(model)
    z = Polynomial([0.0, 1.0])
    weights = [a * z**n for a, n in zip(model.prefactor, FUGACITY_POWER[model.family], strict=True)]
    nu = sum(weights[1:], weights[0])
    mean = sum((d * w for d, w in zip(field, weights, strict=True)), 0 * z)
    roots: list[float] = []
    for state in range(model.size):
        inflow = sum((m * w for m, w in zip(matrix[state], weights, strict=True)), 0 * z)
        equation = inflow * nu + sign * (field[state] * nu - mean) * weights[state]
        equation = equation.trim(1e-14 * model.scale)
        candidates = [] if equation.degree() == 0 else list(equation.roots())
        roots += [
            max(float(c.real), 0.0)
            for c in candidates
            if abs(c.imag) < 1e-6 * (1 + abs(c)) and c.real > -1e-9
        ]
    good = sorted(
        root
        for root in roots
        if np.abs(end_residual(model, root, side)).max() < CONTRADICTS * model.scale
    )
    if not good:
        raise RateError(
            f"inconsistent boundaries: no fugacity solves the conditions of the {side} end"
        )
    good = [root for root in good if root > CONTRADICTS] or good
    if good[-1] - good[0] > 1e-3 * (1 + good[0]):
        raise RateError(
            f"the {side} boundary rates are consistent with several fugacities ({good[0]:.6g}, "
            f"{good[-1]:.6g}): give z{1 if side == 'left' else 2}"
        )
    return good[int(np.argmin([np.abs(end_residual(model, g, side)).max() for g in good]))]


def stationarity_conditions(model: LatticeGas, z1: float, z2: float) -> list[Condition]:
    """Conditions for the product measures of z1 (left end) and z2 (right end) to be stationary."""
    conditions = _bulk_conditions(model)
    if model.periodic:
        return conditions
    equations: dict[str, dict[Side, tuple[str, ...]]] = {
        "charge": {"left": ("2.38", "2.39"), "right": ("2.40", "2.41")},
        "internal-state": {"left": ("2.95", "2.96"), "right": ("2.95", "2.96")},
        "asep": {"left": ("2.95",), "right": ("2.95",)},
    }
    ends: tuple[tuple[Side, float], ...] = (("left", z1), ("right", z2))
    for side, z in ends:
        residual = end_residual(model, z, side)
        for state, equation in zip((0, 2), equations[model.family][side], strict=False):
            statement = f"{side} end keeps the density of {model.states[state]} at z = {z:.6g}"
            conditions.append(Condition(equation, statement, float(residual[state])))
    return conditions


def _bulk_conditions(model: LatticeGas) -> list[Condition]:
    w = model.w
    if model.family == "asep":
        return []
    if model.family == "charge":
        if model.ratio == 0:
            return []
        driving = w(2, 4) - w(4, 2) + w(6, 8) - w(8, 6) + w(7, 3) - w(3, 7)
        reaction = (w(3, 5) * w(5, 7) - w(5, 3) * w(7, 5)) / (w(3, 5) + w(7, 5))
        return [
            Condition(
                "2.36",
                "w24 - w42 + w68 - w86 + w73 - w37 = (w35 w57 - w53 w75)/(w35 + w75)",
                driving - reaction,
            )
        ]
    c = model.ratio
    e = w(2, 4) + w(3, 4) + w(7, 4) - w(4, 2) - c * (w(4, 3) + w(4, 7))
    e_left = w(2, 4) + c * (w(2, 3) + w(2, 7)) - w(4, 2) - w(3, 2) - w(7, 2)
    balance = c * (w(5, 6) + w(5, 8)) + c**2 * w(5, 9) - w(6, 5) - w(8, 5) - w(9, 5)
    conditions = [
        Condition("2.85", "E is the same from pairs A0 and 0A", e - e_left),
        Condition("2.85", "AA is made as often as it reacts", balance),
    ]
    if c > 0:
        ep = w(3, 7) + w(2, 7) + w(4, 7) - w(7, 3) - (w(7, 2) + w(7, 4)) / c
        ep_left = w(3, 7) + (w(3, 2) + w(3, 4)) / c - w(7, 3) - w(2, 3) - w(4, 3)
        ab = w(8, 6) + w(5, 6) + w(9, 6) - w(6, 8) - c * w(6, 9) - w(6, 5) / c
        ba = w(6, 8) + w(5, 8) + w(9, 8) - w(8, 6) - c * w(8, 9) - w(8, 5) / c
        conditions += [
            Condition("2.85", "E' is the same from pairs B0 and 0B", ep - ep_left),
            Condition("2.94", "AB is made as often as it reacts", ab - (e - ep)),
            Condition("2.94", "BA is made as often as it reacts", ba + (e - ep)),
        ]
    return conditions


def random_walk_conditions(model: LatticeGas, z1: float, z2: float) -> list[Condition]:
    """Conditions on the bulk rates, besides stationarity, for the shock z1 | z2 to random-walk.

    Charge family: the one-sided shock (2.72)-(2.75) where a fugacity vanishes, else the two-sided
    one, (2.165)-(2.174) with (2.173) corrected.  Internal-state family: (2.109)-(2.111).
    """
    w = model.w
    if model.family == "charge" and model.ratio > 0:
        if z2 == 0:
            return [
                *(Condition("2.74", f"w{i}{j} = 0", w(i, j)) for i, j in ((2, 4), (3, 7), (5, 7))),
                Condition("2.75", "w86 = w68", w(8, 6) - w(6, 8)),
            ]
        if z1 == 0:
            return [
                *(
                    Condition("2.74, mirrored", f"w{i}{j} = 0", w(i, j))
                    for i, j in ((4, 2), (7, 3), (5, 3))
                ),
                Condition("2.75", "w86 = w68", w(8, 6) - w(6, 8)),
            ]
        p, q, r, x = w(2, 4), w(4, 2), model.ratio, z2 / z1
        scale = w(5, 3) + w(5, 7)
        return [
            Condition("2.165", "w24 = w68", p - w(6, 8)),
            Condition("2.166", "w42 = w86", q - w(8, 6)),
            Condition("2.167", "w24 = X^2 w42, X = z2/z1", p - x**2 * q),
            Condition("2.174", "w35 + w75 = X/(1+X)^2 (w53 + w57)", scale * (r - x / (1 + x) ** 2)),
            Condition("2.171", "w37 = w24 - (1+X) w35", w(3, 7) - p + (1 + x) * w(3, 5)),
            Condition("2.172", "w73 = w42 - (1+X) w75/X", w(7, 3) - q + (1 + x) * w(7, 5) / x),
            Condition(
                "2.173 corrected",
                "w57 = X w53 + w42 (X-1)(1+X)^2",
                w(5, 7) - x * w(5, 3) - q * (x - 1) * (1 + x) ** 2,
            ),
        ]
    p, q = _exchange_rates(model, "A")
    conditions = [Condition("2.111", "p z1 = q z2", p * z1 - q * z2)]
    if model.family == "internal-state" and model.ratio > 0:
        pb, qb = _exchange_rates(model, "B")
        conditions += [
            Condition("2.109", "h3 + c r4 = h6 + r4", p - pb),
            Condition("2.110", "h1 + c r2 = h2 + r2", q - qb),
        ]
    return conditions


def _exchange_rates(model: LatticeGas, species: str) -> tuple[float, float]:
    """p of (2.109) and q of (2.110) for one species; the bare hops in an ASEP.

    Written for 24 free rates: the rate at which 0A (0B) is made from A0 and B0 in the product
    measure, and the mirror image, which PT invariance (2.85) turns into the printed sums.
    """
    w, c = model.w, model.ratio
    if model.family == "asep":
        return w(2, 3), w(3, 2)
    if model.family == "charge":  # without B the vacancies are the particles of fugacity z
        return w(2, 4), w(4, 2)
    if species == "A":
        return w(2, 4) + c * w(2, 7), w(4, 2) + c * w(4, 3)
    return w(3, 7) + w(3, 4) / c, w(7, 3) + w(7, 2) / c


def hopping_rates(model: LatticeGas, z1: float, z2: float) -> tuple[float, float]:
    """Hopping rates (d1 left, d2 right) of the shock from the nine bond equations (2.71).

    Exact where they can be solved, which gives (2.73), (2.112), (2.113), (2.169), (2.170); the
    nonnegative least-squares solution elsewhere.  Raises `RateError` for z1 = z2.
    """
    if z1 == z2:
        raise RateError(f"z1 = z2 = {z1}: there is no shock")
    first, second, field = model.marginal(z1), model.marginal(z2), divergence_field(model)
    here = np.kron(first, second)
    gap = field @ first - field @ second  # g2 - g1
    flow = model.bulk @ here - (np.subtract.outer(field, field).ravel() - gap) * here
    moves = np.column_stack([np.kron(second, second) - here, np.kron(first, first) - here])
    rates, _ = nnls(moves, flow)
    rates[rates < 1e-13 * model.scale] = 0.0  # rounding: a one-sided shock has a rate that is zero
    return float(rates[0]), float(rates[1])


def end_rates(model: LatticeGas, z1: float, z2: float) -> tuple[float, float]:
    """Rates of the shock leaving the ends, (0 -> 1, L -> L-1), by projection on one site.

    Exact where the shock closes at the ends: W|0> = e0 (|1> - |0>), W|L> = eL (|L-1> - |L>).
    Raises `RateError` for z1 = z2 or a periodic chain.
    """
    if z1 == z2:
        raise RateError(f"z1 = z2 = {z1}: there is no shock")
    step = model.marginal(z1) - model.marginal(z2)
    entering = end_residual(model, z2, "left") @ step / (step @ step)
    leaving = -end_residual(model, z1, "right") @ step / (step @ step)
    return max(float(entering), 0.0), max(float(leaving), 0.0)


@dataclass(frozen=True)
class ShockWalk:
    """Random walk of the shock position on 0..L: interior rates and those of leaving the ends."""

    sites: int
    hop_left: float
    hop_right: float
    enter: float
    leave: float

    @property
    def velocity(self) -> float:
        """Mean velocity far from the ends, positive to the right: d2 - d1 (2.76, 2.115 negated)."""
        return self.hop_right - self.hop_left

    @property
    def diffusion(self) -> float:
        """Diffusion coefficient (d1 + d2)/2 far from the ends (2.76, 2.116)."""
        return (self.hop_left + self.hop_right) / 2

    def _rates(self) -> tuple[Vector, Vector]:
        right = np.full(self.sites, self.hop_right)  # k -> k+1 for k = 0..L-1
        left = np.full(self.sites, self.hop_left)  # k+1 -> k
        right[0], left[-1] = self.enter, self.leave
        return right, left

    def matrix(self) -> Vector:
        """Generator on positions 0..L, shape (L+1, L+1), columns = initial position."""
        right, left = self._rates()
        matrix = np.diag(right, -1) + np.diag(left, 1)
        return np.asarray(matrix - np.diag(matrix.sum(axis=0)))

    def stationary_mixture(self) -> Vector:
        """Weights of the |k> in the stationary state, shape (L+1,).

        Detailed balance: pi_{k+1}/pi_k = rate(k -> k+1)/rate(k+1 -> k), which is (d2/d1)^k in the
        interior ((2.117) is printed upside down).  Raises `RateError` if it is not unique.
        """
        right, left = self._rates()
        up_only = np.flatnonzero((left == 0) & (right > 0))
        down_only = np.flatnonzero((right == 0) & (left > 0))
        first = int(up_only.max()) + 1 if up_only.size else 0  # positions below are left for good
        last = int(down_only.min()) if down_only.size else self.sites  # and those above
        if first > last or ((left == 0) & (right == 0)).any():
            raise RateError("the shock can rest at more than one place: no unique mixture")
        steps = np.log(right[first:last]) - np.log(left[first:last])
        logarithm = np.concatenate([[0.0], np.cumsum(steps)])
        weights = np.zeros(self.sites + 1)
        weights[first : last + 1] = np.exp(logarithm - logarithm.max())
        return np.asarray(weights / weights.sum())

    def distribution(self, start: int, time: float) -> Vector:
        """Probability of each position at `time` from position `start`, shape (L+1,)."""
        chances: Vector = np.asarray(expm(self.matrix() * time)[:, start])
        if not abs(chances.sum() - 1) < CONTRADICTS:
            raise ValueError(f"time {time:g}: too long against the shock's rates to be exact")
        return chances

    def mean_position(self, start: int, time: float) -> float:
        """Mean shock position at `time` from position `start`, ends included."""
        return float(np.arange(self.sites + 1) @ self.distribution(start, time))


def shock_marginals(model: LatticeGas, sites: int, position: int, z1: float, z2: float) -> Vector:
    """Single-site probabilities of |k>, k = `position`, shape (L, s) (2.61, 2.97)."""
    if not 0 <= position <= sites:
        raise ValueError(f"shock position {position}: must lie in 0..{sites}")
    left = np.arange(1, sites + 1)[:, None] <= position
    return np.where(left, model.marginal(z1), model.marginal(z2))


def shock_vector(model: LatticeGas, sites: int, position: int, z1: float, z2: float) -> Vector:
    """The shock measure |k> as a vector of all configurations, shape (s^L,)."""
    return generator.product_vector(shock_marginals(model, sites, position, z1, z2))


def stationarity_residual(model: LatticeGas, sites: int, z1: float, z2: float) -> float:
    """Residual of the product measures on the full generator, as a fraction of the largest rate.

    For z1 with the left end, and for z2 with the right end, the 1-norm of W|P> less what the far
    end, which may hold another fugacity, contributes; the larger of the two.  With z1 = z2 it
    vanishes exactly if W|P> = 0 (2.22).  Raises `generator.TooLarge`.
    """
    largest = 0.0
    generator.require_vectors(4, model, sites)
    ends: tuple[tuple[float, Side], ...] = ((z1, "right"), (z2, "left"))
    for z, far in ends:
        marginal = model.marginal(z)
        measure = generator.product_vector([marginal] * sites)
        flow = generator.apply(model, sites, measure)
        if not model.periodic:
            others = generator.product_vector([marginal] * (sites - 1))
            excess = end_residual(model, z, far)
            flow -= np.kron(others, excess) if far == "right" else np.kron(excess, others)
        largest = max(largest, float(np.abs(flow).sum()))
    return largest / model.scale


def random_walk_residuals(model: LatticeGas, sites: int, z1: float, z2: float) -> Vector:
    """Residual of (2.62) for each shock position 0..L on the full generator, shape (L+1,).

    1-norm of W|k> - d1|k-1> - d2|k+1> + (d1+d2)|k> as a fraction of the largest rate, with
    `hopping_rates`; at k = 0 and L with `end_rates`.  Raises `RateError`, `generator.TooLarge`.
    """
    d1, d2 = hopping_rates(model, z1, z2)
    e0, el = end_rates(model, z1, z2)
    generator.require_vectors(6, model, sites)
    residuals = np.empty(sites + 1)
    for k in range(sites + 1):
        here = shock_vector(model, sites, k, z1, z2)
        rest = generator.apply(model, sites, here)
        left, right = (0.0 if k == 0 else d1, e0 if k == 0 else d2)
        if k == sites:
            left, right = el, 0.0
        for rate, target in ((left, k - 1), (right, k + 1)):
            if rate:
                rest -= rate * (shock_vector(model, sites, target, z1, z2) - here)
        residuals[k] = np.abs(rest).sum()
    return residuals / model.scale


def closes(residuals: Vector) -> bool:
    """Whether the shock random-walks at both ends too, from `random_walk_residuals`."""
    return bool(max(residuals[0], residuals[-1]) < HOLDS)


def equimolar_position(model: LatticeGas, sites: int, state: Vector, z1: float, z2: float) -> float:
    """Shock position at which |k> holds as much of the conserved quantity as `state` does.

    Equals the mean of k in every mixture of shock measures, and stays defined when the state is
    none.  Raises `RateError` if both sides have the same density.
    """
    left, right = model.density(z1), model.density(z2)
    if left == right:
        raise RateError("equal densities on both sides: no shock position")
    total = float(generator.site_probabilities(model, sites, state).sum(axis=0) @ model.conserved)
    return (total - sites * right) / (left - right)

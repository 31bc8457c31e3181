"""Three-state exclusion processes with one local conservation law.

A model is a nearest-neighbour Markov process on a chain whose sites are in one of a few states
(Tabatabaei 2009, section 2.2).  A pair of neighbouring sites (n, n') has the number i = 3n + n' + 1
(2.1), and `w[i, j]` is the rate at which pair j becomes pair i.  Requiring that the dynamics
conserve sum_k C(n_k) (2.4) leaves two families:

- **charge** (section 2.3): states 0, 1, 2 are A, vacant, B with C = 1, 0, -1 and ten rates.  The
  same ten rates describe the diffusion of up to two particles on a site (state = number of
  particles) and, with A and vacant exchanged, cracking B -> 2A: see `READINGS`.
- **internal-state** (section 2.4): states 0, 1, 2 are vacant, A, B with C = 0, 1, 1 and 24 rates;
  PT invariance leaves h1..h6, r1..r9 and the ratio c (2.86).

The single-species ASEP, with states 0, 1 = vacant, particle, is the special case all are checked
against.

Rates are in units of an inverse time of the user's choice, lengths in lattice sites.  Each
generator acts on column vectors of probabilities: the column is the initial state, columns add up
to zero, and d|P>/dt = W|P> (so W = -H of the paper).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Family = Literal["charge", "internal-state", "asep"]
Vector = NDArray[np.float64]

STATES: dict[Family, tuple[str, ...]] = {
    "charge": ("A", "0", "B"),
    "internal-state": ("0", "A", "B"),
    "asep": ("0", "A"),
}
CONSERVED: dict[Family, tuple[float, ...]] = {
    "charge": (1.0, 0.0, -1.0),
    "internal-state": (0.0, 1.0, 1.0),
    "asep": (0.0, 1.0),
}
#: Power of the fugacity that weighs each state in the product measure, (2.25) and (2.88).
FUGACITY_POWER: dict[Family, tuple[int, ...]] = {
    "charge": (0, 1, 2),
    "internal-state": (0, 1, 1),
    "asep": (0, 1),
}
#: What states 0, 1, 2 of the charge family mean in its three readings, (2.5), (2.7) and (2.9).
READINGS = {
    "charge": ("A (charge +1)", "vacant", "B (charge -1)"),
    "diffusion": ("no particle", "one particle", "two particles"),
    "cracking": ("vacant", "A (mass 1)", "B (mass 2)"),
}

BULK_NAMES: dict[Family, tuple[str, ...]] = {
    "charge": ("w24", "w42", "w37", "w73", "w86", "w68", "w35", "w53", "w57", "w75"),
    "internal-state": (
        *("w42", "w24", "w73", "w37", "w86", "w68", "w47", "w32", "w43", "w72", "w74", "w23"),
        *("w27", "w34", "w58", "w65", "w56", "w85", "w59", "w95", "w89", "w96", "w69", "w98"),
    ),
    "asep": ("w32", "w23"),  # right and left hop; pairs 1..4 are 00, 0A, A0, AA
}
#: PT-invariant internal-state rates: name -> [(w, power of c)], (2.86) with w85 = c r6.
PT_RATES: dict[str, tuple[tuple[str, int], ...]] = {
    **{
        f"r{i}": ((f"w{a}", 0), (f"w{b}", 1))
        for i, a, b in (
            (1, 47, 32),
            (2, 43, 72),
            (3, 23, 74),
            (4, 27, 34),
            (5, 58, 65),
            (6, 56, 85),
            (8, 89, 96),
            (9, 69, 98),
        )
    },
    "r7": (("w59", 0), ("w95", 2)),
    **{f"h{i}": ((f"w{a}", 0),) for i, a in ((1, 42), (2, 73), (3, 24), (4, 86), (5, 68), (6, 37))},
}
#: Boundary rates as (final, initial) state: number 1 is 0 -> 1, 2 is 0 -> 2, 3 is 1 -> 2 (2.2).
TRANSITIONS = {"1": (1, 0), "2": (2, 0), "3": (2, 1)}
LEFT_NAMES = tuple(f"{side}{i}" for side in ("alpha", "gamma") for i in TRANSITIONS)
RIGHT_NAMES = tuple(f"{side}{i}" for side in ("delta", "beta") for i in TRANSITIONS)


class RateError(ValueError):
    """Rates that do not define a model; the message names the rate, its value and the rule."""


def pair_label(number: int, family: Family) -> str:
    """The two states of pair `number` (2.1) as text, such as "A0"."""
    states = STATES[family]
    first, second = divmod(number - 1, len(states))
    return states[first] + states[second]


def checked_rates(
    rates: Mapping[str, float], allowed: tuple[str, ...], family: Family
) -> dict[str, float]:
    """Nonnegative finite rates by name, with zero for the names left out."""
    for name, value in rates.items():
        if name not in allowed:
            raise RateError(_unknown(name, allowed, family))
        if isinstance(value, bool) or not isinstance(value, (int, float, np.number)):
            raise RateError(f"rate {name} = {value!r}: must be a number")
        if not math.isfinite(value):
            raise RateError(f"rate {name} = {value}: must be finite")
        if value < 0:
            raise RateError(f"rate {name} = {value}: must not be negative")
    return {name: float(rates.get(name, 0.0)) for name in allowed}


def _unknown(name: str, allowed: tuple[str, ...], family: Family) -> str:
    count = len(STATES[family]) ** 2
    digits = name[1:]
    if name[:1] == "w" and len(digits) == 2 and digits.isdigit():
        final, initial = int(digits[0]), int(digits[1])
        if final != initial and {final, initial} <= set(range(1, count + 1)):
            before, after = pair_label(initial, family), pair_label(final, family)
            return (
                f"rate {name} ({before} -> {after}) breaks the conservation law (2.4) of the "
                f"{family} family"
            )
    return f"unknown rate {name!r}; the {family} family has {', '.join(allowed)}"


def generator_matrix(size: int, rates: Mapping[tuple[int, int], float]) -> Vector:
    """Generator of a process with `size` states from rates keyed by (final, initial), 0-based."""
    matrix = np.zeros((size, size))
    for (final, initial), rate in rates.items():
        matrix[final, initial] += rate
    matrix -= np.diag(matrix.sum(axis=0))
    return matrix


def bulk_matrix(family: Family, rates: Mapping[str, float]) -> Vector:
    """Generator of one bond, -h of (2.29) or (2.87), from rates w by name.

    Returns an array of shape (s^2, s^2), s the number of states of a site; raises `RateError`.
    """
    w = checked_rates(rates, BULK_NAMES[family], family)
    return generator_matrix(
        len(STATES[family]) ** 2,
        {(int(name[1]) - 1, int(name[2]) - 1): rate for name, rate in w.items()},
    )


def boundary_matrix(
    family: Family, rates: Mapping[str, float], side: Literal["left", "right"]
) -> Vector:
    """Generator of one boundary site, -b1 of (2.18) or -bL of (2.19) with its misprint corrected.

    Entry (3, 2) of (2.19) is printed beta3; it is delta3, or the columns do not add up to zero.
    Returns an array of shape (s, s); raises `RateError`.
    """
    forward, backward = ("alpha", "gamma") if side == "left" else ("delta", "beta")
    names = LEFT_NAMES if side == "left" else RIGHT_NAMES
    if family == "asep":
        names = (forward + "1", backward + "1")
    checked = checked_rates(rates, names, family)
    moves: dict[tuple[int, int], float] = {}
    for number, (final, initial) in TRANSITIONS.items():
        if forward + number in checked:
            moves[final, initial] = checked[forward + number]
            moves[initial, final] = checked[backward + number]
    return generator_matrix(len(STATES[family]), moves)


@dataclass(frozen=True)
class LatticeGas:
    """A nearest-neighbour exclusion process: one bond generator and, if open, two boundary ones.

    Attributes: `bulk` of shape (s^2, s^2); `left` and `right` of shape (s, s), both None for a
    periodic chain; `prefactor` of shape (s,), so that the product measure of fugacity z gives state
    n the weight prefactor[n] z**power[n]: (1, z, r z^2) (2.25), (1, z, c z) (2.88) or (1, z).
    """

    family: Family
    bulk: Vector
    left: Vector | None
    right: Vector | None
    prefactor: Vector

    @property
    def states(self) -> tuple[str, ...]:
        """Names of the states of a site, by number."""
        return STATES[self.family]

    @property
    def size(self) -> int:
        """Number s of states of a site."""
        return len(self.states)

    @property
    def conserved(self) -> Vector:
        """Conserved quantity C(n) by state (2.4): the charge, or the particle number."""
        return np.array(CONSERVED[self.family])

    @property
    def periodic(self) -> bool:
        """Whether the chain is a ring."""
        return self.left is None

    @property
    def ratio(self) -> float:
        """The constant r of (2.25) or c of (2.81); zero for the ASEP."""
        return float(self.prefactor[2]) if self.size == 3 else 0.0

    @property
    def scale(self) -> float:
        """Largest rate of the model, which residuals are compared with."""
        matrices = [m for m in (self.bulk, self.left, self.right) if m is not None]
        return max(float(np.abs(m - np.diag(np.diag(m))).max()) for m in matrices)

    def w(self, final: int, initial: int) -> float:
        """Rate of the pair transition `initial` -> `final`, numbered from 1 as in (2.1)."""
        return float(self.bulk[final - 1, initial - 1])

    def marginal(self, z: float) -> Vector:
        """Single-site probabilities, shape (s,), of the product measure of fugacity z >= 0."""
        if not (math.isfinite(z) and z >= 0):
            raise RateError(f"fugacity z = {z}: must be finite and not negative")
        weights = self.prefactor * float(z) ** np.array(FUGACITY_POWER[self.family])
        return np.asarray(weights / weights.sum())

    def density(self, z: float) -> float:
        """Mean of the conserved quantity per site: sigma (2.27) or rho (2.84)."""
        return float(self.conserved @ self.marginal(z))

    def bond_current(self) -> Vector:
        """Current of the conserved quantity by pair state, shape (s^2,), positive to the right.

        Entry j is the rate at which pair j carries C across the bond, so its expectation is j_k of
        (2.46) or (2.125).
        """
        left = np.repeat(self.conserved, self.size)  # C of the left site of each pair
        return np.asarray(-(left @ self.bulk))

    def current(self, z: float) -> float:
        """Current of C in the product measure of fugacity z: (2.47), (2.126).

        The stationary current where that measure is stationary, a mean-field one elsewhere.
        """
        marginal = self.marginal(z)
        return float(self.bond_current() @ np.kron(marginal, marginal))

    def with_reservoirs(self, z1: float, z2: float) -> LatticeGas:
        """The same bulk, open, between reservoirs of fugacity z1 (left) and z2 (right).

        Each end exchanges with a neighbour site that is always in the product measure, by the bulk
        rates.  Where that measure is stationary the ends satisfy (2.38)-(2.41) or (2.95)-(2.96) by
        construction, and a shock that random-walks closes there with e0 = d2 and eL = d1, so
        that (2.117), corrected, holds on 0..L.
        """
        blocks = self.bulk.reshape((self.size,) * 4)  # (left', right', left, right)
        left = np.einsum("abcd,c->bd", blocks, self.marginal(z1))
        right = np.einsum("abcd,d->ac", blocks, self.marginal(z2))
        return replace(self, left=left, right=right)


def _check_boundaries(left: object, right: object) -> None:
    if (left is None) != (right is None):
        missing, present = ("left", "right") if left is None else ("right", "left")
        raise RateError(
            f"inconsistent boundaries: rates given at the {present} end only; give {missing} too "
            "(zeros for a wall), or neither for a periodic chain"
        )


def _assemble(
    family: Family,
    bulk: Vector,
    left: Mapping[str, float] | None,
    right: Mapping[str, float] | None,
    prefactor: tuple[float, ...],
) -> LatticeGas:
    _check_boundaries(left, right)
    model = LatticeGas(
        family,
        bulk,
        None if left is None else boundary_matrix(family, left, "left"),
        None if right is None else boundary_matrix(family, right, "right"),
        np.array(prefactor),
    )
    if model.scale == 0:
        raise RateError("every rate is zero: nothing ever happens")
    return model


def charge_ratio(w: Mapping[str, float]) -> float:
    """The constant r = (w35 + w75) / (w53 + w57) (2.35) of the charge family.

    Zero where no pair 00 reacts to A and B.  Raises `RateError` where AB and BA never react but 00
    does: B then only accumulates, and no product measure with vacancies is stationary.
    """
    creation, annihilation = w["w35"] + w["w75"], w["w53"] + w["w57"]
    if creation == 0:
        return 0.0
    if annihilation == 0:
        raise RateError("w53 = w57 = 0 with w35 + w75 > 0: r of (2.35) is infinite")
    return creation / annihilation


def charge_gas(
    rates: Mapping[str, float],
    left: Mapping[str, float] | None = None,
    right: Mapping[str, float] | None = None,
) -> LatticeGas:
    """Model of the charge family (section 2.3), rates w24, w42, ... of (2.7) by name, default 0.

    `left` holds alpha1..3, gamma1..3 and `right` delta1..3, beta1..3 (2.18, 2.19); without both the
    chain is periodic.  Raises `RateError` on unknown names, on rates that are negative, not finite
    or off the conservation law, and where (2.35) has no solution.
    """
    w = checked_rates(rates, BULK_NAMES["charge"], "charge")
    ratio = charge_ratio(w)
    if ratio == 0:
        entering = [
            f"{side}{number}"
            for side, table in (("alpha", left), ("delta", right))
            for number in ("2", "3")
            if (table or {}).get(f"{side}{number}", 0.0) > 0
        ]
        if entering and w["w53"] + w["w57"] == 0:
            raise RateError(
                f"w35, w75, w53, w57 all zero while {', '.join(entering)} lets B in: A and B are "
                "conserved apart and r of (2.35) is not determined"
            )
    return _assemble("charge", bulk_matrix("charge", w), left, right, (1.0, 1.0, ratio))


def pt_rates(rates: Mapping[str, float]) -> tuple[dict[str, float], float]:
    """The 24 rates w and c from h1..h6, r1..r9, c (2.86); raises `RateError`."""
    given = checked_rates(rates, (*PT_RATES, "c"), "internal-state")
    if "c" not in rates:
        raise RateError("c, the ratio of B to A (2.81), is missing")
    c = given["c"]
    return {w: given[name] * c**power for name, ws in PT_RATES.items() for w, power in ws}, c


def internal_ratio(w: Mapping[str, float]) -> float:
    """Ratio c of B to A at which the conversions A <-> B balance in the product measure (2.88).

    Every order in z must balance by itself.  Beside a vacancy that is linear in c,
    w32 + w34 + w72 + w74 = c (w23 + w27 + w43 + w47); between particles it is the quadratic
    equation of AA -> AB, BA, BB and back.  (2.85) solves both; without PT invariance they are
    the condition on c.  Raises `RateError` where c is undetermined.
    """
    gain = w["w32"] + w["w34"] + w["w72"] + w["w74"]
    loss = w["w23"] + w["w27"] + w["w43"] + w["w47"]
    if loss > 0:
        return gain / loss
    # 2 w95 + w65 + w85 + c (w96 + w98 - w56 - w58) - c^2 (2 w59 + w69 + w89) = 0
    constant = 2 * w["w95"] + w["w65"] + w["w85"]
    linear = w["w96"] + w["w98"] - w["w56"] - w["w58"]
    square = 2 * w["w59"] + w["w69"] + w["w89"]
    if gain > 0 or (square == 0 and linear >= 0):
        raise RateError("c, the ratio of B to A (2.81), is not fixed by these rates: give c")
    if square == 0:
        return -constant / linear
    return (linear + math.sqrt(linear**2 + 4 * square * constant)) / (2 * square)


def internal_state_gas(
    rates: Mapping[str, float],
    left: Mapping[str, float] | None = None,
    right: Mapping[str, float] | None = None,
) -> LatticeGas:
    """Model of the internal-state family (section 2.4).

    `rates` holds either h1..h6, r1..r9 and c (PT invariant, 2.86) or the 24 rates w of (2.79) and,
    if these do not fix it, c; rates left out are zero.  Boundaries as in `charge_gas`.
    Raises `RateError`.
    """
    if any(name in PT_RATES for name in rates):
        mixed = [name for name in rates if name[:1] == "w"]
        if mixed:
            raise RateError(f"give either h1.., r1.., c or w.. rates, not both ({mixed[0]})")
        w, c = pt_rates(rates)
    else:
        allowed = (*BULK_NAMES["internal-state"], "c")
        w = checked_rates(rates, allowed, "internal-state")
        c = w.pop("c")
        if "c" not in rates:
            c = internal_ratio(w)
    return _assemble("internal-state", bulk_matrix("internal-state", w), left, right, (1.0, 1.0, c))


def asep(
    p: float,
    q: float,
    alpha: float | None = None,
    beta: float | None = None,
    gamma: float = 0.0,
    delta: float = 0.0,
) -> LatticeGas:
    """Single-species exclusion process: hops right at p and left at q.

    Particles enter at alpha and leave at gamma on the left, leave at beta and enter at delta on the
    right; without alpha and beta the chain is periodic.  Raises `RateError`.
    """
    left = None if alpha is None else {"alpha1": alpha, "gamma1": gamma}
    right = None if beta is None else {"beta1": beta, "delta1": delta}
    return _assemble("asep", bulk_matrix("asep", {"w23": p, "w32": q}), left, right, (1.0, 1.0))

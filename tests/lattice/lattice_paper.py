"""Random models of chapter 2 in its own notation, and local operators on the full chain, for tests.

Everything here is written from the text, not from `lattice`: tests compare the two.
"""

from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from lattice.completion import complete_shock
from lattice.models import TRANSITIONS, LatticeGas, charge_gas, internal_state_gas

Array = NDArray[np.float64]

SIZES = range(2, 8)
TOLERANCE = 1e-13  # times the largest rate, as issue 4 asks


@dataclass
class Case:
    """A model with its rates by name; z, r (or c) and nu as in the text, phases 1 and 2."""

    w: dict[str, float]
    left: dict[str, float]
    right: dict[str, float]
    z1: float
    z2: float
    ratio: float
    gas: LatticeGas
    h: dict[str, float] = field(default_factory=dict)  # h1.., r1.. of the internal-state family

    def __getattr__(self, name: str) -> float:
        """Rates by name: case.w24, case.h1, case.alpha1."""
        for table in ("w", "left", "right", "h"):
            if name in self.__dict__.get(table, {}):
                return float(self.__dict__[table][name])
        raise AttributeError(name)

    @property
    def weights1(self) -> Array:
        return self._weights(self.z1)

    @property
    def weights2(self) -> Array:
        return self._weights(self.z2)

    def _weights(self, z: float) -> Array:
        third = self.ratio * (z**2 if self.gas.family == "charge" else z)
        return np.array([1.0, z, third])

    @property
    def nu1(self) -> float:
        return float(self.weights1.sum())

    @property
    def nu2(self) -> float:
        return float(self.weights2.sum())

    @property
    def bound(self) -> float:
        return TOLERANCE * self.gas.scale


def charge_drive(w: dict[str, float]) -> tuple[float, float]:
    """F and F' of (2.33), (2.34)."""
    return w["w24"] - w["w42"], w["w86"] - w["w68"]


def stationary_charge(seed: int = 1) -> Case:
    """Random charge model on (2.36) with ends that hold one fugacity, (2.38)-(2.41)."""
    rng = np.random.default_rng(seed)
    names = ("w24", "w42", "w37", "w86", "w68", "w35", "w53", "w57", "w75")
    w = {name: float(rng.uniform(0.5, 1.5)) for name in names}
    rhs = (w["w35"] * w["w57"] - w["w53"] * w["w75"]) / (w["w35"] + w["w75"])
    w["w73"] = w["w37"] - w["w24"] + w["w42"] - w["w68"] + w["w86"] + rhs
    if w["w73"] < 0:
        w["w37"], w["w73"] = w["w37"] - w["w73"] + 0.3, 0.3
    z, r = float(rng.uniform(0.5, 1.5)), (w["w35"] + w["w75"]) / (w["w53"] + w["w57"])
    nu, m = 1 + z + r * z**2, r * z**2
    f, fp = charge_drive(w)
    mean = (f + fp * m) / nu
    a1, a2, a3 = (float(x) for x in rng.uniform(3.0, 4.0, 3))
    g3 = float(rng.uniform(0.2, 0.4))
    # gain and loss of B, of A at the left end from b1|P> = (F n^A + F' n^B - mean)|P>
    g2 = (a2 + a3 * z + (fp - mean) * m) / m - g3
    g1 = (a1 + a2 - g2 * m - (f - mean)) / z
    d1, d2, d3, b3 = (float(x) for x in rng.uniform(3.0, 4.0, 4))
    b3 /= 10
    b2 = (d2 + d3 * z - (fp - mean) * m) / m - b3
    b1 = (d1 + d2 - b2 * m + (f - mean)) / z
    left = {"alpha1": a1, "alpha2": a2, "alpha3": a3, "gamma1": g1, "gamma2": g2, "gamma3": g3}
    right = {"delta1": d1, "delta2": d2, "delta3": d3, "beta1": b1, "beta2": b2, "beta3": b3}
    return Case(w, left, right, z, z, r, charge_gas(w, left, right))


def shock_charge(kind: str) -> Case:
    """Model with a one-sided or a two-sided shock, both closing at the ends."""
    left, right = {"alpha3": 0.2}, {"delta3": 0.3, "beta2": 0.4}
    if kind == "one-sided":
        model = complete_shock(
            "charge",
            0.8,
            0.0,
            {"w42": 1.1, "w53": 0.9, "w35": 0.3, "w75": 0.2, "w86": 0.4},
            ratio=0.5 / 0.9,
            left=left,
            right=right,
        )
    else:
        given = {"w42": 1.1, "w53": 0.4, "w35": 0.3}
        model = complete_shock("charge", 0.6, 0.84, given, left=left, right=right)
    rates = model.rates
    r = (rates["w35"] + rates["w75"]) / (rates["w53"] + rates["w57"])
    return Case(rates, model.left, model.right, model.z1, model.z2, r, model.gas())


def internal_rates(h: dict[str, float], c: float) -> dict[str, float]:
    """The 24 rates of (2.86), with w85 = c r6."""
    r = {i: h[f"r{i}"] for i in range(1, 10)}
    return {
        "w47": r[1],
        "w32": c * r[1],
        "w43": r[2],
        "w72": c * r[2],
        "w23": r[3],
        "w74": c * r[3],
        "w27": r[4],
        "w34": c * r[4],
        "w58": r[5],
        "w65": c * r[5],
        "w56": r[6],
        "w85": c * r[6],
        "w59": r[7],
        "w95": c**2 * r[7],
        "w89": r[8],
        "w96": c * r[8],
        "w69": r[9],
        "w98": c * r[9],
        "w42": h["h1"],
        "w73": h["h2"],
        "w24": h["h3"],
        "w86": h["h4"],
        "w68": h["h5"],
        "w37": h["h6"],
    }


def drive(h: dict[str, float], c: float) -> tuple[float, float]:
    """E and E' of (2.93)."""
    return (
        h["h3"] - h["h1"] + c * (h["r3"] + h["r4"] - h["r1"] - h["r2"]),
        h["h6"] - h["h2"] + h["r1"] + h["r4"] - h["r2"] - h["r3"],
    )


def stationary_internal(seed: int = 2) -> Case:
    """Random internal-state model on (2.94) with ends that hold one fugacity."""
    rng = np.random.default_rng(seed)
    names = [f"h{i}" for i in (1, 2, 3, 5, 6)] + [f"r{i}" for i in range(1, 10)]
    h = {name: float(rng.uniform(0.5, 1.5)) for name in names}
    c, z = (float(x) for x in rng.uniform(0.5, 1.5, 2))
    h["h4"] = -(
        h["h6"]
        - h["h2"]
        + h["h1"]
        - h["h3"]
        - h["h5"]
        + (1 + c) * (h["r1"] - h["r3"])
        + (1 - c) * (h["r4"] - h["r2"])
        + c * (h["r8"] - h["r9"])
        + h["r6"]
        - h["r5"]
    )
    if h["h4"] < 0:
        h["h5"], h["h4"] = h["h5"] - h["h4"] + 0.3, 0.3
    e, ep = drive(h, c)
    nu = 1 + z + c * z
    mean = (e + c * ep) * z / nu
    a1, a2, a3 = (float(x) for x in rng.uniform([3, 3, 1], [4, 4, 1.5]))
    g3 = float(rng.uniform(0.2, 0.4))
    # b1|P> = (-E n^A - E' n^B + mean)|P>, state B then state 0
    g2 = (a2 + a3 * z + (mean - ep) * c * z) / (c * z) - g3
    g1 = (a1 + a2 - mean - g2 * c * z) / z
    d1, d2, d3, b3 = (float(x) for x in rng.uniform([3, 3, 1, 0.3], [4, 4, 1.5, 0.4]))
    b2 = (d2 + d3 * z - (mean - ep) * c * z) / (c * z) - b3
    b1 = (d1 + d2 + mean - b2 * c * z) / z
    left = {"alpha1": a1, "alpha2": a2, "alpha3": a3, "gamma1": g1, "gamma2": g2, "gamma3": g3}
    right = {"delta1": d1, "delta2": d2, "delta3": d3, "beta1": b1, "beta2": b2, "beta3": b3}
    gas = internal_state_gas({**h, "c": c}, left, right)
    return Case(internal_rates(h, c), left, right, z, z, c, gas, h)


def shock_internal() -> Case:
    """Internal-state model with a shock that closes at the ends."""
    given = {
        "h1": 0.2,
        "r2": 0.3,
        "r4": 0.4,
        "r1": 0.3,
        "r3": 0.2,
        "r5": 0.2,
        "r6": 0.15,
        "r7": 0.1,
        "r8": 0.1,
        "r9": 0.2,
    }
    model = complete_shock(
        "internal-state",
        0.5,
        1.3,
        {**given, "c": 0.7},
        left={"alpha3": 0.2},
        right={"delta3": 0.3},
    )
    c = model.rates["c"]
    h = {name: rate for name, rate in model.rates.items() if name != "c"}
    return Case(
        internal_rates(h, c), model.left, model.right, model.z1, model.z2, c, model.gas(), h
    )


def pair_matrix(w: dict[str, float]) -> Array:
    """-h_{k,k+1}: w_ij takes pair j to pair i, (2.29) or (2.87)."""
    matrix = np.zeros((9, 9))
    for name, rate in w.items():
        i, j = int(name[1]), int(name[2])
        matrix[i - 1, j - 1] += rate
        matrix[j - 1, j - 1] -= rate
    return matrix


def end_matrix(case: Case, side: str) -> Array:
    """-b1 of (2.18) or -bL of (2.19), the latter with delta3 in row 3, column 2."""
    a, g = ("alpha", "gamma") if side == "left" else ("delta", "beta")
    a1, a2, a3 = (getattr(case, f"{a}{i}") for i in (1, 2, 3))
    g1, g2, g3 = (getattr(case, f"{g}{i}") for i in (1, 2, 3))
    return np.array([[-(a1 + a2), g1, g2], [a1, -(g1 + a3), g3], [a2, a3, -(g2 + g3)]])


def act(local: Array, first: int, sites: int, vector: Array) -> Array:
    """A local operator on site `first` (from 1) or on the bond (first, first + 1)."""
    before = np.eye(3 ** (first - 1))
    span = 1 if len(local) == 3 else 2
    after = np.eye(3 ** (sites - first + 1 - span))
    v = vector.reshape(len(before), len(local), len(after))
    return np.asarray(np.einsum("ij,ajb->aib", local, v).ravel())


def full_flow(case: Case, sites: int, vector: Array) -> Array:
    """-H|v> of (2.17), term by term."""
    flow = act(end_matrix(case, "left"), 1, sites, vector)
    flow += act(end_matrix(case, "right"), sites, sites, vector)
    for k in range(1, sites):
        flow += act(pair_matrix(case.w), k, sites, vector)
    return flow


def product(weights: list[Array]) -> Array:
    """Normalised tensor product, site 1 first."""
    vector = np.ones(1)
    for w in weights:
        vector = np.kron(vector, w / w.sum())
    return vector


def shock(case: Case, sites: int, k: int) -> Array:
    """|k> of (2.61) or (2.97)."""
    return product([case.weights1] * k + [case.weights2] * (sites - k))


def number(case: Case, species: str) -> Array:
    """n^A or n^B as a diagonal matrix on one site (2.130)."""
    return np.diag([float(state == species) for state in case.gas.states])


def random_distribution(sites: int, seed: int = 5) -> Array:
    """A distribution with correlations everywhere, of no special form."""
    vector = np.random.default_rng(seed).exponential(size=3**sites)
    return np.asarray(vector / vector.sum())


def mean(case: Case, sites: int, vector: Array, pattern: str, first: int) -> float:
    """<n^a_k n^b_{k+1} ...> for a pattern of states such as "A0", starting at site `first`."""
    table = vector.reshape((3,) * sites)
    index: list[slice | int] = [slice(None)] * sites
    for offset, state in enumerate(pattern):
        index[first - 1 + offset] = case.gas.states.index(state)
    return float(table[tuple(index)].sum())


def present(end: Array | None) -> Array:
    """The rates at an end of an open chain."""
    assert end is not None
    return end


def size_of(vector: Array) -> float:
    """1-norm: total probability per unit of time that a residual moves."""
    return float(np.abs(vector).sum())


def boundary_rates(gas: LatticeGas, side: Literal["left", "right"]) -> tuple[float, ...]:
    """(alpha1, alpha2, alpha3, gamma1, gamma2, gamma3), or delta and beta on the right."""
    matrix = gas.left if side == "left" else gas.right
    assert matrix is not None
    moves = [move for move in TRANSITIONS.values() if max(move) < gas.size]
    forward = [float(matrix[final, initial]) for final, initial in moves]
    return (*forward, *(float(matrix[initial, final]) for final, initial in moves))


def reflected(gas: LatticeGas) -> LatticeGas:
    """The same process seen in a mirror: left and right exchanged."""
    order = np.arange(gas.size**2).reshape(gas.size, gas.size).T.ravel()
    return replace(gas, bulk=gas.bulk[np.ix_(order, order)], left=gas.right, right=gas.left)

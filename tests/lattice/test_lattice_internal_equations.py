"""Every numbered statement of section 2.4 on the full generator, L = 2..7.

Names carry equation numbers; where the print is wrong the test shows the printed form fail.
"""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from lattice import generator, shocks
from lattice.models import BULK_NAMES, CONSERVED, Family, internal_state_gas, pair_label
from tests.lattice.lattice_paper import (
    SIZES,
    Case,
    act,
    drive,
    end_matrix,
    full_flow,
    internal_rates,
    mean,
    number,
    pair_matrix,
    product,
    random_distribution,
    shock,
    shock_internal,
    size_of,
    stationary_internal,
)

Array = NDArray[np.float64]

CASES = {"stationary": stationary_internal(2), "other": stationary_internal(5)}
WALKER = shock_internal()
P_Q = (
    WALKER.h["h3"] + WALKER.ratio * WALKER.h["r4"],
    WALKER.h["h1"] + WALKER.ratio * WALKER.h["r2"],
)
WRONG = 1e-3  # a printed form that fails misses by more than this fraction of the largest rate


@pytest.fixture(params=CASES)
def case(request: pytest.FixtureRequest) -> Case:
    return CASES[request.param]


@pytest.mark.parametrize("family", ["charge", "internal-state"])
def test_2_4_2_79_rates_are_those_the_conservation_law_allows(family: Family) -> None:
    c = CONSERVED[family]
    total = [c[a] + c[b] for a in range(3) for b in range(3)]
    allowed = {
        f"w{i + 1}{j + 1}" for i in range(9) for j in range(9) if i != j and total[i] == total[j]
    }
    assert set(BULK_NAMES[family]) == allowed
    assert len(allowed) == {"charge": 10, "internal-state": 24}[family]
    assert 72 - len(allowed) == {"charge": 62, "internal-state": 48}[family]


def test_2_79_labels() -> None:
    table = {
        "w42": "0A A0",
        "w73": "0B B0",
        "w86": "AB BA",
        "w47": "B0 A0",
        "w43": "0B A0",
        "w74": "A0 B0",
        "w27": "B0 0A",
        "w58": "BA AA",
        "w56": "AB AA",
        "w59": "BB AA",
        "w89": "BB BA",
        "w69": "BB AB",
        "w32": "0A 0B",
        "w65": "AA AB",
    }
    for name, text in table.items():
        initial, final = text.split()
        assert pair_label(int(name[2]), "internal-state") == initial
        assert pair_label(int(name[1]), "internal-state") == final


@pytest.mark.parametrize("sites", SIZES)
def test_2_22_2_88_product_measure_is_stationary(case: Case, sites: int) -> None:
    assert size_of(full_flow(case, sites, product([case.weights1] * sites))) < case.bound


def test_2_82_to_2_84_densities(case: Case) -> None:
    z, c = case.z1, case.ratio
    p = case.gas.marginal(z)
    nu = 1 + z + c * z
    assert p[1] == pytest.approx(z / nu, abs=1e-15)
    assert p[2] == pytest.approx(c * z / nu, abs=1e-15)
    slope = (np.log(1 + (1 + c) * z * 1.000001) - np.log(1 + (1 + c) * z * 0.999999)) / 2e-6
    assert case.gas.density(z) == pytest.approx((1 + c) * z / nu, abs=1e-15)
    assert case.gas.density(z) == pytest.approx(slope, abs=1e-9)


def test_2_85_2_86_PT_invariance_needs_w85_not_w86(case: Case) -> None:
    def broken(w: dict[str, float]) -> float:
        matrix = pair_matrix(w)
        pair = np.kron(case.weights1, case.weights1)
        mirror = np.arange(9).reshape(3, 3).T.ravel()
        forward = matrix[np.ix_(mirror, mirror)] * pair[None, :]
        backward = matrix.T * pair[:, None]
        return float(np.abs((forward - backward)[~np.eye(9, dtype=bool)]).max())

    assert broken(internal_rates(case.h, case.ratio)) < case.bound
    # printed: "AA -> BA with the rate w86"; then c r6 would be the rate of AB -> BA, h4
    printed = internal_rates(case.h, case.ratio)
    printed["w86"], printed["w85"] = printed["w85"], 0.0
    assert broken(printed) > WRONG
    assert pair_label(5, "internal-state") == "AA"
    assert pair_label(8, "internal-state") == "BA"


def test_2_87_matrix_from_the_rates_h_r_c(case: Case) -> None:
    c, h = case.ratio, case.h
    r = {i: h[f"r{i}"] for i in range(1, 10)}
    rows = [
        [0, 0, 0, 0, 0, 0, 0, 0, 0],
        [0, 0, r[3], h["h3"], 0, 0, r[4], 0, 0],
        [0, c * r[1], 0, c * r[4], 0, 0, h["h6"], 0, 0],
        [0, h["h1"], r[2], 0, 0, 0, r[1], 0, 0],
        [0, 0, 0, 0, 0, r[6], 0, r[5], r[7]],
        [0, 0, 0, 0, c * r[5], 0, 0, h["h5"], r[9]],
        [0, c * r[2], h["h2"], c * r[3], 0, 0, 0, 0, 0],
        [0, 0, 0, 0, c * r[6], h["h4"], 0, 0, r[8]],
        [0, 0, 0, 0, c**2 * r[7], c * r[8], 0, c * r[9], 0],
    ]
    off = np.array(rows, dtype=float)
    assert np.allclose(case.gas.bulk, off - np.diag(off.sum(axis=0)), rtol=0, atol=case.bound)


@pytest.mark.parametrize("sites", SIZES)
def test_2_89_to_2_93_hatted_generator_annihilates_the_measure(case: Case, sites: int) -> None:
    e, ep = drive(case.h, case.ratio)
    z, c = case.z1, case.ratio
    field = e * number(case, "A") + ep * number(case, "B")
    measure = product([case.weights1] * sites)
    for i in range(1, sites):
        hat = (
            -act(pair_matrix(case.w), i, sites, measure)
            - act(field, i, sites, measure)
            + act(field, i + 1, sites, measure)
        )
        assert size_of(hat) < case.bound
    g = -(e + c * ep) * z / case.nu1  # of (2.92): <b^1 + g> = 0
    left = (
        -act(end_matrix(case, "left"), 1, sites, measure)
        + act(field, 1, sites, measure)
        + g * measure
    )
    right = (
        -act(end_matrix(case, "right"), sites, sites, measure)
        - act(field, sites, sites, measure)
        - g * measure
    )
    assert size_of(left) < case.bound
    assert size_of(right) < case.bound


@pytest.mark.parametrize("sites", SIZES)
@pytest.mark.parametrize("name", ["h1", "h4", "h6", "r1", "r5", "r8"])
def test_2_94_off_the_condition_the_product_measure_fails(
    case: Case, sites: int, name: str
) -> None:
    h = {**case.h, name: case.h[name] + 0.1}
    model = internal_state_gas({**h, "c": case.ratio}, case.left, case.right)
    c = case.ratio
    printed = (
        h["h6"]
        - h["h2"]
        + h["h1"]
        - h["h3"]
        + h["h4"]
        - h["h5"]
        + (1 + c) * (h["r1"] - h["r3"])
        + (1 - c) * (h["r4"] - h["r2"])
        + c * (h["r8"] - h["r9"])
        + h["r6"]
        - h["r5"]
    )
    found = [
        x.residual
        for x in shocks.stationarity_conditions(model, case.z1, case.z1)
        if x.equation == "2.94"
    ]
    assert np.abs(found) == pytest.approx([abs(printed)] * 2, abs=1e-13)
    assert abs(printed) > WRONG
    assert shocks.stationarity_residual(model, sites, case.z1, case.z1) > WRONG


@pytest.mark.parametrize("name", ["r7", "r2", "h2"])
def test_2_94_does_not_name_r7_and_what_keeps_it_keeps_stationarity(case: Case, name: str) -> None:
    h = {**case.h, name: case.h[name] + 0.1}
    if name == "r2":  # (1 - c)(r4 - r2)
        h["h5"] -= (1 - case.ratio) * 0.1
    if name == "h2":
        h["h6"] += 0.1
    model = internal_state_gas({**h, "c": case.ratio}, {}, {})
    assert np.abs(shocks.bond_residual(model, case.z1)).max() < case.bound


def boundary_sides(case: Case) -> dict[str, tuple[float, float, float]]:
    """The three sides of (2.95) and of (2.96), as printed and with alpha3 z nu, delta3 z nu."""
    h, c, z, nu = case.h, case.ratio, case.z1, case.nu1
    first = (h["h1"] - h["h3"] + c * (2 * (h["r2"] - h["r4"]) + h["h2"] - h["h6"])) * z
    second = (
        (
            (-h["r5"] + h["r6"] + c * (h["r8"] - h["r9"]) + h["h4"] - h["h5"]) * z
            - h["r1"]
            + h["r2"]
            + h["r3"]
            - h["r4"]
            + h["h2"]
            - h["h6"]
        )
        * c
        * z
    )
    left_b = (case.gamma2 + case.gamma3) * c * z * nu - case.alpha2 * nu
    right_b = -(case.beta2 + case.beta3) * c * z * nu + case.delta2 * nu
    return {
        "2.95": (
            first,
            case.gamma1 * z * nu + case.gamma2 * c * z * nu - (case.alpha1 + case.alpha2) * nu,
            -case.beta1 * z * nu - case.beta2 * c * z * nu + (case.delta1 + case.delta2) * nu,
        ),
        "2.96": (second, left_b - case.alpha3 * z * nu, right_b + case.delta3 * z * nu),
        "2.96 printed": (
            second,
            left_b - case.alpha3 * z * (1 + z) * nu,
            right_b + case.delta3 * z * (1 + z) * nu,
        ),
    }


@pytest.mark.parametrize("equation", ["2.95", "2.96"])
def test_2_95_2_96_ends(case: Case, equation: str) -> None:
    bulk, left, right = boundary_sides(case)[equation]
    assert left == pytest.approx(bulk, abs=30 * case.bound)
    assert right == pytest.approx(bulk, abs=30 * case.bound)


def test_2_96_as_printed_fails(case: Case) -> None:
    bulk, left, right = boundary_sides(case)["2.96 printed"]
    assert abs(left - bulk) > WRONG * case.gas.scale
    assert abs(right - bulk) > WRONG * case.gas.scale


@pytest.mark.parametrize("sites", SIZES)
def test_2_62_2_97_shock_random_walks(sites: int) -> None:
    d1 = P_Q[1] * WALKER.nu2 / WALKER.nu1
    d2 = P_Q[0] * WALKER.nu1 / WALKER.nu2
    for k in range(1, sites):
        change = full_flow(WALKER, sites, shock(WALKER, sites, k))
        walk = (
            d1 * shock(WALKER, sites, k - 1)
            + d2 * shock(WALKER, sites, k + 1)
            - (d1 + d2) * shock(WALKER, sites, k)
        )
        assert size_of(change - walk) < WALKER.bound
        assert size_of(change) > WRONG * WALKER.gas.scale


@pytest.mark.parametrize("sites", SIZES)
def test_2_98_to_2_101_ends_of_the_shock(sites: int) -> None:
    case, (p, q) = WALKER, P_Q
    c, (e, ep) = case.ratio, drive(WALKER.h, WALKER.ratio)
    field = e * number(case, "A") + ep * number(case, "B")
    g = [(e + c * ep) * z / nu for z, nu in ((case.z1, case.nu1), (case.z2, case.nu2))]
    state = shock(case, sites, max(1, sites // 2))
    left = (
        -act(end_matrix(case, "left"), 1, sites, state) + act(field, 1, sites, state) - g[0] * state
    )
    right = (
        -act(end_matrix(case, "right"), sites, sites, state)
        - act(field, sites, sites, state)
        + g[1] * state
    )
    assert size_of(left) < case.bound
    assert size_of(right) < case.bound
    for value, z, nu in zip(g, (case.z1, case.z2), (case.nu1, case.nu2), strict=True):
        assert value == pytest.approx((1 + c) * (p - q) * z / nu, abs=case.bound)
    assert g[0] == pytest.approx(
        case.alpha1 + case.alpha2 - (case.gamma1 + c * case.gamma2) * case.z1, abs=case.bound
    )
    assert g[1] == pytest.approx(
        -(case.delta1 + case.delta2) + (case.beta1 + c * case.beta2) * case.z2, abs=case.bound
    )


def six_equations(case: Case, d1: float, d2: float) -> dict[str, float]:
    """(2.102)-(2.107) with S of (2.108)."""
    c, h, z1, z2 = case.ratio, case.h, case.z1, case.z2
    e, ep = drive(h, c)
    g1, g2 = (e + c * ep) * z1 / case.nu1, (e + c * ep) * z2 / case.nu2
    s = d1 + d2 + g2 - g1
    a, b = d1 * case.nu1 / case.nu2, d2 * case.nu2 / case.nu1
    tail = -a * z2 - b * z1
    return {
        "2.102": s - a - b,
        "2.103": (c * h["r4"] + h["h3"]) * (z1 - z2) + s * z2 + tail,
        "2.104": (h["r4"] + h["h6"]) * (z1 - z2) + s * z2 + tail,
        "2.105": (c * h["r2"] + h["h1"]) * (z2 - z1) + s * z1 + tail,
        "2.106": s - a * z2 / z1 - b * z1 / z2,
        "2.107": (h["r2"] + h["h2"]) * (z2 - z1) + s * z1 + tail,
    }


@pytest.mark.parametrize("equation", [f"2.{n}" for n in range(102, 108)])
def test_2_102_to_2_108_on_the_manifold(equation: str) -> None:
    d1, d2 = shocks.hopping_rates(WALKER.gas, WALKER.z1, WALKER.z2)
    assert abs(six_equations(WALKER, d1, d2)[equation]) < 10 * WALKER.bound


def test_2_102_to_2_107_are_the_bond_equations_off_the_manifold_too(case: Case) -> None:
    """Six printed left sides are rows of the bond equations; the other three repeat (2.106)."""
    other = type(case)(case.w, case.left, case.right, 0.6, 0.9, case.ratio, case.gas, case.h)
    model, c = case.gas, case.ratio
    first, second, field = model.marginal(0.6), model.marginal(0.9), shocks.divergence_field(model)
    d1, d2 = 0.37, 0.53  # any
    here = np.kron(first, second)
    rest = (
        other.nu1
        * other.nu2
        * (
            model.bulk @ here
            - (np.subtract.outer(field, field).ravel() - field @ first + field @ second) * here
            - d1 * (np.kron(second, second) - here)
            - d2 * (np.kron(first, first) - here)
        )
    )
    printed = six_equations(other, d1, d2)
    rows = {
        "2.102": (0, 1),
        "2.103": (1, 1),
        "2.104": (2, c),
        "2.105": (3, 1),
        "2.107": (6, c),
        "2.106": (4, 0.6 * 0.9),
    }
    for equation, (row, factor) in rows.items():
        assert factor * printed[equation] == pytest.approx(rest[row], abs=100 * case.bound)
        assert abs(rest[row]) > 1e-4
    for row, factor in ((5, c), (7, c), (8, c**2)):
        assert rest[row] == pytest.approx(factor * rest[4], abs=100 * case.bound)


def test_2_109_to_2_116_manifold_rates_velocity_and_diffusion() -> None:
    case, h, c = WALKER, WALKER.h, WALKER.ratio
    p, q = P_Q
    d1, d2 = shocks.hopping_rates(case.gas, case.z1, case.z2)
    assert h["h6"] + h["r4"] == pytest.approx(p, abs=case.bound)  # (2.109)
    assert h["h2"] + h["r2"] == pytest.approx(q, abs=case.bound)  # (2.110)
    assert p / q == pytest.approx(case.z2 / case.z1, rel=1e-13)  # (2.111)
    assert d1 == pytest.approx(q * case.nu2 / case.nu1, abs=case.bound)  # (2.112)
    assert d2 == pytest.approx(p * case.nu1 / case.nu2, abs=case.bound)  # (2.113)
    reduced = (
        h["h4"]
        - h["h5"]
        + (1 + c) * (h["r1"] - h["r3"])
        + c * (h["r8"] - h["r9"])
        + h["r6"]
        - h["r5"]
    )
    assert reduced == pytest.approx(0, abs=10 * case.bound)  # (2.114)
    printed_v = (q * case.nu2**2 - p * case.nu1**2) / (case.nu1 * case.nu2)
    walk = shocks.ShockWalk(9, d1, d2, d2, d1)
    assert -walk.velocity == pytest.approx(printed_v, abs=10 * case.bound)  # (2.115) is d1 - d2
    printed_d = (p * case.nu1**2 + q * case.nu2**2) / (2 * case.nu1 * case.nu2)
    assert walk.diffusion == pytest.approx(printed_d, abs=10 * case.bound)  # (2.116)


@pytest.mark.parametrize(("name", "equation"), [("h3", "2.109"), ("h1", "2.110"), ("r4", "2.109")])
def test_2_109_to_2_111_are_necessary(name: str, equation: str) -> None:
    """Detune one rate, keep (2.94) with h4: stationary still, but no walk."""
    h, c = {**WALKER.h}, WALKER.ratio
    h[name] += 0.1
    h["h4"] -= {"h3": -0.1, "h1": 0.1, "r4": (1 - c) * 0.1}[name]
    model = internal_state_gas({**h, "c": c}, WALKER.left, WALKER.right)
    assert np.abs(shocks.bond_residual(model, 1.0)).max() < 1e-13
    failing = {
        x.equation
        for x in shocks.random_walk_conditions(model, WALKER.z1, WALKER.z2)
        if abs(x.residual) > 1e-3
    }
    assert equation in failing
    assert shocks.random_walk_residuals(model, 4, WALKER.z1, WALKER.z2)[1:-1].min() > WRONG


@pytest.mark.parametrize("sites", range(3, 8))
def test_2_117_stationary_mixture_is_d2_over_d1(sites: int) -> None:
    """The printed (d1/d2)^k, on the model with e0 = d2 and eL = d1, is not stationary."""
    case = plain_ends()
    d1, d2 = shocks.hopping_rates(case.gas, case.z1, case.z2)
    assert shocks.end_rates(case.gas, case.z1, case.z2) == pytest.approx((d2, d1), abs=case.bound)
    for ratio, holds in ((d2 / d1, True), (d1 / d2, False)):
        weights = ratio ** np.arange(sites + 1)
        mixture = sum(w / weights.sum() * shock(case, sites, k) for k, w in enumerate(weights))
        rest = size_of(full_flow(case, sites, mixture))
        assert (rest < case.bound) == holds
        assert holds or rest > WRONG * case.gas.scale


def plain_ends() -> Case:
    """Internal-state shock model whose ends have alpha2 = c alpha1, e0 = d2 and eL = d1."""
    h, c, z1, z2 = WALKER.h, WALKER.ratio, WALKER.z1, WALKER.z2
    (p, q), nu1, nu2 = P_Q, WALKER.nu1, WALKER.nu2
    d1, d2 = q * nu2 / nu1, p * nu1 / nu2
    # e0 = nu1 (gamma1 + c gamma2)/(1+c) + (p-q)/nu2 = d2 and its mirror image give the sums below
    gamma = (d2 - (p - q) / nu2) * (1 + c) / nu1
    beta = (d1 + (p - q) / nu1) * (1 + c) / nu2
    alpha = (1 + c) * (p - q) * z1 / nu1 + gamma * z1  # (2.100)
    delta = beta * z2 - (1 + c) * (p - q) * z2 / nu2  # (2.101)
    e, ep = drive(h, c)
    left = {"alpha1": alpha / (1 + c), "alpha2": c * alpha / (1 + c), "alpha3": 0.2}
    right = {"delta1": delta / (1 + c), "delta2": c * delta / (1 + c), "delta3": 0.3}
    # (2.96), state B: what remains for gamma2 + gamma3 and beta2 + beta3; gamma2 = gamma1 = share
    mean1, mean2 = (e + c * ep) * z1 / nu1, (e + c * ep) * z2 / nu2
    left_sum = (left["alpha2"] + left["alpha3"] * z1 + (mean1 - ep) * c * z1) / (c * z1)
    right_sum = (right["delta2"] + right["delta3"] * z2 - (mean2 - ep) * c * z2) / (c * z2)
    left |= {"gamma1": gamma / (1 + c), "gamma2": gamma / (1 + c)}
    right |= {"beta1": beta / (1 + c), "beta2": beta / (1 + c)}
    left["gamma3"], right["beta3"] = left_sum - left["gamma2"], right_sum - right["beta2"]
    gas = internal_state_gas({**h, "c": c}, left, right)
    return type(WALKER)(WALKER.w, left, right, z1, z2, c, gas, h)


@pytest.mark.parametrize("sites", SIZES)
def test_closure_at_the_ends_needs_alpha2_and_delta2(sites: int) -> None:
    """Interior (2.62) holds with any ends that keep the densities; the ends close only with
    alpha2 = c alpha1, delta2 = c delta1."""
    case = plain_ends()
    detuned = {**case.left}
    shift = 0.05  # alpha1, alpha2 exchange; alpha3 restores (2.96)
    detuned["alpha1"] += shift
    detuned["alpha2"] -= shift
    detuned["alpha3"] += shift / case.z1
    model = internal_state_gas({**case.h, "c": case.ratio}, detuned, case.right)
    good = shocks.random_walk_residuals(case.gas, sites, case.z1, case.z2)
    bad = shocks.random_walk_residuals(model, sites, case.z1, case.z2)
    assert good.max() < 1e-13
    assert bad[1:].max() < 1e-13
    assert bad[0] > WRONG
    assert shocks.closes(good)
    assert not shocks.closes(bad)


def test_end_rates_of_the_errata() -> None:
    case, (p, q), c = WALKER, P_Q, WALKER.ratio
    e0, el = shocks.end_rates(case.gas, case.z1, case.z2)
    assert e0 == pytest.approx(
        case.nu1 * (case.gamma1 + c * case.gamma2) / (1 + c) + (p - q) / case.nu2, rel=1e-12
    )
    assert el == pytest.approx(
        case.nu2 * (case.beta1 + c * case.beta2) / (1 + c) - (p - q) / case.nu1, rel=1e-12
    )


def test_linear_profile_where_the_shock_has_no_bias() -> None:
    """Text after (2.117): d1 = d2 puts the shock anywhere equally likely, if the ends do."""
    walk = shocks.ShockWalk(6, 0.4, 0.4, 0.4, 0.4)
    assert walk.stationary_mixture() == pytest.approx(np.full(7, 1 / 7), rel=1e-14)
    # the sentence before has the bias reversed: d1 > d2 leaves the shock at the left end
    assert shocks.ShockWalk(6, 0.6, 0.3, 0.3, 0.6).stationary_mixture().argmax() == 0
    assert shocks.ShockWalk(6, 0.3, 0.6, 0.6, 0.3).stationary_mixture().argmax() == 6
    other = shocks.ShockWalk(6, 0.4, 0.4, 0.8, 0.4).stationary_mixture()
    assert other[0] == pytest.approx(other[1] / 2, rel=1e-14)  # (2.117) needs the end rates


def e_and_b(
    case: Case, sites: int, vector: Array, k: int
) -> tuple[Callable[[str], float], Callable[[str], float]]:
    return (
        lambda pattern: mean(case, sites, vector, pattern, k),
        lambda pattern: mean(case, sites, vector, pattern, k - 1),
    )


@pytest.mark.parametrize("sites", range(3, 8))
def test_2_118_2_119_equations_of_motion_with_plus_signs(case: Case, sites: int) -> None:
    h, c = case.h, case.ratio
    vector = random_distribution(sites)
    flow = full_flow(case, sites, vector)
    h1, h2, h3, h4, h5, h6 = (h[f"h{i}"] for i in range(1, 7))
    r1, r2, r3, r4, r5, r6, r7, r8, r9 = (h[f"r{i}"] for i in range(1, 10))
    for k in range(2, sites):
        e, b = e_and_b(case, sites, vector, k)

        def a_rate(
            sign: int, e: Callable[[str], float] = e, b: Callable[[str], float] = b
        ) -> float:
            return (
                -(h1 + c * r1 + c * r2) * b("0A")
                + h3 * b("A0")
                + (h4 + sign * r6) * b("AB")
                - (h5 + c * r9) * b("BA")
                + r3 * b("0B")
                + r4 * b("B0")
                - c * (r5 + c * r7) * b("AA")
                + (r7 + r8) * b("BB")
                + h1 * e("0A")
                - (h3 + c * r3 + c * r4) * e("A0")
                - (h4 + c * r8) * e("AB")
                + (h5 + r5) * e("BA")
                + r1 * e("B0")
                + sign * r2 * e("0B")
                - c * (r6 + c * r7) * e("AA")
                + (r7 + r9) * e("BB")
            )

        b_rate = (
            -(h2 + r2 + r3) * b("0B")
            + h6 * b("B0")
            - (h4 + r6) * b("AB")
            + (h5 + c * r9) * b("BA")
            + c * r1 * b("0A")
            + c * r4 * b("A0")
            + c * (r5 + c * r7) * b("AA")
            - (r7 + r8) * b("BB")
            + h2 * e("0B")
            - (h6 + r1 + r4) * e("B0")
            + (h4 + c * r8) * e("AB")
            - (h5 + r5) * e("BA")
            + c * r2 * e("0A")
            + c * r3 * e("A0")
            + c * (r6 + c * r7) * e("AA")
            - (r7 + r9) * e("BB")
        )
        found = mean(case, sites, flow, "A", k)
        assert found == pytest.approx(a_rate(1), abs=case.bound)
        assert abs(found - a_rate(-1)) > WRONG  # (2.118) as printed
        assert mean(case, sites, flow, "B", k) == pytest.approx(b_rate, abs=case.bound)


def species_currents(case: Case, e: Callable[[str], float]) -> tuple[float, float, float]:
    """(2.123), (2.124), (2.125)."""
    h, c = case.h, case.ratio
    a = (
        -(h["h1"] + c * h["r2"] / 2) * e("0A")
        + (h["h3"] + c * h["r4"] / 2) * e("A0")
        + h["h4"] * e("AB")
        - h["h5"] * e("BA")
        - h["r2"] / 2 * e("0B")
        + h["r4"] / 2 * e("B0")
    )
    b = (
        -(h["h2"] + h["r2"] / 2) * e("0B")
        + (h["h6"] + h["r4"] / 2) * e("B0")
        - h["h4"] * e("AB")
        + h["h5"] * e("BA")
        - c * h["r2"] / 2 * e("0A")
        + c * h["r4"] / 2 * e("A0")
    )
    total = (
        -h["h1"] * e("0A")
        + h["h3"] * e("A0")
        - h["h2"] * e("0B")
        + h["h6"] * e("B0")
        - h["r2"] * e("0B")
        - c * h["r2"] * e("0A")
        + c * h["r4"] * e("A0")
        + h["r4"] * e("B0")
    )
    return a, b, total


def source(case: Case, e: Callable[[str], float], b: Callable[[str], float], sign: int) -> float:
    """(2.122); `sign` = 1 with -(c r1 + c r2/2) in the first term, -1 for the print."""
    c = case.ratio
    r1, r2, r3, r4, r5, r6, r7, r8, r9 = (case.h[f"r{i}"] for i in range(1, 10))
    first = -(c * r1 + c * r2 / 2) if sign == 1 else c * r1 - c * r2 / 2
    return (
        first * b("0A")
        + (r2 / 2 + r3) * b("0B")
        + r4 / 2 * b("B0")
        - c * r4 / 2 * b("A0")
        - (c * r5 + c**2 * r7) * b("AA")
        + r6 * b("AB")
        + (r7 + r8) * b("BB")
        - c * r9 * b("BA")
        + (r1 + r4 / 2) * e("B0")
        + r2 / 2 * e("0B")
        - c * r2 / 2 * e("0A")
        - (c * r3 + c * r4 / 2) * e("A0")
        + r5 * e("BA")
        - (c * r6 + c**2 * r7) * e("AA")
        + (r7 + r9) * e("BB")
        - c * r8 * e("AB")
    )


@pytest.mark.parametrize("sites", range(3, 8))
def test_2_120_to_2_125_currents_and_source(case: Case, sites: int) -> None:
    vector = random_distribution(sites)
    flow = full_flow(case, sites, vector)
    engine = generator.species_currents(case.gas, sites, vector)
    total = generator.bond_currents(case.gas, sites, vector)
    for k in range(2, sites):
        e, b = e_and_b(case, sites, vector, k)
        out, into, s = species_currents(case, e), species_currents(case, b), source(case, e, b, 1)
        a_rate, b_rate = (mean(case, sites, flow, species, k) for species in "AB")
        assert a_rate == pytest.approx(into[0] - out[0] + s, abs=case.bound)  # (2.120)
        assert b_rate == pytest.approx(into[1] - out[1] - s, abs=case.bound)  # (2.121)
        assert a_rate + b_rate == pytest.approx(into[2] - out[2], abs=case.bound)  # (2.12)
        assert abs(a_rate - into[0] + out[0] - source(case, e, b, -1)) > WRONG  # print of (2.122)
        assert engine["A"][k - 1] == pytest.approx(out[0], abs=case.bound)
        assert engine["B"][k - 1] == pytest.approx(out[1], abs=case.bound)
        assert total[k - 1] == pytest.approx(out[2], abs=case.bound)
        assert out[2] == pytest.approx(out[0] + out[1], abs=case.bound)


@pytest.mark.parametrize("sites", SIZES)
def test_2_126_2_127_stationary_current(case: Case, sites: int) -> None:
    h, c = case.h, case.ratio
    measure = product([case.weights1] * sites)
    rho = case.gas.density(case.z1)
    printed = (
        (h["h3"] - h["h1"] + c * (h["h6"] - h["h2"]) + 2 * c * (h["r4"] - h["r2"]))
        / (1 + c)
        * rho
        * (1 - rho)
    )
    e, ep = drive(h, c)
    assert printed == pytest.approx((e + c * ep) / (1 + c) * rho * (1 - rho), abs=case.bound)
    found = generator.bond_currents(case.gas, sites, measure)
    assert found == pytest.approx([printed] * (sites - 1), abs=case.bound)
    assert case.gas.current(case.z1) == pytest.approx(printed, abs=case.bound)


def test_2_128_current_on_the_shock_manifold() -> None:
    p, q = P_Q
    for z in (WALKER.z1, WALKER.z2, 2.7):
        rho = WALKER.gas.density(z)
        assert WALKER.gas.current(z) == pytest.approx((p - q) * rho * (1 - rho), abs=WALKER.bound)

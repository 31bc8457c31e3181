"""Every numbered statement of section 2.3 and the appendices, on the full generator, L = 2..7.

Names carry equation numbers; where the print is wrong the test shows the printed form fail.
"""

import numpy as np
import pytest
from numpy.typing import NDArray

from lattice import generator, shocks
from lattice.models import RateError, charge_gas
from tests.lattice.lattice_paper import (
    SIZES,
    Case,
    act,
    charge_drive,
    end_matrix,
    full_flow,
    mean,
    number,
    pair_matrix,
    present,
    product,
    random_distribution,
    shock,
    shock_charge,
    size_of,
    stationary_charge,
)

Array = NDArray[np.float64]

CASES = {"stationary": stationary_charge(1), "other": stationary_charge(3)}
SHOCKS = {kind: shock_charge(kind) for kind in ("one-sided", "two-sided")}
WRONG = 1e-3  # a printed form that fails misses by more than this fraction of the largest rate


@pytest.fixture(params=CASES)
def case(request: pytest.FixtureRequest) -> Case:
    return CASES[request.param]


@pytest.fixture(params=SHOCKS)
def walker(request: pytest.FixtureRequest) -> Case:
    return SHOCKS[request.param]


def test_2_19_columns_add_up_to_zero_only_with_delta3(case: Case) -> None:
    matrix = end_matrix(case, "right")
    printed = matrix.copy()
    printed[2, 1] = case.beta3
    assert np.abs(matrix.sum(axis=0)).max() <= case.bound
    assert np.abs(printed.sum(axis=0)).max() > WRONG * case.gas.scale
    assert np.allclose(matrix, present(case.gas.right), rtol=0, atol=case.bound)


@pytest.mark.parametrize("sites", SIZES)
def test_2_15_to_2_18_and_2_29_generator_is_the_sum_of_its_terms(case: Case, sites: int) -> None:
    vector = random_distribution(sites)
    flow = full_flow(case, sites, vector)
    assert size_of(generator.generator(case.gas, sites) @ vector - flow) < sites * case.bound
    assert size_of(generator.apply(case.gas, sites, vector) - flow) < sites * case.bound


@pytest.mark.parametrize("sites", SIZES)
def test_2_22_2_25_product_measure_is_stationary(case: Case, sites: int) -> None:
    assert size_of(full_flow(case, sites, product([case.weights1] * sites))) < case.bound


def test_2_27_2_28_densities(case: Case) -> None:
    z, r = case.z1, case.ratio
    nu = 1 + z + r * z**2
    step = 1e-6
    log_slope = (
        np.log(1 + z + step + r * (z + step) ** 2) - np.log(1 + z - step + r * (z - step) ** 2)
    ) / (2 * step)
    p = case.gas.marginal(z)
    assert p[0] - p[2] == pytest.approx((1 - r * z**2) / nu, abs=1e-15)
    assert p[0] - p[2] == pytest.approx(1 - z * log_slope, abs=1e-9)
    assert p[0] + p[2] == pytest.approx((1 + r * z**2) / nu, abs=1e-15)
    assert p[2] / p[0] == pytest.approx(r * z**2, rel=1e-14)


@pytest.mark.parametrize("sites", SIZES)
def test_2_30_bond_telescopes_with_F_of_2_33_2_34(case: Case, sites: int) -> None:
    f, fp = charge_drive(case.w)
    measure = product([case.weights1] * sites)
    field = f * number(case, "A") + fp * number(case, "B")
    for k in range(1, sites):
        right = act(field, k + 1, sites, measure) - act(field, k, sites, measure)
        left = -act(pair_matrix(case.w), k, sites, measure)
        assert size_of(left - right) < case.bound


@pytest.mark.parametrize("sites", SIZES)
def test_2_31_2_32_2_37_boundaries_with_minus_sign_of_g(case: Case, sites: int) -> None:
    f, fp = charge_drive(case.w)
    z, r, nu = case.z1, case.ratio, case.nu1
    measure = product([case.weights1] * sites)
    field = f * number(case, "A") + fp * number(case, "B")
    printed, right = (f + fp * r * z**2) / nu, -(f + fp * r * z**2) / nu
    for g, holds in ((right, True), (printed, False)):
        left_end = (
            -act(end_matrix(case, "left"), 1, sites, measure)
            - act(field, 1, sites, measure)
            - g * measure
        )
        right_end = (
            -act(end_matrix(case, "right"), sites, sites, measure)
            + act(field, sites, sites, measure)
            + g * measure
        )
        for rest in (left_end, right_end):
            assert (size_of(rest) < case.bound) == holds
            assert holds or size_of(rest) > WRONG * case.gas.scale


def test_2_150_g_from_the_left_end(case: Case) -> None:
    f, fp = charge_drive(case.w)
    z, r, nu = case.z1, case.ratio, case.nu1
    g = case.gamma1 + case.alpha3 - case.alpha1 / z - r * z * case.gamma3
    assert g == pytest.approx(-(f + fp * r * z**2) / nu, abs=10 * case.bound)


def test_2_35_2_143_ratio(case: Case) -> None:
    assert case.gas.ratio == pytest.approx((case.w35 + case.w75) / (case.w53 + case.w57), rel=1e-15)


@pytest.mark.parametrize("sites", SIZES)
@pytest.mark.parametrize("name", ["w24", "w37", "w68", "w35", "w53"])
def test_2_36_2_144_off_the_condition_the_product_measure_fails(
    case: Case, sites: int, name: str
) -> None:
    rates = {**case.w, name: case.w[name] + 0.1}
    model = charge_gas(rates, case.left, case.right)
    (condition,) = (
        c for c in shocks.stationarity_conditions(model, case.z1, case.z1) if c.equation == "2.36"
    )
    rest = max(
        size_of(shocks.bond_residual(model, case.z1)),
        shocks.stationarity_residual(model, sites, case.z1, case.z1),
    )
    assert abs(condition.residual) > WRONG
    assert rest > WRONG


def boundary_equations(case: Case) -> dict[str, float]:
    """Left sides of (2.38)-(2.41) with (2.40) corrected and as printed, and of (2.154)."""
    z, r, nu = case.z1, case.ratio, case.nu1
    m = r * z**2
    ba, bb = case.w42 - case.w24, case.w68 - case.w86
    common_a, common_b = ba * z * (1 + r * z) - bb * m, bb * m * (1 + z) - ba * m
    return {
        "2.38": common_a
        + (case.alpha1 + case.alpha2) * nu
        - case.gamma1 * z * nu
        - case.gamma2 * m * nu,
        "2.39": common_b
        - case.alpha3 * z * nu
        + (case.gamma3 + case.gamma2) * m * nu
        - case.alpha2 * nu,
        "2.40": common_a
        - (case.delta1 + case.delta2) * nu
        + case.beta1 * z * nu
        + case.beta2 * m * nu,
        # printed: beta1 nu + beta2 mu, where mu is the weight of B in the notation of (2.154)
        "2.40 printed": common_a
        - (case.delta1 + case.delta2) * nu
        + case.beta1 * nu
        + case.beta2 * m,
        "2.41": common_b
        + case.delta3 * z * nu
        - (case.beta3 + case.beta2) * m * nu
        + case.delta2 * nu,
        # (2.154) has gamma3 where the right end has delta3
        "2.154 printed": common_b
        + case.gamma3 * z * nu
        - (case.beta3 + case.beta2) * m * nu
        + case.delta2 * nu,
    }


@pytest.mark.parametrize("equation", ["2.38", "2.39", "2.40", "2.41"])
def test_2_38_to_2_41_and_2_151_to_2_154(case: Case, equation: str) -> None:
    assert abs(boundary_equations(case)[equation]) < 10 * case.bound * case.nu1**2


@pytest.mark.parametrize("equation", ["2.40 printed", "2.154 printed"])
def test_2_40_2_153_2_154_as_printed_fail(case: Case, equation: str) -> None:
    assert abs(boundary_equations(case)[equation]) > WRONG * case.gas.scale


@pytest.mark.parametrize("end", ["2.38", "2.39", "2.40", "2.41"])
def test_boundary_conditions_report_the_printed_left_sides(case: Case, end: str) -> None:
    """Detuned rates: the engine's residuals are (2.38)-(2.41) over nu^2, up to the sign."""
    side = "left" if end in ("2.38", "2.39") else "right"
    detuned = {**getattr(case, side)}
    name = {"2.38": "alpha1", "2.39": "alpha3", "2.40": "delta1", "2.41": "delta3"}[end]
    detuned[name] += 0.3
    parts = {"left": case.left, "right": case.right, side: detuned}
    model = charge_gas(case.w, parts["left"], parts["right"])
    other = type(case)(case.w, parts["left"], parts["right"], case.z1, case.z1, case.ratio, model)
    (found,) = (
        c for c in shocks.stationarity_conditions(model, case.z1, case.z1) if c.equation == end
    )
    expected = boundary_equations(other)[end] / case.nu1**2
    assert abs(found.residual) == pytest.approx(abs(expected), rel=1e-10)
    assert abs(found.residual) > WRONG


def test_2_13_2_42_PT_invariance(case: Case) -> None:
    """p(j) w(Rj -> Ri) = p(i) w(i -> j), R exchanging the two sites, holds with (2.42) only."""

    def broken(w: dict[str, float]) -> float:
        matrix = pair_matrix(w)
        r = (w["w35"] + w["w75"]) / (w["w53"] + w["w57"])
        weights = np.array([1.0, case.z1, r * case.z1**2])
        pair = np.kron(weights, weights)
        mirror = np.arange(9).reshape(3, 3).T.ravel()
        forward = matrix[np.ix_(mirror, mirror)] * pair[None, :]
        backward = matrix.T * pair[:, None]
        off = ~np.eye(9, dtype=bool)
        return float(np.abs((forward - backward)[off]).max())

    r = 0.8
    pt = {**case.w, "w75": r * case.w53, "w35": r * case.w57}
    assert broken(pt) < case.bound
    assert broken({**pt, "w35": pt["w35"] + 0.2}) > WRONG


def currents(case: Case, sites: int, vector: Array, k: int) -> tuple[float, float, float]:
    """j_k of (2.46), j^A of (2.52), j^B of (2.53)."""

    def e(pattern: str) -> float:
        return mean(case, sites, vector, pattern, k)

    total = (
        -case.w24 * e("0A")
        + case.w42 * e("A0")
        - 2 * case.w37 * e("BA")
        + 2 * case.w73 * e("AB")
        - case.w68 * e("B0")
        + case.w86 * e("0B")
        - case.w35 * e("00")
        + case.w53 * e("AB")
        - case.w57 * e("BA")
        + case.w75 * e("00")
    )
    reactions = (
        -case.w35 * e("00") + case.w53 * e("AB") - case.w57 * e("BA") + case.w75 * e("00")
    ) / 2
    exchange = -case.w37 * e("BA") + case.w73 * e("AB")
    a = -case.w24 * e("0A") + case.w42 * e("A0") + exchange + reactions
    b = case.w68 * e("B0") - case.w86 * e("0B") - exchange - reactions
    return total, a, b


def source(case: Case, sites: int, vector: Array, k: int) -> float:
    """S_k of (2.51)."""

    def e(pattern: str) -> float:
        return mean(case, sites, vector, pattern, k - 1) + mean(case, sites, vector, pattern, k)

    return (-case.w57 * e("BA") + case.w75 * e("00") + case.w35 * e("00") - case.w53 * e("AB")) / 2


def rate_of_change(case: Case, sites: int, vector: Array, species: str, k: int) -> float:
    flow = full_flow(case, sites, vector)
    return mean(case, sites, flow, species, k)


@pytest.mark.parametrize("sites", range(3, 8))
def test_2_12_2_43_2_46_continuity_of_charge(case: Case, sites: int) -> None:
    vector = random_distribution(sites)
    engine = generator.bond_currents(case.gas, sites, vector)
    for k in range(2, sites):
        change = rate_of_change(case, sites, vector, "A", k) - rate_of_change(
            case, sites, vector, "B", k
        )
        into, out = (currents(case, sites, vector, m)[0] for m in (k - 1, k))
        assert change == pytest.approx(into - out, abs=case.bound)
        assert engine[k - 1] == pytest.approx(out, abs=case.bound)


@pytest.mark.parametrize("sites", range(3, 8))
def test_2_44_2_45_equations_of_motion(case: Case, sites: int) -> None:
    vector = random_distribution(sites)
    for k in range(2, sites):

        def e(pattern: str, k: int = k) -> float:
            return mean(case, sites, vector, pattern, k)

        def b(pattern: str, k: int = k) -> float:
            return mean(case, sites, vector, pattern, k - 1)

        a_rate = (
            -case.w24 * b("0A")
            + case.w42 * b("A0")
            - case.w37 * b("BA")
            + case.w73 * b("AB")
            - case.w57 * b("BA")
            + case.w75 * b("00")
            + case.w24 * e("0A")
            - case.w42 * e("A0")
            + case.w37 * e("BA")
            - case.w73 * e("AB")
            + case.w35 * e("00")
            - case.w53 * e("AB")
        )
        b_rate = (
            case.w37 * b("BA")
            - case.w73 * b("AB")
            - case.w86 * b("0B")
            + case.w68 * b("B0")
            + case.w35 * b("00")
            - case.w53 * b("AB")
            - case.w37 * e("BA")
            + case.w73 * e("AB")
            + case.w86 * e("0B")
            - case.w68 * e("B0")
            - case.w57 * e("BA")
            + case.w75 * e("00")
        )
        assert rate_of_change(case, sites, vector, "A", k) == pytest.approx(a_rate, abs=case.bound)
        assert rate_of_change(case, sites, vector, "B", k) == pytest.approx(b_rate, abs=case.bound)


@pytest.mark.parametrize("sites", range(3, 8))
def test_2_49_to_2_54_particle_currents_and_source(case: Case, sites: int) -> None:
    vector = random_distribution(sites)
    engine = generator.species_currents(case.gas, sites, vector)
    for k in range(2, sites):
        s = source(case, sites, vector, k)
        into, out = (currents(case, sites, vector, m) for m in (k - 1, k))
        a = rate_of_change(case, sites, vector, "A", k)
        b = rate_of_change(case, sites, vector, "B", k)
        assert a == pytest.approx(into[1] - out[1] + s, abs=case.bound)
        assert b == pytest.approx(into[2] - out[2] + s, abs=case.bound)
        assert a + b == pytest.approx(sum(into[1:]) - sum(out[1:]) + 2 * s, abs=case.bound)
        assert out[0] == pytest.approx(out[1] - out[2], abs=case.bound)
        assert engine["A"][k - 1] == pytest.approx(out[1], abs=case.bound)
        assert engine["B"][k - 1] == pytest.approx(out[2], abs=case.bound)


@pytest.mark.parametrize("sites", SIZES)
def test_2_47_2_48_stationary_current_with_rho_of_2_28(case: Case, sites: int) -> None:
    z, r, nu = case.z1, case.ratio, case.nu1
    measure = product([case.weights1] * sites)
    j = [currents(case, sites, measure, k)[0] for k in range(1, sites)]
    long_form = (
        (case.w42 - case.w24) * z / nu**2
        + (2 * (case.w73 - case.w37) + case.w53 - case.w57) * r * z**2 / nu**2
        + (case.w86 - case.w68) * r * z**3 / nu**2
        + (case.w75 - case.w35) * z**2 / nu**2
    )
    sigma = (1 - r * z**2) / nu

    def short_form(rho: float) -> float:
        return (
            (case.w42 - case.w24) * (rho + sigma) * (1 - sigma)
            + (case.w86 - case.w68) * (rho - sigma) * (1 + sigma)
        ) / 2

    rho_2_28, rho_2_84 = (1 + r * z**2) / nu, (1 + r) * z / (1 + z + r * z)
    assert j == pytest.approx([long_form] * (sites - 1), abs=case.bound)
    assert short_form(rho_2_28) == pytest.approx(long_form, abs=case.bound)
    assert abs(short_form(rho_2_84) - long_form) > WRONG * case.gas.scale
    assert case.gas.current(z) == pytest.approx(long_form, abs=case.bound)


@pytest.mark.parametrize("sites", range(3, 8))
def test_2_57_local_source_in_a_product_measure_of_any_density(case: Case, sites: int) -> None:
    """R(sigma, rho) is twice S_k in every product measure, and vanishes on (2.59) only."""
    for pa, pb in ((0.3, 0.2), (0.1, 0.6)):
        vector = product([np.array([pa, 1 - pa - pb, pb])] * sites)
        rho, sigma = pa + pb, pa - pb
        printed = (
            -(case.w57 + case.w53) * (rho + sigma) * (rho - sigma) / 2
            + 2 * (case.w75 + case.w35) * (1 - rho) ** 2
        )
        assert 2 * source(case, sites, vector, 2) == pytest.approx(printed, abs=case.bound)
        assert abs(printed) > WRONG
    stationary = case.weights1 / case.nu1
    rho, sigma = stationary[0] + stationary[2], stationary[0] - stationary[2]
    assert rho**2 - sigma**2 == pytest.approx(4 * case.ratio * (1 - rho) ** 2, abs=1e-14)
    uniform = product([case.weights1] * sites)
    assert abs(source(case, sites, uniform, 2)) < case.bound


def test_2_58_gradient_of_the_source(case: Case) -> None:
    """First order in the lattice constant a: 2 S_k - R = a R~ + O(a^2), Richardson-extrapolated."""

    def excess(a: float) -> float:
        def p(x: float) -> tuple[float, float]:  # smooth densities of A and B around x = 0
            return 0.3 + 0.2 * x + 0.1 * x**2, 0.25 - 0.15 * x + 0.05 * x**2

        vector = product([np.array([pa, 1 - pa - pb, pb]) for pa, pb in (p(-a), p(0.0), p(a))])
        return (2 * source(case, 3, vector, 2) - local) / a

    rho, sigma, d_rho, d_sigma = 0.55, 0.05, 0.05, 0.35
    local = (
        -(case.w57 + case.w53) * (rho + sigma) * (rho - sigma) / 2
        + 2 * (case.w75 + case.w35) * (1 - rho) ** 2
    )
    printed = (
        (case.w57 - case.w53)
        / 4
        * ((rho + sigma) * (d_rho - d_sigma) - (rho - sigma) * (d_rho + d_sigma))
    )
    a = 1e-4
    assert 2 * excess(a / 2) - excess(a) == pytest.approx(printed, abs=1e-7)
    assert abs(printed) > WRONG


@pytest.mark.parametrize("sites", SIZES)
def test_2_62_shock_random_walks_in_the_interior(walker: Case, sites: int) -> None:
    d1, d2 = shocks.hopping_rates(walker.gas, walker.z1, walker.z2)
    for k in range(1, sites):
        change = full_flow(walker, sites, shock(walker, sites, k))
        walk = (
            d1 * shock(walker, sites, k - 1)
            + d2 * shock(walker, sites, k + 1)
            - (d1 + d2) * shock(walker, sites, k)
        )
        assert size_of(change - walk) < walker.bound
        assert size_of(change) > WRONG * walker.gas.scale


@pytest.mark.parametrize("sites", SIZES)
def test_2_66_to_2_71_everything_cancels_but_the_shock_bond(walker: Case, sites: int) -> None:
    f, fp = charge_drive(walker.w)
    field = f * number(walker, "A") + fp * number(walker, "B")
    g1 = -(f + fp * walker.ratio * walker.z1**2) / walker.nu1  # (2.68)
    g2 = -(f + fp * walker.ratio * walker.z2**2) / walker.nu2  # (2.69)
    d1, d2 = shocks.hopping_rates(walker.gas, walker.z1, walker.z2)

    def tilde(i: int, state: Array) -> Array:  # (2.63)
        return (
            -act(pair_matrix(walker.w), i, sites, state)
            + act(field, i, sites, state)
            - act(field, i + 1, sites, state)
        )

    for k in range(1, sites):
        state = shock(walker, sites, k)
        for i in range(1, sites):
            if i != k:
                assert size_of(tilde(i, state)) < walker.bound  # (2.66)
        left = -act(end_matrix(walker, "left"), 1, sites, state) - act(field, 1, sites, state)
        right = -act(end_matrix(walker, "right"), sites, sites, state) + act(
            field, sites, sites, state
        )
        assert size_of(left - g1 * state) < walker.bound  # (2.64), (2.67)
        assert size_of(right + g2 * state) < walker.bound  # (2.65), (2.67)
        total = -tilde(k, state) - (g1 - g2) * state
        assert size_of(full_flow(walker, sites, state) - total) < walker.bound  # (2.70)
        rest = (
            -tilde(k, state)
            + (d1 + d2 - g1 + g2) * state
            - d1 * shock(walker, sites, k - 1)
            - d2 * shock(walker, sites, k + 1)
        )
        assert size_of(rest) < walker.bound  # (2.71)


def test_2_72_to_2_76_one_sided_shock() -> None:
    case = SHOCKS["one-sided"]
    d1, d2 = shocks.hopping_rates(case.gas, case.z1, case.z2)
    assert d2 == 0 == case.z2
    assert d1 == pytest.approx(case.w42 / case.nu1, rel=1e-13)
    f, fp = charge_drive(case.w)
    s = d1 + d2 + (f + fp * case.ratio * case.z1**2) / case.nu1 - f  # (2.164), g2 = -F at z2 = 0
    assert s / case.nu1 == pytest.approx(d1, rel=1e-12)  # (2.73), S = w42
    assert (case.w24, case.w37, case.w57) == (0, 0, 0)
    assert case.w86 == pytest.approx(case.w68, rel=1e-13)
    rho_a = case.gas.marginal(case.z1)[0]
    walk = shocks.ShockWalk(9, d1, d2, 0.0, 0.0)
    assert -walk.velocity == pytest.approx(case.w42 * rho_a, rel=1e-13)  # printed v_s is d1 - d2
    assert 2 * walk.diffusion == pytest.approx(case.w42 * rho_a, rel=1e-13)


@pytest.mark.parametrize("name", ["w24", "w37", "w57", "w86", "w42", "w35"])
def test_2_72_to_2_75_are_necessary_for_the_one_sided_shock(name: str) -> None:
    """Change one rate and keep (2.36) with w73: the walk survives only where no condition of
    (2.74), (2.75) names the rate."""
    case = SHOCKS["one-sided"]
    rates = {**case.w, name: case.w[name] + 0.2}
    rhs = (rates["w35"] * rates["w57"] - rates["w53"] * rates["w75"]) / (
        rates["w35"] + rates["w75"]
    )
    rates["w73"] = rates["w37"] - rates["w24"] + rates["w42"] - rates["w68"] + rates["w86"] + rhs
    model = charge_gas(rates, case.left, case.right)
    first, second = model.marginal(case.z1), model.marginal(case.z2)
    assert np.abs(shocks.bond_residual(model, case.z1)).max() < 1e-13
    # nine bond equations with the best d1, d2, ends assumed to hold the two fugacities
    d1, d2 = shocks.hopping_rates(model, case.z1, case.z2)
    field = shocks.divergence_field(model)
    here = np.kron(first, second)
    rest = (
        model.bulk @ here
        - (np.subtract.outer(field, field).ravel() - field @ first + field @ second) * here
        - d1 * (np.kron(second, second) - here)
        - d2 * (np.kron(first, first) - here)
    )
    holds = name in ("w42", "w35")
    assert (np.abs(rest).max() < 1e-13) == holds
    assert holds or np.abs(rest).max() > WRONG


def test_2_77_2_78_PT_invariance_of_the_one_sided_model() -> None:
    r, w53, w42 = 0.4, 0.7, 1.3
    rates = {
        "w42": w42,
        "w53": w53,
        "w75": r * w53,
        "w35": r * 0.0,
        "w73": w42 - w53,
        "w86": 0.5,
        "w68": 0.5,
    }
    model = charge_gas(rates, {}, {})
    assert model.ratio == pytest.approx(r, rel=1e-15)
    assert np.abs(shocks.bond_residual(model, 0.8)).max() < 1e-15
    wrong = charge_gas({**rates, "w73": w42}, {}, {})
    assert np.abs(shocks.bond_residual(wrong, 0.8)).max() > WRONG


def test_2_132_to_2_142_appendix_A_with_the_sign_of_2_133(case: Case) -> None:
    """(2.133) prints the matrix of -h~; its kernel conditions (2.136)-(2.142) are right."""
    w, z, r = case, case.z1, case.ratio
    f, fp = charge_drive(case.w)
    theta1, theta2 = f - fp + w.w53 + w.w73, -f + fp + w.w37 + w.w57  # (2.134), (2.135)
    printed = np.zeros((9, 9))
    printed[1, 1], printed[1, 3] = -f - w.w42, w.w24
    printed[3, 1], printed[3, 3] = w.w42, f - w.w24
    printed[2, 2], printed[2, 4], printed[2, 6] = -theta1, w.w35, w.w37
    printed[4, 2], printed[4, 4], printed[4, 6] = w.w53, -(w.w35 + w.w75), w.w57
    printed[6, 2], printed[6, 4], printed[6, 6] = w.w73, w.w75, -theta2
    printed[5, 5], printed[5, 7] = fp - w.w86, w.w68
    printed[7, 5], printed[7, 7] = w.w86, -fp - w.w68
    field = f * number(case, "A") + fp * number(case, "B")
    one = np.eye(3)
    tilde = -pair_matrix(case.w) + np.kron(field, one) - np.kron(one, field)  # (2.63)
    assert np.abs(tilde + printed).max() < case.bound
    assert np.abs(tilde - printed).max() > WRONG
    measure = product([case.weights1] * 2)
    assert size_of(tilde @ measure) < case.bound  # (2.132)
    m = r * z**2
    assert (f + w.w42 - w.w24) * z == 0  # (2.136), (2.138)
    assert (-fp + w.w86 - w.w68) * m == 0  # (2.137), (2.139)
    for value in (
        (w.w37 - theta1) * m + w.w35 * z**2,
        (w.w73 - theta2) * m + w.w75 * z**2,
        (w.w53 + w.w57) * m - (w.w35 + w.w75) * z**2,
    ):  # (2.140)-(2.142)
        assert abs(value) < case.bound


@pytest.mark.parametrize("sites", SIZES)
def test_2_132_2_145_to_2_149_ends(case: Case, sites: int) -> None:
    f, fp = charge_drive(case.w)
    z, r = case.z1, case.ratio
    g = -(f + fp * r * z**2) / case.nu1
    m = r * z**2
    assert case.alpha1 + case.alpha2 - case.gamma1 * z - case.gamma2 * m == pytest.approx(
        f + g, abs=10 * case.bound
    )  # (2.147)
    assert -case.alpha1 + (case.gamma1 + case.alpha3) * z - case.gamma3 * m == pytest.approx(
        g * z, abs=10 * case.bound
    )  # (2.148)
    assert -case.alpha2 - case.alpha3 * z + (case.gamma2 + case.gamma3) * m == pytest.approx(
        (fp + g) * m, abs=10 * case.bound
    )  # (2.149)
    measure = product([case.weights1] * sites)
    field = f * number(case, "A") + fp * number(case, "B")
    both = (
        -act(end_matrix(case, "left"), 1, sites, measure)
        - act(field, 1, sites, measure)
        - act(end_matrix(case, "right"), sites, sites, measure)
        + act(field, sites, sites, measure)
    )
    assert size_of(both) < 2 * case.bound  # (b~1 + b~L)|P> = 0


def nine_equations(case: Case) -> tuple[dict[str, float], float]:
    """(2.155)-(2.163) with the d1, d2 and S of the case."""
    d1, d2 = shocks.hopping_rates(case.gas, case.z1, case.z2)
    f, fp = charge_drive(case.w)
    z1, z2, r = case.z1, case.z2, case.ratio
    g1 = -(f + fp * r * z1**2) / case.nu1
    g2 = -(f + fp * r * z2**2) / case.nu2
    s = d1 + d2 - g1 + g2
    a, b = d1 * case.nu1 / case.nu2, d2 * case.nu2 / case.nu1
    delta = case.w24 - case.w42 + case.w68 - case.w86 + case.w73 - case.w37
    w = case
    return {
        "2.155": s - a - b,
        "2.156": (s - w.w35 - w.w75) * z1 * z2
        + w.w53 * r * z2**2
        + w.w57 * r * z1**2
        - a * z2**2
        - b * z1**2,
        "2.157": s - a * z2**2 / z1**2 - b * z1**2 / z2**2,
        "2.158": (s - w.w24) * z2 + w.w24 * z1 - a * z2 - b * z1,
        "2.159": (s - w.w42) * z1 + w.w42 * z2 - a * z2 - b * z1,
        "2.160": (s - w.w68) * z2 + w.w68 * z1 - a * z2**2 / z1 - b * z1**2 / z2,
        "2.161": (s - w.w86) * z1 + w.w86 * z2 - a * z2**2 / z1 - b * z1**2 / z2,
        "2.162": (s - w.w37 - w.w53 - delta) * r * z2**2
        + w.w35 * z1 * z2
        + w.w37 * r * z1**2
        - a * r * z2**2
        - b * r * z1**2,
        "2.163": (s - w.w73 - w.w57 + delta) * r * z1**2
        + w.w75 * z1 * z2
        + w.w73 * r * z2**2
        - a * r * z2**2
        - b * r * z1**2,
    }, s


@pytest.mark.parametrize("equation", [f"2.{n}" for n in range(155, 164)])
def test_2_155_to_2_164_nine_equations_of_the_two_sided_shock(equation: str) -> None:
    case = SHOCKS["two-sided"]
    assert abs(nine_equations(case)[0][equation]) < 10 * case.bound


def test_2_155_to_2_163_are_the_bond_equations_off_the_manifold_too(case: Case) -> None:
    """Away from every solution each printed left side is the bond residual of its pair."""
    z1, z2 = 0.6, 0.9
    other = type(case)(case.w, case.left, case.right, z1, z2, case.ratio, case.gas)
    values, _ = nine_equations(other)
    model = case.gas
    first, second, field = model.marginal(z1), model.marginal(z2), shocks.divergence_field(model)
    d1, d2 = shocks.hopping_rates(model, z1, z2)
    here = np.kron(first, second)
    # rows of (2.71), multiplied by nu1 nu2
    rest = (
        -other.nu1
        * other.nu2
        * (
            -model.bulk @ here
            + (np.subtract.outer(field, field).ravel() - field @ first + field @ second) * here
            + d1 * (np.kron(second, second) - here)
            + d2 * (np.kron(first, first) - here)
        )
    )
    rows = {"2.155": 0, "2.156": 4, "2.158": 1, "2.159": 3, "2.162": 2, "2.163": 6}
    for equation, row in rows.items():
        assert values[equation] == pytest.approx(rest[row], abs=100 * case.bound)
        assert abs(rest[row]) > 1e-4
    r = case.ratio
    assert values["2.157"] * r**2 * z1**2 * z2**2 == pytest.approx(rest[8], abs=100 * case.bound)
    assert values["2.160"] * r * z1 * z2 == pytest.approx(rest[5], abs=100 * case.bound)
    assert values["2.161"] * r * z1 * z2 == pytest.approx(rest[7], abs=100 * case.bound)


def test_2_165_to_2_174_two_sided_family_with_2_173_corrected() -> None:
    case = SHOCKS["two-sided"]
    p, q, r, x = case.w24, case.w42, case.ratio, case.z2 / case.z1
    d1, d2 = shocks.hopping_rates(case.gas, case.z1, case.z2)
    assert min(d1, d2) > 0.1  # the family the misprint hides
    assert case.w68 == pytest.approx(p, abs=case.bound)  # (2.165)
    assert case.w86 == pytest.approx(q, abs=case.bound)  # (2.166)
    assert p / q == pytest.approx(x**2, rel=1e-13)  # (2.167)
    assert nine_equations(case)[1] == pytest.approx(p + q, abs=10 * case.bound)  # (2.168)
    assert d1 == pytest.approx(q * case.nu2 / case.nu1, abs=case.bound)  # (2.169)
    assert d2 == pytest.approx(p * case.nu1 / case.nu2, abs=case.bound)  # (2.170)
    root = np.sqrt(p / q)
    assert (p - q) * (1 - case.w37 / p) * r + case.w35 * (1 / root - 1) == pytest.approx(
        0, abs=10 * case.bound
    )  # (2.171)
    assert (q - p) * (1 - case.w73 / q) * r + case.w75 * (root - 1) == pytest.approx(
        0, abs=10 * case.bound
    )  # (2.172)
    reactions = case.w53 * (root - 1) + case.w57 * (1 / root - 1)
    assert (np.sqrt(p) - np.sqrt(q)) ** 2 / r + reactions == pytest.approx(0, abs=30 * case.bound)
    assert abs((p + q) / r + reactions) > WRONG * case.gas.scale  # (2.173) as printed
    assert r == pytest.approx(x / (1 + x) ** 2, rel=1e-13)  # (2.174)


def test_2_174_and_the_printed_2_173_would_indeed_force_X_to_vanish() -> None:
    """Text after (2.174): true of the misprint, false of the equation."""
    for x in (0.6, 0.9, 1.1, 1.9):
        p, q, r = x**2, 1.0, x / (1 + x) ** 2

        # (2.171), (2.172) and w35 + w75 = r (w53 + w57) leave (2.36) to decide
        def excess(
            constant: float, x: float = x, p: float = p, q: float = q, r: float = r
        ) -> float:
            w53 = 0.7
            w57 = (constant / r + w53 * (x - 1)) / (1 - 1 / x)
            total = r * (w53 + w57)
            w35, w75 = 0.4 * total, 0.6 * total
            w37 = p * (1 + w35 * (1 / x - 1) / (r * (p - q)))
            w73 = q * (1 + w75 * (x - 1) / (r * (q - p)))
            return 2 * (p - q) + w73 - w37 - (w35 * w57 - w53 * w75) / total

        assert excess((x - 1) ** 2) == pytest.approx(0, abs=1e-12)
        assert abs(excess(p + q)) > 0.1


def test_2_175_2_176_boundary_equations_with_delta3() -> None:
    case = SHOCKS["two-sided"]
    p, q, r = case.w24, case.w42, case.ratio
    z1, z2 = case.z1, case.z2
    g1 = (p - q) / case.nu1 * (r * z1**2 - 1)
    g2 = (p - q) / case.nu2 * (r * z2**2 - 1)
    left = -case.alpha1 / z1 - case.gamma3 * r * z1 + case.gamma1 + case.alpha3
    right = case.delta1 / z2 + case.beta3 * r * z2 - (case.beta1 + case.delta3)
    printed = case.delta1 / z2 + case.beta3 * r * z2 - (case.beta1 + case.delta2)
    assert left == pytest.approx(g1, abs=10 * case.bound)
    assert right == pytest.approx(g2, abs=10 * case.bound)
    assert abs(printed - g2) > WRONG * case.gas.scale


def test_2_165_2_166_with_p_zero_do_not_close() -> None:
    """p = 0 in (2.165), (2.166) asks w68 = 0, w86 = q; the shock needs w86 = w68 (2.75)."""
    case = SHOCKS["one-sided"]
    rates = {**case.w, "w68": 0.0, "w86": case.w42}
    rates["w73"] = case.w73 + rates["w86"]  # keeps (2.36)
    model = charge_gas(rates, case.left, case.right)
    assert np.abs(shocks.bond_residual(model, case.z1)).max() < 1e-13
    broken = [
        c for c in shocks.random_walk_conditions(model, case.z1, 0.0) if abs(c.residual) > 1e-3
    ]
    assert [c.equation for c in broken] == ["2.75"]
    assert shocks.random_walk_residuals(model, 4, case.z1, 0.0)[1:-1].min() > WRONG


@pytest.mark.parametrize("sites", SIZES)
def test_closure_at_the_ends_and_stationary_mixture(walker: Case, sites: int) -> None:
    """W|0> = e0(|1> - |0>), W|L> = eL(|L-1> - |L>), and (2.117) for this family."""
    e0, el = shocks.end_rates(walker.gas, walker.z1, walker.z2)
    first = full_flow(walker, sites, shock(walker, sites, 0))
    last = full_flow(walker, sites, shock(walker, sites, sites))
    step = shock(walker, sites, 1) - shock(walker, sites, 0)
    back = shock(walker, sites, sites - 1) - shock(walker, sites, sites)
    assert size_of(first - e0 * step) < walker.bound
    assert size_of(last - el * back) < walker.bound
    d1, d2 = shocks.hopping_rates(walker.gas, walker.z1, walker.z2)
    weights = shocks.ShockWalk(sites, d1, d2, e0, el).stationary_mixture()
    mixture = sum(p * shock(walker, sites, k) for k, p in enumerate(weights))
    assert size_of(full_flow(walker, sites, mixture)) < 10 * walker.bound
    solved = generator.stationary_state(walker.gas, sites, shock(walker, sites, 1))
    assert size_of(solved - mixture) < 1e-11


def test_one_sided_end_relations_of_the_errata() -> None:
    case = SHOCKS["one-sided"]
    z, r, nu = case.z1, case.ratio, case.nu1
    e0, el = shocks.end_rates(case.gas, case.z1, case.z2)
    e = (case.beta1 * z + case.beta2 * r * z**2) / (z + r * z**2)
    assert el == pytest.approx(e + case.w42 / nu, rel=1e-12)  # the bulk adds d1 to the end's own e
    assert case.beta1 - e + case.delta3 - case.beta3 * r * z == pytest.approx(0, abs=1e-12)
    assert case.alpha1 == pytest.approx(e0 * z / nu, rel=1e-12)
    assert case.alpha2 == pytest.approx(e0 * r * z**2 / nu, rel=1e-12)
    assert (case.delta1, case.delta2) == (0, 0)


def test_no_shock_between_equal_fugacities(case: Case) -> None:
    with pytest.raises(RateError, match="there is no shock"):
        shocks.hopping_rates(case.gas, 0.7, 0.7)

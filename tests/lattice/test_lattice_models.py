"""Definition of models: what is accepted, what is refused and with which words."""

import math
from typing import Any

import numpy as np
import pytest

from lattice.completion import NoNonnegativeRates, complete_shock
from lattice.models import (
    BULK_NAMES,
    READINGS,
    RateError,
    asep,
    bulk_matrix,
    charge_gas,
    internal_state_gas,
    pair_label,
)
from lattice.shocks import (
    ShockWalk,
    bond_residual,
    boundary_fugacity,
    end_rates,
    hopping_rates,
    random_walk_conditions,
    random_walk_residuals,
    stationarity_residual,
)
from tests.lattice.lattice_paper import (
    Case,
    present,
    reflected,
    shock_charge,
    shock_internal,
    stationary_charge,
    stationary_internal,
)


def test_2_5_2_7_2_9_three_readings_of_the_ten_rates() -> None:
    """One number, three texts: w57 is BA -> 00, 20 -> 11 and, cracking, B0 -> AA."""
    assert (pair_label(7, "charge"), pair_label(5, "charge")) == ("BA", "00")
    assert [READINGS[name][2] for name in READINGS] == [
        "B (charge -1)",
        "two particles",
        "B (mass 2)",
    ]
    particles = {"w24": "10 01", "w37": "20 02", "w86": "12 21", "w35": "11 02", "w57": "20 11"}
    for name, text in particles.items():
        for number, pair in zip((int(name[2]), int(name[1])), text.split(), strict=True):
            assert 3 * int(pair[0]) + int(pair[1]) + 1 == number  # (2.1)


@pytest.mark.parametrize(
    ("rates", "message"),
    [
        ({"w24": -1.0}, "rate w24 = -1.0: must not be negative"),
        ({"w24": math.nan}, "rate w24 = nan: must be finite"),
        ({"w24": math.inf}, "rate w24 = inf: must be finite"),
        ({"w24": "1"}, "rate w24 = '1': must be a number"),
        ({"w24": True}, "rate w24 = True: must be a number"),
        ({"w21": 1.0}, r"rate w21 \(AA -> A0\) breaks the conservation law"),
        ({"w99": 1.0}, "unknown rate 'w99'"),
        ({"speed": 1.0}, "unknown rate 'speed'; the charge family has w24"),
        ({}, "every rate is zero"),
        ({"w35": 1.0}, r"w53 = w57 = 0 with w35 \+ w75 > 0"),
    ],
)
def test_bad_charge_rates(rates: dict[str, Any], message: str) -> None:
    with pytest.raises(RateError, match=message):
        charge_gas(rates)


@pytest.mark.parametrize(
    ("rates", "message"),
    [
        ({"h1": 1.0}, "c, the ratio of B to A .* is missing"),
        ({"h1": 1.0, "c": -0.5}, "rate c = -0.5: must not be negative"),
        ({"h1": 1.0, "w24": 1.0, "c": 1.0}, "not both"),
        ({"w42": 1.0}, "is not fixed by these rates: give c"),
        ({"w25": 1.0}, r"rate w25 \(AA -> 0A\) breaks the conservation law"),
        ({"h7": 1.0, "c": 1.0}, "unknown rate 'h7'"),
    ],
)
def test_bad_internal_state_rates(rates: dict[str, Any], message: str) -> None:
    with pytest.raises(RateError, match=message):
        internal_state_gas(rates)


def test_bad_boundaries() -> None:
    with pytest.raises(
        RateError, match="inconsistent boundaries: rates given at the left end only"
    ):
        charge_gas({"w24": 1.0}, {"alpha1": 1.0})
    with pytest.raises(RateError, match=r"rate alpha1 = -2\.0: must not be negative"):
        charge_gas({"w24": 1.0}, {"alpha1": -2.0}, {})
    with pytest.raises(RateError, match="unknown rate 'beta1'"):
        charge_gas({"w24": 1.0}, {"beta1": 1.0}, {})
    with pytest.raises(RateError, match="alpha2 lets B in"):
        charge_gas({"w24": 1.0}, {"alpha2": 1.0}, {})


def test_ratio_of_24_free_rates() -> None:
    """Without PT invariance c balances the conversions, beside a vacancy or between particles."""
    rng = np.random.default_rng(4)
    names = ("w32", "w34", "w72", "w74", "w23", "w27", "w43", "w47")
    w = {name: float(rng.uniform(0.5, 1)) for name in names}
    gain = w["w32"] + w["w34"] + w["w72"] + w["w74"]
    assert internal_state_gas(w).ratio == pytest.approx(gain / (sum(w.values()) - gain), rel=1e-14)
    w = {name: float(rng.uniform(0.5, 1)) for name in ("w65", "w85", "w95", "w96", "w56", "w69")}
    model = internal_state_gas(w)
    p = model.marginal(2.0)
    flow_b = (model.bulk @ np.kron(p, p)).reshape(3, 3)
    assert flow_b[2].sum() + flow_b[:, 2].sum() == pytest.approx(0, abs=1e-15)


def test_pt_rates_and_24_rates_define_the_same_model() -> None:
    case = stationary_internal()
    both = internal_state_gas(case.w, case.left, case.right)
    assert np.abs(both.bulk - case.gas.bulk).max() < 1e-14
    assert both.ratio == pytest.approx(case.ratio, rel=1e-14)


def test_reflection_reverses_the_current() -> None:
    case = shock_charge("two-sided")
    mirror = reflected(case.gas)
    assert mirror.current(0.8) == pytest.approx(-case.gas.current(0.8), abs=1e-15)
    back = random_walk_residuals(mirror, 4, case.z2, case.z1)
    assert back.max() < 1e-13


@pytest.mark.parametrize("kind", ["one-sided", "two-sided"])
def test_boundary_fugacity_finds_what_the_ends_hold(kind: str) -> None:
    case = shock_charge(kind)
    assert boundary_fugacity(case.gas, "left") == pytest.approx(case.z1, rel=1e-9)
    assert boundary_fugacity(case.gas, "right") == pytest.approx(case.z2, rel=1e-9, abs=1e-9)


def test_boundary_fugacity_refuses_inconsistent_ends() -> None:
    case = shock_charge("two-sided")
    model = charge_gas(case.w, {**case.left, "alpha3": 1.7}, case.right)
    with pytest.raises(RateError, match=r"inconsistent boundaries: no fugacity .* left end"):
        boundary_fugacity(model, "left")
    with pytest.raises(RateError, match="give z1"):
        boundary_fugacity(charge_gas(case.w), "left")


def test_asep_reservoirs_hold_the_textbook_densities() -> None:
    """gamma = delta = 0: z/(1+z) = alpha/p' with rho(1 - rho)(p - q) = alpha (1 - rho)."""
    model = asep(1.0, 0.25, 0.3, 0.6)
    z1, z2 = boundary_fugacity(model, "left"), boundary_fugacity(model, "right")
    assert z1 / (1 + z1) == pytest.approx(0.3 / 0.75, rel=1e-9)
    assert 1 - z2 / (1 + z2) == pytest.approx(0.6 / 0.75, rel=1e-9)


@pytest.mark.parametrize(
    ("x", "exists"),
    [
        (0.49, False),
        (0.5, True),
        (0.7, True),
        (1.4, True),
        (2.0, True),
        (2.01, False),
    ],
)
def test_two_sided_family_has_nonnegative_rates_for_X_from_half_to_two(
    x: float, exists: bool
) -> None:
    if not exists:
        with pytest.raises(NoNonnegativeRates, match="no nonnegative rates complete"):
            complete_shock("charge", 0.7, 0.7 * x, {"w42": 1.0}, ends=False)
        return
    model = complete_shock("charge", 0.7, 0.7 * x, {"w42": 1.0})
    rates = model.rates
    assert min([*rates.values(), *model.left.values(), *model.right.values()]) >= 0
    assert random_walk_residuals(model.gas(), 5, model.z1, model.z2).max() < 1e-13
    r = x / (1 + x) ** 2  # the closed form of the errata
    assert rates["w57"] == pytest.approx(x * rates["w53"] + (x - 1) * (1 + x) ** 2, abs=1e-11)
    assert rates["w35"] + rates["w75"] == pytest.approx(
        r * (rates["w53"] + rates["w57"]), abs=1e-11
    )
    assert rates["w37"] == pytest.approx(x**2 - (1 + x) * rates["w35"], abs=1e-11)
    assert rates["w73"] == pytest.approx(1 - (1 + x) * rates["w75"] / x, abs=1e-11)


def test_completion_keeps_what_is_given_and_can_leave_PT_invariance() -> None:
    given = {"w42": 0.3, "w74": 0.9, "c": 0.6}
    model = complete_shock("internal-state", 1.2, 0.5, given, left={"alpha3": 0.25})
    assert {name: model.rates[name] for name in given} == given
    assert model.left["alpha3"] == 0.25
    assert model.rates["w74"] != pytest.approx(0.6 * model.rates["w23"])
    conditions = random_walk_conditions(model.gas(), 1.2, 0.5)  # with 24 free rates
    assert [c.equation for c in conditions] == ["2.111", "2.109", "2.110"]
    assert max(abs(c.residual) for c in conditions) < 1e-12
    assert random_walk_residuals(model.gas(), 5, 1.2, 0.5).max() < 1e-13
    assert stationarity_residual(model.gas(), 5, 1.2, 0.5) < 1e-13


def test_mirrored_one_sided_shock() -> None:
    model = complete_shock("charge", 0.0, 0.8, {"w24": 1.2}, ratio=0.4)
    assert [model.rates[name] for name in ("w42", "w73", "w53")] == [0, 0, 0]
    assert random_walk_residuals(model.gas(), 5, 0.0, 0.8).max() < 1e-13


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("charge", 0.5, 0.5, {}), "must be nonnegative and different"),
        (("charge", 0.5, 0.0, {"w42": 1.0}), "give ratio"),
        (("internal-state", 0.5, 1.0, {"h1": 1.0}), "c, the ratio"),
        (("charge", 0.5, 0.7, {"w42": -1.0}), "must not be negative"),
        (("charge", 0.5, 0.7, {"w11": 1.0}), "unknown rate"),
    ],
)
def test_completion_refuses(arguments: tuple[Any, ...], message: str) -> None:
    with pytest.raises(RateError, match=message):
        complete_shock(*arguments)


def test_completion_says_that_none_exists() -> None:
    with pytest.raises(NoNonnegativeRates, match="no nonnegative rates"):
        complete_shock("internal-state", 0.5, 1.5, {"h1": 0.1, "r2": 0.5, "c": 0.5})  # h2 = -0.15
    with pytest.raises(NoNonnegativeRates, match="closes at the ends"):
        complete_shock("charge", 0.8, 0.0, {"w42": 1.0}, ratio=0.5, right={"delta1": 0.1})


def test_off_manifold_by_one_rate_is_seen_at_every_length() -> None:
    case = shock_charge("two-sided")
    model = charge_gas({**case.w, "w37": case.w["w37"] + 0.01}, case.left, case.right)
    assert np.abs(bond_residual(model, case.z1)).max() > 1e-4
    for sites in (2, 4, 6):
        assert random_walk_residuals(model, sites, case.z1, case.z2)[1:-1].min() > 1e-5


@pytest.mark.parametrize(
    ("rates", "rest"),
    [
        ((0.5, 0.0, 0.3, 0.2), {0: 0.5 / 0.8, 1: 0.3 / 0.8}),  # left hops only: between 0 and 1
        ((0.0, 0.5, 0.3, 0.2), {6: 0.5 / 0.7, 5: 0.2 / 0.7}),
        ((0.5, 0.0, 0.0, 0.2), {0: 1.0}),
        ((0.5, 0.2, 0.0, 0.2), {0: 1.0}),
    ],
)
def test_walks_that_end_at_one_side(
    rates: tuple[float, float, float, float], rest: dict[int, float]
) -> None:
    weights = ShockWalk(6, *rates).stationary_mixture()
    expected = np.zeros(7)
    for k, weight in rest.items():
        expected[k] = weight
    assert weights == pytest.approx(expected, abs=1e-15)
    assert np.abs(ShockWalk(6, *rates).matrix() @ weights).max() < 1e-15


@pytest.mark.parametrize(
    "case",
    [shock_charge("one-sided"), shock_charge("two-sided"), shock_internal()],
    ids=["one-sided", "two-sided", "internal"],
)
def test_reservoirs_hold_their_density_and_close_the_shock(case: Case) -> None:
    model = case.gas.with_reservoirs(case.z1, case.z2)
    left = present(model.left)
    assert left[~np.eye(3, dtype=bool)].min() >= 0
    assert np.abs(left.sum(axis=0)).max() < 1e-14
    assert random_walk_residuals(model, 5, case.z1, case.z2).max() < 1e-13
    d1, d2 = hopping_rates(model, case.z1, case.z2)
    assert end_rates(model, case.z1, case.z2) == pytest.approx((d2, d1), abs=1e-12)


def test_reservoirs_need_no_shock() -> None:
    case = stationary_charge()
    model = case.gas.with_reservoirs(0.4, 1.3)
    assert stationarity_residual(model, 5, 0.4, 1.3) < 1e-13
    assert random_walk_residuals(model, 5, 0.4, 1.3)[1:-1].min() > 1e-3


def test_walk_that_can_rest_at_both_ends_has_no_unique_mixture() -> None:
    with pytest.raises(RateError, match="more than one place"):
        ShockWalk(6, 0.5, 0.4, 0.0, 0.0).stationary_mixture()


def test_random_walk_moves_and_spreads_as_its_rates_say() -> None:
    walk = ShockWalk(200, 0.4, 0.7, 0.7, 0.4)
    p = walk.distribution(100, 30.0)
    k = np.arange(201)
    assert walk.mean_position(100, 30.0) == pytest.approx(100 + walk.velocity * 30, rel=1e-10)
    assert p @ (k - 100 - walk.velocity * 30) ** 2 == pytest.approx(
        2 * walk.diffusion * 30, rel=1e-9
    )


def test_bulk_matrix_refuses_by_name() -> None:
    with pytest.raises(RateError, match="breaks the conservation law"):
        bulk_matrix("asep", {"w14": 1.0})
    assert set(BULK_NAMES["asep"]) == {"w23", "w32"}

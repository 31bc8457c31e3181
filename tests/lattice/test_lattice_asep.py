"""TASEP and ASEP: matrix product up to L = 1000, closed forms, phase diagram, exact engine."""

import itertools
from fractions import Fraction
from math import comb

import numpy as np
import pytest

from lattice import generator
from lattice import hydrodynamics as hydro
from lattice.matrix_product import asep_stationary
from lattice.models import RateError, asep, charge_gas, internal_state_gas


def tasep_norm(sites: int, alpha: Fraction, beta: Fraction) -> Fraction:
    """<W|(D + E)^L|V> of Derrida, Evans, Hakim and Pasquier (J. Phys. A 26, 1493 (1993)), exact."""
    if sites == 0:
        return Fraction(1)
    a, b = 1 / alpha, 1 / beta
    terms = (
        Fraction(k, sites)
        * comb(2 * sites - k - 1, sites - 1)
        * (b ** (k + 1) - a ** (k + 1))
        / (b - a)
        for k in range(1, sites + 1)
    )
    return sum(terms, Fraction(0))


@pytest.mark.parametrize("sites", [1, 10, 100, 1000])
@pytest.mark.parametrize(
    ("alpha", "beta"),
    [
        (Fraction(3, 10), Fraction(4, 5)),
        (Fraction(4, 5), Fraction(3, 10)),
        (Fraction(4, 5), Fraction(9, 10)),
        (Fraction(1, 5), Fraction(201, 1000)),
    ],
)
def test_tasep_current_against_exact_rationals(sites: int, alpha: Fraction, beta: Fraction) -> None:
    exact = tasep_norm(sites - 1, alpha, beta) / tasep_norm(sites, alpha, beta)
    current, _ = asep_stationary(sites, 1.0, 0.0, float(alpha), float(beta))
    assert current == pytest.approx(float(exact), rel=1e-13)


@pytest.mark.parametrize(
    "rates",
    [
        (1.0, 0.0, 0.3, 0.8, 0.0, 0.0),
        (1.0, 0.0, 0.2, 0.2, 0.0, 0.0),
        (1.0, 0.3, 0.5, 0.4, 0.1, 0.2),
        (2.0, 0.5, 0.1, 0.1, 0.3, 0.2),
        (1.0, 0.9, 0.3, 0.3, 0.3, 0.25),
        (0.3, 1.0, 0.2, 0.3, 0.5, 0.4),
    ],
)
@pytest.mark.parametrize("sites", [2, 3, 8, 10])
def test_matrix_product_against_the_full_generator(rates: tuple[float, ...], sites: int) -> None:
    p, q, alpha, beta, gamma, delta = rates
    model = asep(*rates)
    state = generator.stationary_state(model, sites, tolerance=1e-13)
    current, profile = asep_stationary(sites, p, q, alpha, beta, gamma, delta)
    assert generator.bond_currents(model, sites, state)[0] == pytest.approx(current, abs=2e-13)
    found = generator.site_probabilities(model, sites, state)[:, 1]
    assert np.abs(found - profile).max() < 1e-11


@pytest.mark.parametrize(("alpha", "beta"), list(itertools.product([0.2, 0.4, 0.7, 0.9], repeat=2)))
def test_phase_diagram_of_the_asep_at_a_thousand_sites(alpha: float, beta: float) -> None:
    """Bulk density and current of the matrix product obey the extremal-current principle."""
    p, q, sites = 1.0, 0.25, 1000
    rates = (alpha * 0.75, beta * 0.75)
    relation = hydro.current_relation(asep(p, q, *rates))
    left, right = np.array([alpha]), np.array([1 - beta])  # reservoir densities
    current, profile = asep_stationary(sites, p, q, *rates)
    predicted = float(relation.godunov_flux(left, right)[0])
    # corrections: 1/L in the maximal-current phase and on the coexistence line, else exponential
    critical = alpha >= 0.5 <= beta
    assert current == pytest.approx(
        predicted, abs=3 / sites if critical or alpha == beta else 1e-12
    )
    name = hydro.PHASES[int(hydro.phase(relation, left, right)[0])]
    middle = profile[sites // 2]
    if alpha == beta and alpha < 0.5:
        assert middle == pytest.approx(0.5, abs=0.01)  # the shock is anywhere: linear profile
        assert np.ptp(np.diff(profile[100:900])) < 1e-4
    elif critical:
        assert name == "maximal current"
        assert middle == pytest.approx(0.5, abs=0.01)
    elif alpha < beta:
        assert name == "left"
        assert middle == pytest.approx(alpha, abs=1e-10)
    else:
        assert name == "right"
        assert middle == pytest.approx(1 - beta, abs=1e-10)


def test_algebraic_profile_of_the_maximal_current_phase() -> None:
    """alpha = beta = 1: rho = 1/2 + (1 - 2x)/(2 sqrt(pi L x (1 - x))), x = k/L, 1 << k << L - k."""
    _, profile = asep_stationary(1000, 1.0, 0.0, 1.0, 1.0)
    k = np.arange(20, 400)
    x = k / 1000
    law = (1 - 2 * x) / (2 * np.sqrt(np.pi * 1000 * x * (1 - x)))
    assert profile[k - 1] - 0.5 == pytest.approx(law, rel=0.01)  # next order is 1/k


def test_refusals() -> None:
    with pytest.raises(RateError, match="p = q"):
        asep_stationary(10, 1.0, 1.0, 0.5, 0.5)
    with pytest.raises(RateError, match="must be positive"):
        asep_stationary(10, 1.0, 0.0, 0.0, 0.5)
    with pytest.raises(RateError, match=r"rate beta = -1\.0"):
        asep_stationary(10, 1.0, 0.0, 0.5, -1.0)
    with pytest.raises(RateError, match="singular"):
        asep_stationary(10, 1.0, 0.5, 0.5, 0.5, 0.5, 0.5)


@pytest.mark.parametrize("family", ["charge", "internal-state", "lumped"])
def test_three_state_models_contain_the_asep(family: str) -> None:
    """A in vacancies, vacancies in A, and A + B of a lumpable internal-state model, at L = 6."""
    p, q, alpha, beta, gamma, delta = 1.0, 0.3, 0.4, 0.5, 0.2, 0.1
    sites = 6
    current, profile = asep_stationary(sites, p, q, alpha, beta, gamma, delta)
    if family == "charge":  # state 0 is A: number 1 is A -> vacant
        model = charge_gas(
            {"w42": p, "w24": q},
            {"alpha1": gamma, "gamma1": alpha},
            {"delta1": beta, "beta1": delta},
        )
    elif family == "internal-state":
        model = internal_state_gas(
            {"h3": p, "h1": q, "c": 0.0},
            {"alpha1": alpha, "gamma1": gamma},
            {"delta1": delta, "beta1": beta},
        )
    else:  # p and q do not depend on the label (2.109, 2.110), nor do gamma and beta
        c = 0.5
        rates = {
            "h3": p - c * 0.2,
            "r4": 0.2,
            "h6": p - 0.2,
            "h1": q - c * 0.1,
            "r2": 0.1,
            "h2": q - 0.1,
            "r1": 0.3,
            "r3": 0.7,
            "r5": 0.2,
            "h4": 0.6,
            "h5": 0.1,
            "c": c,
        }
        model = internal_state_gas(
            rates,
            {"alpha1": alpha / 4, "alpha2": 3 * alpha / 4, "gamma1": gamma, "gamma2": gamma},
            {"delta1": delta, "beta1": beta, "beta2": beta, "delta3": 0.4},
        )
    start = generator.product_vector([model.marginal(1.0)] * sites)
    state = generator.stationary_state(model, sites, start)
    single = generator.site_probabilities(model, sites, state)
    present = single[:, 0] if family == "charge" else 1 - single[:, 0]
    assert np.abs(present - profile).max() < 1e-12
    assert generator.bond_currents(model, sites, state) == pytest.approx([current] * 5, abs=1e-12)

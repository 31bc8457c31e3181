"""Kinetic Monte Carlo against the exact engine, and the estimates of v_s and D_s.

Seeds are fixed, so a test either always passes or never does; bounds are quantiles of chi-square or
normal distributions at 1e-4 for the number of values compared.
"""

import numpy as np
import pytest
from scipy import stats

from lattice import generator, monte_carlo, shocks
from lattice.completion import ShockModel, complete_shock
from lattice.hydrodynamics import domain_wall
from lattice.matrix_product import asep_stationary
from lattice.models import RateError, asep, charge_gas
from tests.lattice.lattice_paper import (
    present,
    shock_charge,
    shock_internal,
    stationary_charge,
    stationary_internal,
)

CASES = {
    "charge": stationary_charge(1),
    "one-sided": shock_charge("one-sided"),
    "two-sided": shock_charge("two-sided"),
    "internal-state": stationary_internal(2),
    "internal-state shock": shock_internal(),
}


def sigma_bound(values: int) -> float:
    """Largest of `values` normal deviates, exceeded once in 10^4 cases."""
    return stats.norm.isf(0.5e-4 / values)


def test_alias_tables_hold_the_rates() -> None:
    model = CASES["charge"].gas
    tables = monte_carlo._tables(model)
    weight = tables.threshold.astype(float) / 2.0**60 / 16
    for kind, matrix in enumerate((model.bulk, present(model.left), present(model.right))):
        clocks = (1, *tables.clocks)[kind]
        for initial in range(len(matrix)):
            chances = np.zeros(16)
            np.add.at(chances, tables.target[kind, initial, :, 0], weight[kind, initial])
            np.add.at(chances, tables.target[kind, initial, :, 1], 1 / 16 - weight[kind, initial])
            rates = chances[: len(matrix)] * tables.clock * clocks
            rates[initial] = 0
            expected = np.where(np.arange(len(matrix)) == initial, 0, matrix[:, initial])
            assert rates == pytest.approx(expected, abs=1e-12)
            assert chances[len(matrix) :].max() < 1e-15


@pytest.mark.parametrize("name", CASES)
def test_profile_in_time_against_exact_evolution(name: str) -> None:
    """Occupations at two times from |2> on five sites, 20000 replicas: binomial errors."""
    case, sites, replicas = CASES[name], 5, 20_000
    times = [0.15, 0.8]
    z2 = case.z2 if case.z2 != case.z1 else 1.7
    initial = shocks.shock_marginals(case.gas, sites, 2, case.z1, z2)
    exact_states = generator.evolve(case.gas, sites, generator.product_vector(initial), times)
    run = monte_carlo.simulate(case.gas, initial, times, replicas, seed=11)
    for row, state in enumerate(exact_states):
        exact = generator.site_probabilities(case.gas, sites, state)
        error = np.sqrt(np.maximum(exact * (1 - exact), 1e-300) / replicas)
        pulls = (run.occupation[row] - exact) / error
        pulls = pulls[(exact > 1e-12) & (exact < 1 - 1e-12)]
        assert np.abs(pulls).max() < sigma_bound(30 * len(CASES))
        assert pulls.std() < 1.7  # wrong error bars would show here, far from any single outlier
    assert run.occupation[:, 2] != pytest.approx(initial[2], abs=1e-3)  # it has moved


@pytest.mark.parametrize("name", ["charge", "internal-state"])
def test_stationary_profile_and_current_within_error_bars(name: str) -> None:
    case, sites, replicas = CASES[name], 6, 64
    state = generator.stationary_state(case.gas, sites)
    initial = np.tile(case.gas.marginal(1.6 * case.z1), (sites, 1))
    run = monte_carlo.simulate(case.gas, initial, np.arange(20.0, 420.0, 0.5), replicas, seed=3)
    mean, error = run.profile()
    exact = generator.site_probabilities(case.gas, sites, state)
    t = np.abs((mean - exact) / error)
    assert t.max() < stats.t.isf(0.5e-4 / 36, replicas - 1)
    j, dj = run.mean_current()
    exact_j = generator.bond_currents(case.gas, sites, state)[0]
    assert abs(j - exact_j) < stats.t.isf(0.5e-4, replicas - 1) * dj
    assert dj < 0.02


def test_continuity_holds_in_every_trajectory() -> None:
    """Charge on site k changes by exactly what bond k - 1 brought in less what bond k took out."""
    case = CASES["charge"]
    initial = np.tile(case.gas.marginal(0.7), (40, 1))
    run = monte_carlo.simulate(case.gas, initial, [1.0, 6.0], 1, seed=5)
    carried = run.current[0] * 5.0
    gained = np.diff(case.gas.conserved[run.history], axis=0)[0]
    assert gained == pytest.approx(carried[:-1] - carried[1:], abs=1e-9)
    assert np.abs(carried).max() > 3


def test_ring_conserves_the_charge_and_carries_the_mean_field_current() -> None:
    case = CASES["charge"]
    ring = charge_gas(case.w)
    sites = 400
    initial = np.tile(ring.marginal(0.6), (sites, 1))
    run = monte_carlo.simulate(ring, initial, np.linspace(0, 40, 5), 24, seed=8)
    charge = ring.conserved[run.history].sum(axis=1)
    assert (charge == charge[0]).all()
    j, dj = run.mean_current()  # product measure of random charge: (2.48) on average
    assert abs(j - ring.current(0.6)) < stats.t.isf(0.5e-4, 23) * dj


def test_same_seed_same_numbers_whatever_the_threads() -> None:
    case = CASES["two-sided"]
    initial = shocks.shock_marginals(case.gas, 50, 25, case.z1, case.z2)
    evidence = monte_carlo.shock_evidence(case.gas, case.z1, case.z2)
    runs = [
        monte_carlo.simulate(case.gas, initial, [1.0, 2.0], 6, seed, evidence, workers)
        for seed, workers in ((4, 1), (4, 3), (5, 3))
    ]
    np.testing.assert_array_equal(runs[0].occupation, runs[1].occupation)
    np.testing.assert_array_equal(present(runs[0].positions), present(runs[1].positions))
    assert (runs[0].occupation != runs[2].occupation).any()


def test_tasep_of_a_thousand_sites_against_the_matrix_product() -> None:
    """Maximal-current phase, current within its error bar of the exact one."""
    model, sites = asep(1.0, 0.0, 0.8, 0.7), 1000
    exact, _ = asep_stationary(sites, 1.0, 0.0, 0.8, 0.7)
    initial = np.tile(model.marginal(1.0), (sites, 1))
    run = monte_carlo.simulate(model, initial, [4000.0, 8000.0], 8, seed=2)
    j, dj = run.mean_current()
    assert abs(j - exact) < stats.t.isf(0.5e-3, 7) * dj
    assert dj < 1e-3


def test_posterior_mean_against_the_sum() -> None:
    rng = np.random.default_rng(0)
    case = CASES["two-sided"]
    evidence = monte_carlo.shock_evidence(case.gas, case.z1, case.z2)
    state = rng.integers(0, 3, 300).astype(np.uint8)
    levels = np.concatenate([[0.0], np.cumsum(evidence[state])])
    weights = np.exp(levels - levels.max())
    expected = weights @ np.arange(301) / weights.sum()
    assert monte_carlo._posterior_mean(state, evidence) == pytest.approx(expected, rel=1e-12)


def test_evidence_of_a_state_that_one_phase_lacks_decides() -> None:
    case = CASES["one-sided"]
    evidence = monte_carlo.shock_evidence(case.gas, case.z1, 0.0)
    assert list(evidence[1:]) == [1000.0, 1000.0]
    state = np.zeros(20, dtype=np.uint8)
    state[7] = 1
    assert monte_carlo._posterior_mean(state, evidence) >= 8
    with pytest.raises(RateError, match="there is no shock"):
        monte_carlo.shock_evidence(case.gas, 0.5, 0.5)


@pytest.mark.parametrize("seed", range(3))
def test_walk_estimate_on_walks_with_known_rates_and_noisy_positions(seed: int) -> None:
    """Poisson hops at 0.7 right and 0.3 left, read with an error of 5 sites: v = 0.4, D = 0.5."""
    rng = np.random.default_rng(seed)
    times = np.linspace(0, 400, 41)
    hops = rng.poisson(0.7 * 10, (200, 40)) - rng.poisson(0.3 * 10, (200, 40))
    walkers = np.concatenate([np.zeros((200, 1)), hops.cumsum(axis=1)], axis=1)
    found = monte_carlo.estimate_walk(times, walkers + rng.normal(0, 5, walkers.shape))
    assert abs(found.velocity - 0.4) < 4 * found.velocity_error
    assert abs(found.diffusion - 0.5) < 4 * found.diffusion_error
    assert found.velocity_error == pytest.approx(
        np.sqrt(2 * 0.5 * 400 + 50) / 400 / 200**0.5, rel=0.2
    )
    assert found.diffusion_error < 0.05


def test_refusals() -> None:
    model = asep(1.0, 0.0, 0.5, 0.5)
    half = np.full((10, 2), 0.5)
    with pytest.raises(ValueError, match="increasing"):
        monte_carlo.simulate(model, half, [2.0, 1.0], 1, 0)
    with pytest.raises(ValueError, match="replicas = 0"):
        monte_carlo.simulate(model, half, [1.0], 0, 0)
    with pytest.raises(ValueError, match="2 states"):
        monte_carlo.simulate(model, np.full((10, 3), 1 / 3), [1.0], 1, 0)
    with pytest.raises(generator.TooLarge, match="bytes"):
        monte_carlo.simulate(model, half, np.arange(1e6), 10**12, 0)
    with pytest.raises(ValueError, match="need 2 replicas"):
        monte_carlo.estimate_walk(np.arange(3.0), np.zeros((1, 3)))


def strong(kind: str) -> ShockModel:
    """Shock models whose two phases differ much, so that the fit is good to about 10 sites."""
    if kind == "one-sided":
        return complete_shock("charge", 0.8, 0.0, {"w42": 1.0, "w86": 0.4}, ratio=0.5)
    if kind == "two-sided":
        return complete_shock("charge", 1.0, 2.0, {"w42": 1.0})
    return complete_shock("internal-state", 0.3, 3.0, {"h1": 0.1, "r2": 0.1, "r4": 0.3, "c": 0.7})


def tracked(
    model: ShockModel, sites: int, time: float, samples: int, replicas: int, seed: int
) -> tuple[monte_carlo.WalkEstimate, tuple[float, float]]:
    gas = model.gas()
    initial = shocks.shock_marginals(gas, sites, sites // 2, model.z1, model.z2)
    evidence = monte_carlo.shock_evidence(gas, model.z1, model.z2)
    times = np.linspace(0, time, samples)
    run = monte_carlo.simulate(gas, initial, times, replicas, seed, evidence)
    found = monte_carlo.estimate_walk(times, present(run.positions))
    return found, shocks.hopping_rates(gas, model.z1, model.z2)


def test_shock_of_two_thousand_sites_moves_at_its_exact_velocity() -> None:
    found, (d1, d2) = tracked(strong("one-sided"), 2000, 200, 21, 60, seed=6)
    assert abs(found.velocity - (d2 - d1)) < 4 * found.velocity_error
    assert abs(found.diffusion - (d1 + d2) / 2) < 4 * found.diffusion_error
    assert found.velocity_error < 0.01
    assert found.diffusion_error < 0.05


@pytest.mark.statistics
@pytest.mark.parametrize("kind", ["one-sided", "two-sided", "internal-state"])
def test_v_s_and_D_s_of_ten_thousand_sites(kind: str) -> None:
    found, (d1, d2) = tracked(strong(kind), 10_000, 500, 26, 60, seed=21)
    assert abs(found.velocity - (d2 - d1)) < 4 * found.velocity_error
    assert abs(found.diffusion - (d1 + d2) / 2) < 4 * found.diffusion_error
    assert found.velocity_error < 0.02
    assert found.diffusion_error < 0.2 * (d1 + d2) / 2  # informative


@pytest.mark.statistics
def test_domain_wall_diffusion_is_twice_too_large_for_the_two_sided_shock() -> None:
    """Monte Carlo tells the exact D_s = 2.02 from 4.26 of the rates j_i/(density jump)."""
    model = strong("two-sided")
    wall = domain_wall(model.gas(), 2000, model.z1, model.z2)
    found, (d1, d2) = tracked(model, 2000, 200, 21, 200, seed=22)
    assert wall.velocity == pytest.approx(d2 - d1, rel=1e-12)
    assert wall.diffusion > 2 * (d1 + d2) / 2
    assert abs(found.diffusion - (d1 + d2) / 2) < 4 * found.diffusion_error
    assert abs(found.diffusion - wall.diffusion) > 4 * found.diffusion_error

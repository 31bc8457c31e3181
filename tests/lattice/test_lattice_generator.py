"""The exact engine against loops over configurations and textbook cases."""

import itertools
from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.linalg import expm, null_space

from lattice import generator
from lattice.models import (
    BULK_NAMES,
    LEFT_NAMES,
    RIGHT_NAMES,
    Family,
    LatticeGas,
    asep,
    charge_gas,
    internal_state_gas,
)
from tests.lattice.lattice_paper import (
    present,
    random_distribution,
    shock_internal,
    stationary_charge,
)

Array = NDArray[np.float64]


def random_gas(family: Family, seed: int, periodic: bool = False) -> LatticeGas:
    rng = np.random.default_rng(seed)
    bulk = {name: float(rng.uniform(0.1, 1)) for name in BULK_NAMES[family]}
    left = None if periodic else {name: float(rng.uniform(0.1, 1)) for name in LEFT_NAMES}
    right = None if periodic else {name: float(rng.uniform(0.1, 1)) for name in RIGHT_NAMES}
    build = charge_gas if family == "charge" else internal_state_gas
    return build(bulk, left, right)


def by_loops(model: LatticeGas, sites: int) -> Array:
    """The generator from a visit to every configuration: slow and obvious."""
    s = model.size
    states = list(itertools.product(range(s), repeat=sites))
    index = {state: i for i, state in enumerate(states)}
    matrix = np.zeros((len(states),) * 2)

    def add(state: tuple[int, ...], new: Sequence[int], rate: float) -> None:
        matrix[index[tuple(new)], index[state]] += rate
        matrix[index[state], index[state]] -= rate

    for state in states:
        bonds = [(k, k + 1) for k in range(sites - 1)]
        if model.periodic:
            bonds.append((sites - 1, 0))
        for a, b in bonds:
            pair = s * state[a] + state[b]
            for target in range(s * s):
                if target != pair and model.bulk[target, pair]:
                    new = list(state)
                    new[a], new[b] = divmod(target, s)
                    add(state, new, model.bulk[target, pair])
        for site, end in ((0, model.left), (sites - 1, model.right)):
            for target in range(s):
                if end is not None and target != state[site]:
                    new = list(state)
                    new[site] = target
                    add(state, new, end[target, state[site]])
    return matrix


@pytest.mark.parametrize("periodic", [False, True])
@pytest.mark.parametrize("family", ["charge", "internal-state"])
@pytest.mark.parametrize("sites", [2, 3, 4, 5])
def test_generator_against_loops_over_configurations(
    family: Family, sites: int, periodic: bool
) -> None:
    model = random_gas(family, 3, periodic)
    expected = by_loops(model, sites)
    stored = generator.generator(model, sites)
    assert np.abs(stored.toarray() - expected).max() < 1e-14
    vector = random_distribution(sites)
    assert np.abs(generator.operator(model, sites) @ vector - expected @ vector).max() < 1e-14
    assert generator.exit_rate(model, sites) >= -expected.diagonal().min() - 1e-14


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10**6), st.sampled_from(["charge", "internal-state"]), st.booleans())
def test_probability_and_charge_are_conserved(seed: int, family: Family, periodic: bool) -> None:
    model = random_gas(family, seed, periodic)
    flow = generator.apply(model, 4, random_distribution(4, seed))
    assert abs(flow.sum()) < 1e-14
    if periodic:
        charge = (generator.site_probabilities(model, 4, flow) @ model.conserved).sum()
        assert abs(charge) < 1e-14


@pytest.mark.parametrize("family", ["charge", "internal-state"])
@pytest.mark.parametrize("stored", [True, False])
def test_stationary_state_against_the_null_space(family: Family, stored: bool) -> None:
    model = random_gas(family, 5)
    matrix = by_loops(model, 5)
    kernel = null_space(matrix)[:, 0]
    solved = generator.stationary_state(model, 5, stored=stored)
    assert np.abs(solved - kernel / kernel.sum()).sum() < 1e-11


def test_stationary_state_of_eight_sites_is_solved_by_iteration_to_its_residual() -> None:
    model = random_gas("charge", 6)
    stored = generator.stationary_state(model, 8)
    free = generator.stationary_state(model, 8, stored=False)
    bound = 1e-12 * generator.exit_rate(model, 8)
    assert np.abs(generator.apply(model, 8, stored)).sum() < bound
    assert np.abs(generator.apply(model, 8, free)).sum() < bound
    assert np.abs(stored - free).sum() < 1e-10
    assert stored.min() > 0


@pytest.mark.parametrize("family", ["charge", "internal-state"])
def test_evolution_against_the_matrix_exponential(family: Family) -> None:
    model = random_gas(family, 7)
    initial = random_distribution(4)
    times = [0.0, 0.3, 2.0, 15.0]
    evolved = generator.evolve(model, 4, initial, times)
    for time, state in zip(times, evolved, strict=True):
        exact = expm(by_loops(model, 4) * time) @ initial
        assert np.abs(state - exact).sum() < 1e-12
        assert state.min() >= 0


def test_evolution_refuses_times_out_of_order() -> None:
    with pytest.raises(ValueError, match="increasing"):
        generator.evolve(asep(1, 0, 1, 1), 3, np.ones(8) / 8, [2.0, 1.0])


def test_tasep_of_two_sites_by_hand() -> None:
    """alpha = beta = p = 1: weights of 00, 0A, A0, AA are 1, 1, 2, 1 over 5, J = 2/5."""
    model = asep(1, 0, 1, 1)
    state = generator.stationary_state(model, 2)
    assert state == pytest.approx(np.array([1, 1, 2, 1]) / 5, abs=1e-15)
    assert generator.bond_currents(model, 2, state) == pytest.approx([0.4], abs=1e-15)


def test_correlations_against_direct_sums() -> None:
    case = stationary_charge()
    state = random_distribution(4)
    table = state.reshape((3,) * 4)
    value = case.gas.conserved
    grids = np.meshgrid(value, value, value, value, indexing="ij")
    expected = np.array(
        [
            [
                (table * grids[i] * grids[j]).sum()
                - (table * grids[i]).sum() * (table * grids[j]).sum()
                for j in range(4)
            ]
            for i in range(4)
        ]
    )
    assert np.abs(generator.connected_correlation(case.gas, 4, state) - expected).max() < 1e-14
    uniform = generator.product_vector([case.gas.marginal(0.7)] * 4)
    off_diagonal = generator.connected_correlation(case.gas, 4, uniform)[~np.eye(4, dtype=bool)]
    assert np.abs(off_diagonal).max() < 1e-15


def test_stationary_current_is_uniform_and_fed_by_the_ends() -> None:
    model = shock_internal().gas
    sites = 5
    state = generator.stationary_state(model, sites)
    currents = generator.bond_currents(model, sites, state)
    assert np.ptp(currents) < 1e-14
    single = generator.site_probabilities(model, sites, state)
    injected = model.conserved @ present(model.left) @ single[0]
    assert injected == pytest.approx(currents[0], abs=1e-14)


def test_ring_has_one_stationary_state_per_charge() -> None:
    model = random_gas("charge", 9, periodic=True)
    with pytest.raises(generator.NoUniqueState, match="9 stationary states at L = 4"):
        generator.stationary_state(model, 4)
    one = np.zeros(81)
    one[1] = 1.0  # A A A 0, charge 3
    state = generator.stationary_state(model, 4, one)
    assert np.abs(generator.apply(model, 4, state)).sum() < 1e-13
    single = generator.site_probabilities(model, 4, state)
    assert (single @ model.conserved).sum() == pytest.approx(3, abs=1e-13)


def test_absorbing_configuration_is_found() -> None:
    """Only 0A -> A0 and a left end that turns all into A: everything ends in AAAA."""
    model = charge_gas({"w24": 1.0}, {"gamma1": 1.0, "gamma2": 0.0}, {"beta1": 0.5})
    start = generator.product_vector([np.array([0.3, 0.7, 0.0])] * 4)
    state = generator.stationary_state(model, 4, start)
    assert state[0] == pytest.approx(1, abs=1e-14)


def test_too_large_names_the_bytes() -> None:
    model = random_gas("charge", 1)
    with pytest.raises(generator.TooLarge, match=r"L = 40 needs [\d.]+e\+\d+ bytes"):
        generator.stationary_state(model, 40)
    with pytest.raises(generator.TooLarge, match=r"L = 30 sites needs [\d.]+e\+\d+ bytes"):
        generator.operator(model, 30)
    with pytest.raises(generator.TooLarge, match=r"stored generator at L = 30 needs"):
        generator.generator(model, 30)


def test_a_chain_has_two_sites() -> None:
    with pytest.raises(ValueError, match="at least 2 sites"):
        generator.generator(asep(1, 0, 1, 1), 1)

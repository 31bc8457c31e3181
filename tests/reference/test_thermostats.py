"""Thermostats: what each fixes exactly, detailed balance, and the printed exponent of (3.56)."""

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.stats import chi2, kstest

from lammps_inputs.scenes.bulk import Bulk
from lammps_inputs.system import Thermostat
from srd_driver.reference import ReferenceEngine, thermostats
from srd_driver.reference.collision import Cells
from srd_driver.reference.counter_random import CounterRandom, Stream

Array = NDArray[np.float64]


def one_row(dimension: int, layers: int, particles: int, random: np.random.Generator) -> Cells:
    shape = (4, layers) if dimension == 2 else (4, layers, 3)
    return Cells(shape, random.integers(0, np.prod(shape), particles))


@pytest.mark.parametrize("dimension", [2, 3])
def test_layer_sets_the_temperature_of_each_layer(dimension: int) -> None:
    random = np.random.default_rng(1)
    cells = one_row(dimension, 3, 120, random)
    heat = np.array([0.2, 1.0, 7.0])[cells.rows][cells.numbers]
    velocities = random.normal(size=(dimension, 120)) * np.sqrt(heat) + 2
    mean = cells.mean_velocity(velocities)
    thermostats.layer(velocities, cells)
    np.testing.assert_allclose(cells.mean_velocity(velocities), mean, atol=1e-14)
    relative = velocities - cells.of_particles(mean)
    energy = np.bincount(cells.rows, cells.sum((relative**2).sum(axis=0))) / 2
    particles = np.bincount(cells.rows, cells.occupation)
    occupied = np.bincount(cells.rows, cells.occupation > 0)
    np.testing.assert_allclose(energy, dimension / 2 * (particles - occupied), rtol=1e-13)


def test_layer_of_single_particles_is_left_alone() -> None:
    velocities = np.array([[1.0, -2.0], [0.5, 3.0]])
    before = velocities.copy()
    thermostats.layer(velocities, Cells((2, 1), np.array([0, 1])))
    np.testing.assert_array_equal(velocities, before)


def test_rescale_sets_the_total_energy() -> None:
    velocities = np.random.default_rng(1).normal(size=(3, 50)) * 3 + 1
    thermostats.rescale(velocities)
    assert 0.5 * np.sum(velocities**2) == pytest.approx(0.5 * 3 * 50, rel=1e-14)


def test_andersen_redraws_its_share_and_leaves_the_rest() -> None:
    velocities = np.full((2, 100_000), 9.0)
    thermostats.andersen(velocities, 2.0, CounterRandom(1, 0))
    redrawn = velocities[:, velocities[0] != 9.0]
    share = thermostats.ANDERSEN_FREQUENCY * 2.0
    # 4.5 standard errors, and Kolmogorov-Smirnov at 1e-5: false alarms below once in 1e4 changes
    assert abs(redrawn.shape[1] / 1e5 - share) < 4.5 * np.sqrt(share * (1 - share) / 1e5)
    assert all(kstest(component, "norm").pvalue > 1e-5 for component in redrawn)


def test_andersen_draws_the_documented_words() -> None:
    velocities, random = np.full((3, 500), 9.0), CounterRandom(1, 4)
    thermostats.andersen(velocities, 2.0, random)
    chosen = random.uniform(Stream.THERMOSTAT, 500)[0] < thermostats.ANDERSEN_FREQUENCY * 2.0
    normals = random.normal(Stream.THERMOSTAT, 500, block=1)[:3]
    np.testing.assert_array_equal(velocities, np.where(chosen, normals, 9.0))


def test_monte_carlo_draws_the_documented_words() -> None:
    # each cell on its own, in plain Python; the last has one particle and is left alone
    state = np.random.default_rng(2)
    numbers = np.append(np.repeat(np.arange(40), 4), 40)
    velocities = state.normal(size=(2, 161))
    expected, random = velocities.copy(), CounterRandom(1, 4)
    thermostats.monte_carlo(velocities, Cells((41, 1), numbers), random)
    accepted = 0
    for cell, u in enumerate(random.uniform(Stream.THERMOSTAT, 40).T):
        own = expected[:, 4 * cell : 4 * cell + 4]
        mean = own.mean(axis=1, keepdims=True)
        energy = ((own - mean) ** 2).sum() / 2
        scale = 1 + 0.1 * u[0] if u[1] < 0.5 else 1 / (1 + 0.1 * u[0])
        if u[2] < scale ** (2 * 3) * np.exp(-(scale**2 - 1) * energy):
            own[:] = mean + scale * (own - mean)
            accepted += 1
    assert 0 < accepted < 40
    np.testing.assert_allclose(velocities, expected, rtol=1e-12)


def test_maxwell_boltzmann_draws_the_documented_words() -> None:
    # each cell on its own, in plain Python: 3D with 1 to 4 particles has f = 0, 3, 6, 9
    state, random = np.random.default_rng(2), CounterRandom(1, 4)
    occupation = [1, 2, 3, 4, 2]
    numbers = np.repeat(np.arange(5), occupation)
    velocities = state.normal(size=(3, 12))
    expected = velocities.copy()
    thermostats.maxwell_boltzmann(velocities, Cells((5, 1, 1), numbers), random)
    uniforms = [random.uniform(Stream.THERMOSTAT, 5, block) for block in range(3)]
    normals = [random.normal(Stream.THERMOSTAT, 5, block) for block in range(3)]
    for cell, count in enumerate(occupation):
        own = expected[:, numbers == cell]
        mean = own.mean(axis=1, keepdims=True)
        exponentials, odd = divmod(3 * (count - 1), 2)
        drawn = sum(-np.log(1 - uniforms[k // 4][k % 4, cell]) for k in range(exponentials))
        if odd:
            drawn += normals[(exponentials + 3) // 4][0, cell] ** 2 / 2
        if count > 1:
            own = mean + (own - mean) * np.sqrt(2 * drawn / ((own - mean) ** 2).sum())
        expected[:, numbers == cell] = own
    np.testing.assert_allclose(velocities, expected, rtol=1e-12)


@pytest.mark.parametrize(("dimension", "particles"), [(2, 2), (2, 12), (3, 2), (3, 5)])
def test_maxwell_boltzmann_makes_the_canonical_distribution(dimension: int, particles: int) -> None:
    # from any energy at once; Kolmogorov-Smirnov at 1e-6 as below
    cells = Cells((10_000, 1), np.repeat(np.arange(10_000), particles))
    velocities = 7 * np.random.default_rng(4).normal(size=(dimension, 10_000 * particles))
    mean = cells.mean_velocity(velocities)
    thermostats.maxwell_boltzmann(velocities, cells, CounterRandom(1, 0))
    np.testing.assert_allclose(cells.mean_velocity(velocities), mean, atol=1e-13)
    energies = cells.sum(((velocities - cells.of_particles(mean)) ** 2).sum(axis=0))
    assert kstest(energies, chi2(dimension * (particles - 1)).cdf).pvalue > 1e-6


def test_acceptance_is_the_boltzmann_ratio() -> None:
    # the ratio of weights exp(-E) under v -> zeta v with its Jacobian zeta^f, and its inverse
    scale, energy, freedom = np.array([1.07]), np.array([6.3]), np.array([18.0])
    there = thermostats.acceptance(scale, energy, freedom)
    back = thermostats.acceptance(1 / scale, scale**2 * energy, freedom)
    np.testing.assert_allclose(there * back, 1, rtol=1e-14)
    np.testing.assert_allclose(there, scale**18 * np.exp(6.3 - scale**2 * 6.3), rtol=1e-13)


def scaled_energies(dimension: int, particles: int, rounds: int) -> Array:
    """Relative kinetic energies of cells after Monte Carlo scaling alone, for many rounds."""
    cells_count = 10_000
    cells = Cells((cells_count, 1), np.repeat(np.arange(cells_count), particles))
    velocities = np.random.default_rng(4).normal(size=(dimension, cells_count * particles))
    for step in range(rounds):
        thermostats.monte_carlo(velocities, cells, CounterRandom(1, step))
    relative = velocities - cells.of_particles(cells.mean_velocity(velocities))
    return cells.sum((relative**2).sum(axis=0))


@pytest.mark.parametrize(("dimension", "particles"), [(2, 2), (2, 5), (3, 4)])
def test_monte_carlo_keeps_the_canonical_distribution(dimension: int, particles: int) -> None:
    # 2 E is chi-squared with d (n - 1) degrees of freedom before and after; Kolmogorov-Smirnov at
    # 1e-6: a false alarm once in 3e5 changes of the generator
    energies = scaled_energies(dimension, particles, rounds=60)
    assert kstest(energies, chi2(dimension * (particles - 1)).cdf).pvalue > 1e-6


def test_printed_exponent_heats_a_2d_fluid(monkeypatch: pytest.MonkeyPatch) -> None:
    # (3.56) as printed has 3 (n - 1) in 2D as well: it drives to T = 3/2
    corrected = thermostats.acceptance
    monkeypatch.setattr(
        thermostats,
        "acceptance",
        lambda scale, energy, freedom: corrected(scale, energy, 3 * freedom / 2),
    )
    temperature = scaled_energies(2, 5, rounds=400).mean() / (2 * 4)
    assert temperature == pytest.approx(1.5, abs=0.03)


@pytest.mark.parametrize(
    "thermostat", ["layer", "monte_carlo", "maxwell_boltzmann", "rescale", "andersen"]
)
def test_temperature_returns_to_one(thermostat: Thermostat) -> None:
    scene = Bulk.make(
        length=16, width=16, density=5, thermostat=thermostat, collision_time=0.5, seed=2
    )
    engine = ReferenceEngine(scene)
    engine.fluid_velocities[:] *= 1.5
    engine.advance(150)
    temperatures = []
    for _ in range(100):
        engine.advance(1)
        temperatures.append(engine.fluid_temperature())
    # kinetic energy of 1280 particles fluctuates by 1 / sqrt(1280); bound of 4 of them, were all
    # samples one: a false alarm below once in 15 000 changes for each
    assert np.mean(temperatures) == pytest.approx(1, abs=4 / np.sqrt(1280))

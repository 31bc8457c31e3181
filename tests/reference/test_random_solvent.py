"""Random solvents: the permutation, what each conserves, and that local momentum is lost."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import chi2, kstest

from lammps_inputs.scenes.bulk import Bulk
from lammps_inputs.system import Hydrodynamics
from srd_driver.reference import ReferenceEngine, random_solvent
from srd_driver.reference.counter_random import CounterRandom, Stream

MASK = 2**64 - 1


def mix(z: int) -> int:
    z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & MASK
    z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & MASK
    return z ^ (z >> 31)


def feistel_in_plain_python(index: int, count: int, seed: int, step: int) -> int:
    """docs/reference.md, word by word, for one particle."""
    columns = next(c for c in range(1, count + 1) if c**2 >= count)
    rows = math.ceil(count / columns)
    words = CounterRandom(seed, step).words(Stream.SHUFFLE, 2)
    keys = [int(words[k % 4, k // 4]) for k in range(8)]
    while True:
        row, column = index // columns, index % columns
        for k in range(0, 8, 2):
            f = mix((column + keys[k]) & MASK) >> 32
            row = (row + f * rows // 2**32) % rows
            f = mix((row + keys[k + 1]) & MASK) >> 32
            column = (column + f * columns // 2**32) % columns
        index = row * columns + column
        if index < count:
            return index


@settings(deadline=None)
@given(count=st.integers(1, 2000), seed=st.integers(1, 2**31 - 1), step=st.integers(0, 10**9))
def test_permutation_is_a_bijection(count: int, seed: int, step: int) -> None:
    permutation = random_solvent.permutation(count, CounterRandom(seed, step))
    np.testing.assert_array_equal(np.sort(permutation), np.arange(count))


@pytest.mark.parametrize("count", [1, 2, 3, 16, 17, 64, 65, 1000])
def test_permutation_is_the_documented_one(count: int) -> None:
    permutation = random_solvent.permutation(count, CounterRandom(5, 7))
    expected = [feistel_in_plain_python(i, count, 5, 7) for i in range(count)]
    assert permutation.tolist() == expected


def test_every_particle_is_sent_everywhere_equally() -> None:
    # chi-squared of the counts of pi(i) = j over 2000 steps at 1e-6; and of pairs of neighbours
    # keeping their distance, which a shift would: false alarms once in 5e5 changes
    count, steps = 20, 2000
    table = np.zeros((count, count))
    distances = np.zeros(count)
    for step in range(steps):
        permutation = random_solvent.permutation(count, CounterRandom(1, step))
        table[np.arange(count), permutation] += 1
        distances[(permutation[1] - permutation[0]) % count] += 1
    expected = steps / count
    statistic = ((table - expected) ** 2 / expected).sum()
    assert chi2((count - 1) ** 2).sf(statistic) > 1e-6
    assert distances[0] == 0
    expected = steps / (count - 1)
    assert chi2(count - 2).sf(((distances[1:] - expected) ** 2 / expected).sum()) > 1e-6


def test_shuffle_only_reorders() -> None:
    velocities = np.random.default_rng(1).normal(size=(2, 333))
    before = velocities.copy()
    random_solvent.shuffle(velocities, CounterRandom(1, 0))
    permutation = random_solvent.permutation(333, CounterRandom(1, 0))
    np.testing.assert_array_equal(velocities, before[:, permutation])


def test_bath_has_the_maxwell_distribution() -> None:
    # Kolmogorov-Smirnov at 1e-6: a false alarm once in 300 000 changes of the generator. The
    # standard deviation is sqrt(kBT / m_f); the "variance" sqrt(kBT / m_f) of the paper is the
    # same number in its units, and would not be for another mass
    velocities = np.zeros((3, 50_000))
    random_solvent.bath(velocities, CounterRandom(1, 0))
    assert all(kstest(component, "norm").pvalue > 1e-6 for component in velocities)


@pytest.mark.parametrize(
    ("hydrodynamics", "kept"), [("on", True), ("shuffle", False), ("bath", False)]
)
def test_a_shear_wave_lives_only_with_hydrodynamics(
    hydrodynamics: Hydrodynamics, kept: bool
) -> None:
    scene = Bulk.make(
        length=16, width=32, shear_wave=1.0, hydrodynamics=hydrodynamics, thermostat="none"
    )
    engine = ReferenceEngine(scene)
    engine.advance(3)
    wave = np.sin(2 * np.pi * engine.fluid_positions[:, 1] / scene.width)
    amplitude = 2 * np.mean(wave * engine.fluid_velocities[:, 0])
    # decays by 1 % with hydrodynamics; the thermal noise is sqrt(2 / 5120) = 0.02
    assert (amplitude > 0.85) == kept
    assert kept or abs(amplitude) < 0.12


def test_shuffle_comes_after_rotation_and_thermostat() -> None:
    scenes = [
        Bulk.make(length=8, width=8, thermostat="layer", hydrodynamics=h, sampling_interval=1)
        for h in ("on", "shuffle")
    ]
    on, shuffled = (ReferenceEngine(scene) for scene in scenes)
    on.advance(1)
    shuffled.advance(1)
    permutation = random_solvent.permutation(len(on.fluid_velocities), CounterRandom(1, 0))
    np.testing.assert_array_equal(shuffled.fluid_velocities, on.fluid_velocities[permutation])


def test_shuffle_conserves_momentum_and_energy() -> None:
    engine = ReferenceEngine(Bulk.make(hydrodynamics="shuffle", thermostat="none"))
    momentum, energy = engine.mean_velocity(), engine.energy()
    engine.advance(20)
    np.testing.assert_allclose(engine.mean_velocity(), momentum, atol=1e-13)
    assert engine.energy() == pytest.approx(energy, rel=1e-12)

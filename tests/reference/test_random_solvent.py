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
from srd_driver.reference.counter_random import CounterRandom, Stream, split_mix


def affine_in_plain_python(index: int, count: int, seed: int, step: int) -> int:
    """docs/reference.md, word by word, for one particle."""
    prime = next(p for p in range(max(count, 2), 2 * count + 2) if all(p % d for d in range(2, p)))
    words = CounterRandom(seed, step).words(Stream.SHUFFLE, 1)[:, 0]
    u = [float(int(word) >> 11) / 2**53 for word in words]
    factor, term = 1 + math.floor(u[0] * (prime - 1)), math.floor(u[1] * prime)
    while True:
        index = (factor * index + term) % prime
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
    expected = [affine_in_plain_python(i, count, 5, 7) for i in range(count)]
    assert permutation.tolist() == expected


@pytest.mark.parametrize(("count", "prime"), [(23, 23), (20, 23)])
def test_every_pair_is_sent_everywhere_equally(count: int, prime: int) -> None:
    # counts of (pi(i), pi(j)) = (k, l) over 20 000 steps, for neighbours and others. Of a prime: by
    # chi-squared at 1e-6. Else each pair of places has its share 1 / (p (p - 1)) before what is
    # left goes through again, within 5.5 standard errors. False alarms once in 1e5 changes
    steps = 20_000
    images = np.array(
        [random_solvent.permutation(count, CounterRandom(1, step)) for step in range(steps)]
    )
    least = steps / (prime * (prime - 1))
    for i, j in ((0, 1), (7, 8), (3, 17), (0, count - 1)):
        table = np.bincount(count * images[:, i] + images[:, j], minlength=count**2)
        table = table.reshape(count, count)
        assert not table.diagonal().any()  # two in one place
        table = table[~np.eye(count, dtype=bool)]
        assert table.min() > least - 5.5 * math.sqrt(least)
        if count == prime:
            statistic = ((table - least) ** 2 / least).sum()
            assert chi2(table.size - 1).sf(statistic) > 1e-6


def test_shuffle_only_reorders() -> None:
    velocities = np.random.default_rng(1).normal(size=(2, 333))
    before = velocities.copy()
    random_solvent.shuffle(velocities, CounterRandom(1, 0))
    permutation = random_solvent.permutation(333, CounterRandom(1, 0))
    np.testing.assert_array_equal(velocities, before[:, permutation])


def test_split_mix_gives_what_its_authors_do() -> None:
    words = split_mix(np.array([1234567], np.uint64), np.arange(3, dtype=np.uint64))
    assert words.tolist() == [6457827717110365317, 3203168211198807973, 9817491932198370423]


def test_bath_has_the_maxwell_distribution() -> None:
    # Kolmogorov-Smirnov at 1e-6: a false alarm once in 300 000 changes of the generator. The
    # standard deviation is sqrt(kBT / m_f); the "variance" sqrt(kBT / m_f) of the paper is the
    # same number in its units, and would not be for another mass
    velocities = np.zeros((3, 50_000))
    random_solvent.bath(velocities, CounterRandom(1, 0))
    assert all(kstest(component, "norm").pvalue > 1e-6 for component in velocities)


def test_bath_forgets() -> None:
    # velocities and their squares, of a particle after a collision and after the next, of
    # neighbours, of components: correlations of 2e6 pairs of normals vary by 1 / sqrt(2e6) = 7e-4
    # (7e-4 for squares, normalised), and 26 of them stay within 5.5 sigma but once in 1e6 changes
    steps, particles = 40, 50_000
    velocities = np.empty((steps, 3, particles))
    for step in range(steps):
        random_solvent.bath(velocities[step], CounterRandom(1, step))
    for moment in (velocities, (velocities**2 - 1) / math.sqrt(2)):
        correlations = [
            *(np.mean(moment[1:, a] * moment[:-1, b]) for a in range(3) for b in range(3)),
            *(np.mean(moment[:, a, 1:] * moment[:, a, :-1]) for a in range(3)),
            *(np.mean(moment[:, a] * moment[:, (a + 1) % 3]) for a in range(3)),
        ]
        assert np.abs(correlations).max() < 5.5 / math.sqrt((steps - 1) * (particles - 1))
    assert abs(velocities.mean()) < 5.5 / math.sqrt(velocities.size)
    assert abs(np.mean(velocities**2) - 1) < 5.5 * math.sqrt(2 / velocities.size)
    assert abs(np.mean(velocities**4) - 3) < 5.5 * math.sqrt(96 / velocities.size)


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

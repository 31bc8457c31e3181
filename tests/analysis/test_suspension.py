"""Settling frames, diffusion, clusters, g(r) and normality of suspensions against known cases."""

import math
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from analysis import correlated_mean
from analysis.arrays import Array
from analysis.clusters import cluster_series, labels
from analysis.estimate import Estimate
from analysis.measures import radial_distribution as measured_g
from analysis.measures.suspension_diffusion import correlation_warnings
from analysis.normality import FALSE_ALARMS, normal_probability, normality
from analysis.radial_distribution import radial_distribution
from analysis.run_directory import RunDirectory
from analysis.sedimentation import richardson_zaki, settling_speeds
from analysis.suspension_diffusion import (
    CUBIC,
    infinite_box,
    outstanding_diffusion,
    suspension_diffusion,
)
from tests.analysis.known import known

BOX = (9.0, 9.0, 9.0)


def test_settling_speeds_are_those_of_their_frames() -> None:
    """Each is the colloids' velocity in the frame where what names it is at rest."""
    random = np.random.default_rng(1)
    colloids, fluid = random.normal(size=(2, 50))
    phi, masses = 0.2, (3.0, 5.0)  # of all colloids, of all fluid
    mean = (masses[0] * colloids + masses[1] * fluid) / sum(masses)
    speeds = settling_speeds(colloids, fluid, mean, phi)
    for frame in (0.0, 0.7):  # all are the same from a frame that moves
        moving = settling_speeds(colloids + frame, fluid + frame, mean + frame, phi)
        for name, series in vars(speeds).items():
            np.testing.assert_allclose(getattr(moving, name), series, atol=1e-14)
    flux = phi * colloids + (1 - phi) * fluid
    np.testing.assert_allclose(speeds.zero_volume_flux, colloids - flux, atol=1e-14)


def test_richardson_zaki_finds_the_exponent() -> None:
    phi = np.array([0.02, 0.07, 0.14, 0.21])
    random = np.random.default_rng(2)

    def speeds(noise: float) -> list[Estimate]:
        exact = 0.5 * (1 - phi) ** 3.5
        return [Estimate(float(v), 0.01) for v in exact + noise * random.normal(size=4)]

    exponents = np.array([known(richardson_zaki(phi, speeds(0.01))[1]) for _ in range(300)])
    assert exponents[:, 0].mean() == pytest.approx(3.5, abs=4 * exponents[:, 0].std() / 17)
    single, exponent = richardson_zaki(phi, speeds(0.0))
    assert single.value == pytest.approx(0.5)
    assert exponent.value == pytest.approx(3.5)
    with pytest.raises(ValueError, match="must be positive"):
        richardson_zaki(phi, [Estimate(-0.1, 0.01)] * 4)


def test_both_ways_give_d_of_persistent_walks_that_drift() -> None:
    """Velocities that keep a part c from step to step: D = v^2 dt (1 + c) / (2 (1 - c))."""
    random = np.random.default_rng(3)
    keep, interval, steps, walkers = 0.6, 0.5, 16000, 24
    velocity = np.empty((steps, walkers, 3))
    velocity[0] = random.normal(size=(walkers, 3))
    for step in range(1, steps):
        kick = random.normal(size=(walkers, 3))
        velocity[step] = keep * velocity[step - 1] + math.sqrt(1 - keep**2) * kick
    positions = np.cumsum(interval * (velocity + np.array([0.0, 0.0, -0.3])), axis=0)
    found = suspension_diffusion(positions, interval, longest=25.0)
    exact = interval * (1 + keep) / (2 * (1 - keep))
    for estimate in (found.from_msd, found.green_kubo):
        value, error = known(estimate)
        assert error < 0.03 * exact
        assert abs(value - exact) < 4 * error
    assert not correlation_warnings(found.kept, 25.0, 25.0)
    short = suspension_diffusion(positions, interval, longest=2.0)
    left, error = known(short.kept)
    assert abs(left - keep**4) < 4 * error, "of displacements over an interval, c for each"
    assert correlation_warnings(short.kept, 2.0, 2.0)[0].endswith("D is not that of long times")
    assert correlation_warnings(short.kept, 2.0, 25.0)[0].endswith("times; run longer")
    with pytest.raises(ValueError, match="at least 128 are needed"):
        suspension_diffusion(positions[:100], interval, longest=25.0)


def test_the_images_of_a_box_slow_diffusion_as_a_lattice_sum_says() -> None:
    """2.837 / L is minus the mean potential at a charge from its images and a background."""
    k = np.arange(-12, 13)
    n = np.stack(np.meshgrid(k, k, k), axis=-1).reshape(-1, 3)
    squares = (n**2).sum(axis=1)
    squares = squares[squares > 0]
    alpha = 2.0  # of an Ewald sum with L = 1
    reciprocal = (np.exp(-(math.pi**2) * squares / alpha**2) / (math.pi * squares)).sum()
    distance = np.sqrt(squares)
    real = sum(math.erfc(alpha * r) / r for r in distance[distance < 4])
    constant = reciprocal + real - math.pi / alpha**2 - 2 * alpha / math.sqrt(math.pi)
    larger = infinite_box(Estimate(0.1, 0.01), viscosity=2.0, edge=5.0)
    assert larger.value is not None
    assert larger.value - 0.1 == pytest.approx(-constant / (6 * math.pi * 2.0 * 5.0), rel=1e-6)
    assert infinite_box(Estimate(None, None, "x"), 1.0, 1.0).value is None


def test_what_is_outstanding_after_a_time_is_the_tail_of_an_infinite_box() -> None:
    """While waves do not cross the box: 4/3 / (rho (4 pi (nu + D))^(3/2)) t^(-1/2).

    And 2 t / (3 rho V) for the wave k = 0, which a box without momentum has not. After a long time
    it is what the images take.
    """
    d, viscosity, density = 0.1, 1.06, 0.67
    decay = viscosity / density + d
    for time in (10.0, 20.0):
        tail = 4 / 3 / (density * (4 * math.pi * decay) ** 1.5 * math.sqrt(time))
        found = outstanding_diffusion(d, viscosity, density, 60.0, np.array([time]))
        assert found == pytest.approx(tail + 2 * time / (3 * density * 60.0**3), rel=1e-4)
    images = CUBIC / (6 * math.pi * density * decay * 5.0)
    late = outstanding_diffusion(d, viscosity, density, 5.0, np.array([100.0]))
    assert late == pytest.approx(images, rel=1e-6)


@pytest.mark.parametrize("periodic", [(True, True, True), (True, True, False)])
def test_clusters_are_the_components_of_the_graph_of_bonds(
    periodic: tuple[bool, bool, bool],
) -> None:
    random = np.random.default_rng(4)
    frames = random.uniform(0, 9, size=(5, 80, 3))
    series = cluster_series(frames, BOX, periodic, 1.5)
    for number, frame in enumerate(frames):
        apart = frame[:, None] - frame[None]
        apart -= np.where(periodic, 9.0 * np.round(apart / 9.0), 0.0)
        near = (apart**2).sum(axis=2) < 1.5**2
        np.fill_diagonal(near, val=False)
        _, component = connected_components(coo_matrix(near))
        sizes = np.bincount(component)
        assert series.largest[number] == sizes.max()
        assert series.number[number] == (sizes > 1).sum()
        assert series.alone[number] == (sizes == 1).sum()
        assert series.bonds_per_colloid[number] == near.sum() / 2 / 80
        label, _ = labels(frame, BOX, periodic, 1.5)
        same = label[:, None] == label[None]
        np.testing.assert_array_equal(same, component[:, None] == component[None])


def test_g_of_independent_points_is_one_and_of_a_lattice_peaks_at_its_shells() -> None:
    random = np.random.default_rng(5)
    found = radial_distribution(random.uniform(0, 9, size=(200, 100, 3)), BOX, 0.25, 4.4)
    deviation = (found.g[2:] - 1) / found.error[2:]
    assert abs(deviation).max() < 5
    assert len(found.peaks) == 0
    sites = np.stack(np.meshgrid(*[np.arange(6) * 1.5] * 3), axis=-1).reshape(-1, 3)
    lattice = radial_distribution(
        sites + random.normal(size=(20, *sites.shape)) * 0.03, BOX, 0.05, 3.2
    )
    shells = 1.5 * np.sqrt([1, 2, 3, 4])
    assert len(lattice.peaks) == 4
    np.testing.assert_allclose(lattice.peaks, shells, atol=0.05)


def test_the_error_of_the_peak_knows_of_frames_that_are_alike() -> None:
    """Ten frames of the same places tell no more than a single frame does."""
    random = np.random.default_rng(8)
    places = random.uniform(0, 9, size=(200, 60, 3))

    def height(positions: Array) -> tuple[float, float]:
        particles = SimpleNamespace(positions=positions, steps=np.arange(len(positions)))
        run = SimpleNamespace(
            particles=lambda: particles,
            equilibration_steps=0,
            interval=1.0,
            box=SimpleNamespace(sizes=BOX),
            species=lambda: SimpleNamespace(radius=0.5),
        )
        entry = measured_g.measure(cast(RunDirectory, run)).entries["radial_distribution"]
        return known(Estimate.of_json(entry["peak_height"]))

    value, error = height(places[:40])
    again, alike = height(np.repeat(places[:40], 10, axis=0))
    assert again == pytest.approx(value)
    assert alike == pytest.approx(error, rel=0.35)


def test_false_alarms_of_normality_are_as_often_as_stated() -> None:
    random = np.random.default_rng(6)
    alarms = sum(not normality(random.normal(size=(10, 60, 3)), 1).normal for _ in range(600))
    assert alarms < 600 * FALSE_ALARMS * 2.5
    uniform = normality(random.uniform(size=(10, 60, 3)), 1)
    assert not uniform.normal
    assert uniform.excess_kurtosis == pytest.approx(-1.2, abs=5 * uniform.kurtosis_error)
    with pytest.raises(ValueError, match="at least 100"):
        normality(random.normal(size=(10, 9, 3)), 1)


def moments(velocities: np.ndarray, bias: float) -> float:
    """How probable the skewness and kurtosis of samples (T, N) are, as means over time."""
    centred = velocities - velocities.mean(axis=1, keepdims=True)
    second, third, fourth = ((centred**power).mean(axis=1) for power in (2, 3, 4))
    skewness = correlated_mean.mean(third / second**1.5)
    return normal_probability(skewness, correlated_mean.mean(fourth / second**2 - 3 + bias))


def test_false_alarms_of_moments_are_as_often_as_stated() -> None:
    """Also of numbers that remember themselves; other distributions are found."""
    random = np.random.default_rng(7)
    keep, particles, times, runs = 0.6, 50, 200, 120
    alarms = 0
    for _ in range(runs):
        series = np.empty((times, particles))
        series[0] = random.normal(size=particles)
        for step in range(1, times):
            kick = math.sqrt(1 - keep**2) * random.normal(size=particles)
            series[step] = keep * series[step - 1] + kick
        alarms += moments(series, 6 / (particles + 1)) < 0.1
    expected = 0.1 * runs
    assert abs(alarms - expected) < 4 * math.sqrt(expected)
    assert moments(random.uniform(size=(200, 50)), 0.0) < 1e-6
    assert moments(random.exponential(size=(200, 50)), 0.0) < 1e-6

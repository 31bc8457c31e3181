"""The three estimators on walks whose diffusivity is known, and on cases by hand."""

from collections.abc import Callable
from typing import Any

import MDAnalysis
import numpy as np
import pytest
import scipy.stats
from MDAnalysis.coordinates.memory import MemoryReader

from analysis.diffusivity import (
    AlongAxis,
    BayesianDiffusivity,
    ColorDiffusivity,
    DiffusivityError,
    FirstPassageDiffusivity,
    MiddleDiffusivity,
    PairDistance,
    Recorded,
    bayes,
    color_diffusivity,
)
from analysis.diffusivity.bayes import SmoothPosterior, TransitionLikelihood, most_likely
from analysis.diffusivity.blocks import jackknife, quantile_95
from analysis.diffusivity.local_fit import local_derivative
from tests.diffusivity import walks

Array = walks.Array
Make = Callable[[AlongAxis], Any]

WALKERS = 100


@pytest.fixture(scope="module")
def path() -> Array:
    return walks.walk(6 * WALKERS, 3000, seed=2)


def coverage(path: Array, make: Make) -> tuple[float, float]:
    """Fraction of bins, in the middle, whose 95 % bar holds the truth; and the median ratio."""
    inside, ratios = [], []
    for first in range(0, path.shape[1], WALKERS):
        group = walks.universe(path[:, first : first + WALKERS]).atoms
        results = make(AlongAxis(group)).run().results
        middle = np.abs(results.positions - walks.LENGTH / 2) < 1.2
        true = walks.diffusivity(results.positions[middle])
        deviation = results.diffusivity[middle] - true
        inside.append(np.abs(deviation) < quantile_95(10) * results.error[middle])
        ratios.append(results.diffusivity[middle] / true)
    return float(np.mean(inside)), float(np.median(ratios))


ESTIMATORS: list[Make] = [
    lambda c: ColorDiffusivity(c, 0.3, 3.7, probability=0.3, reach=0.5, bin_width=0.05),
    lambda c: FirstPassageDiffusivity(c, 0.3, 3.7, reach=0.5, bin_width=0.05),
]


@pytest.mark.parametrize("make", ESTIMATORS, ids=["color", "first passage"])
def test_error_bars_cover_the_truth(path: Array, make: Make) -> None:
    inside, ratio = coverage(path, make)
    assert inside > 0.86  # 6 walks of correlated bins: 0.95 +- 0.04
    assert ratio == pytest.approx(1, abs=0.07)


@pytest.mark.statistics
@pytest.mark.parametrize("make", ESTIMATORS, ids=["color", "first passage"])
def test_error_bars_cover_the_truth_in_95_of_100(make: Make) -> None:
    inside, ratio = coverage(walks.walk(60 * WALKERS, 3000, seed=5), make)
    assert inside == pytest.approx(0.95, abs=0.03)
    assert ratio == pytest.approx(1, abs=0.05)


def test_bayesian_profile_and_its_lags(path: Array) -> None:
    """Short lags are biased by the bins' width, which the displacement in a lag must outgrow.

    Where D is least, walkers move by 2.5 bins in a lag of 0.4: this or the next is taken.
    """
    group = walks.universe(path[:, : 4 * WALKERS]).atoms
    analysis = BayesianDiffusivity(
        AlongAxis(group), 0, walks.LENGTH, bins=16, lags=(2, 20, 40), samples=150
    ).run()
    results = analysis.results
    true = walks.diffusivity(results.positions)
    assert results.lag in (pytest.approx(0.4), pytest.approx(0.8))
    bias = (results.by_lag / true - 1).mean(axis=1)
    assert bias[0] > 0.15
    assert abs(bias[1]) < 0.04
    assert ((results.interval[0] < true) & (true < results.interval[1])).sum() >= 13  # of 15
    # the posterior is about as wide as the curvature at its top says
    chosen = int(np.argmin(abs(results.lags - results.lag)))
    assert results.error == pytest.approx(results.errors_by_lag[chosen], rel=0.5)


def test_the_prior_helps_where_a_lag_is_long(path: Array, monkeypatch: pytest.MonkeyPatch) -> None:
    """At 0.8 walkers move by 3.6 to 6 bins: a flat prior leaves neighbours to chance."""

    def deviation() -> float:
        group = walks.universe(path[:, :WALKERS]).atoms
        analysis = BayesianDiffusivity(
            AlongAxis(group), 0, walks.LENGTH, bins=16, lags=(40,), samples=0
        )
        results = analysis.run().results
        ratio = results.diffusivity / walks.diffusivity(results.positions)
        return float(np.sqrt(np.mean(np.log(ratio) ** 2)))

    smooth = deviation()
    monkeypatch.setattr(bayes, "ROUGHNESS", (50.0,))
    assert smooth < 0.2
    assert deviation() > 2 * smooth


def test_a_single_long_lag_of_fine_frames(path: Array) -> None:
    """Where the likelihood is flat nothing leads to the top: the start is what walkers move by."""
    coordinate = AlongAxis(walks.universe(path[:, :WALKERS]).atoms)
    analysis = BayesianDiffusivity(coordinate, 0, walks.LENGTH, bins=4, lags=(80,), samples=0)
    results = analysis.run().results
    ratio = results.diffusivity / walks.diffusivity(results.positions)
    assert ratio == pytest.approx(np.ones(3), abs=0.5)  # from the start width^2 / frame, 50 to 100


def three_bins() -> TransitionLikelihood:
    counts = np.array([[90.0, 30, 5], [28, 80, 33], [6, 31, 70]])
    return TransitionLikelihood(counts, counts.sum(axis=0) / counts.sum(), 0.5, 0.2)


def test_the_prior_and_its_gradient() -> None:
    """Normal differences of log D on top of the likelihood."""
    x, variance = np.array([0.3, -0.4]), 0.05
    likelihood = three_bins()
    posterior = SmoothPosterior(likelihood, variance)
    expected = likelihood.value(x) + scipy.stats.norm.logpdf(0.7, scale=variance**0.5)
    constant = scipy.stats.norm.logpdf(0, scale=variance**0.5)
    value, gradient = posterior.value_and_gradient(x)
    assert value == pytest.approx(expected - constant, rel=1e-12)
    assert posterior.value(x) == pytest.approx(value, rel=1e-12)
    for n, unit in enumerate(np.eye(2)):
        difference = (posterior.value(x + 1e-5 * unit) - posterior.value(x - 1e-5 * unit)) / 2e-5
        assert gradient[n] == pytest.approx(difference, rel=1e-5)


@pytest.mark.parametrize("variance", [0.001, 0.1, 3.0])
def test_the_evidence_is_the_integral_of_the_posterior(variance: float) -> None:
    posterior = SmoothPosterior(three_bins(), variance)
    best, covariance = most_likely(posterior, np.zeros(2))
    top = posterior.value(best)
    fine = np.linspace(-1.5, 1.5, 61)
    values = np.array(
        [[np.exp(posterior.value(best + np.array([a, b])) - top) for a in fine] for b in fine]
    )
    integral = values.sum() * (fine[1] - fine[0]) ** 2
    exact = top + np.log(integral) - 0.5 * np.log(2 * np.pi * variance)
    laplace = posterior.evidence(best, covariance) + 0.5 * np.log(2 * np.pi)
    assert laplace == pytest.approx(exact, abs=0.1)


def test_likelihood_is_that_of_the_exponential_and_its_gradient() -> None:
    from scipy.linalg import expm

    random = np.random.default_rng(0)
    population = random.uniform(0.5, 1.5, 6)
    population /= population.sum()
    counts = random.integers(0, 50, (6, 6)).astype(float)
    x = random.normal(size=5) * 0.3
    likelihood = TransitionLikelihood(counts, population, 0.5, 0.7)
    rates = np.zeros((6, 6))
    for i, d in enumerate(np.exp(x)):  # Hummer's rate matrix, entry by entry
        rates[i + 1, i] = d / 0.25 * np.sqrt(population[i + 1] / population[i])
        rates[i, i + 1] = d / 0.25 * np.sqrt(population[i] / population[i + 1])
    rates -= np.diag(rates.sum(axis=0))
    assert rates @ population == pytest.approx(np.zeros(6), abs=1e-14)
    expected = np.sum(counts * np.log(expm(0.7 * rates)))
    value, gradient = likelihood.value_and_gradient(x)
    assert value == pytest.approx(expected, rel=1e-12)
    for n, unit in enumerate(np.eye(5)):
        difference = (likelihood.value(x + 1e-5 * unit) - likelihood.value(x - 1e-5 * unit)) / 2e-5
        assert gradient[n] == pytest.approx(difference, rel=1e-6)


def flat_walk(walkers: int, frames: int, seed: int) -> Array:
    """Of D = 1 between reflecting ends at 0 and LENGTH."""
    random = np.random.default_rng(seed)
    steps = random.normal(scale=np.sqrt(2 * walks.FRAME), size=(frames, walkers))
    z = np.cumsum(steps, axis=0) + random.uniform(0, walks.LENGTH, walkers)
    z = np.mod(z, 2 * walks.LENGTH)  # unfolded, the reflections are a longer box
    return np.minimum(z, 2 * walks.LENGTH - z)


def test_displacements_from_the_middle_of_a_flat_walk() -> None:
    """D = 1 within the error bars; noise of each frame adds to the displacements, not to D."""
    path = flat_walk(120, 1000, seed=7)
    deviations = []
    for first in range(0, 120, 10):
        group = walks.universe(path[:, first : first + 10]).atoms
        analysis = MiddleDiffusivity(AlongAxis(group), 0, walks.LENGTH, longest=10)
        results = analysis.run().results
        deviations.append((results.diffusivity - 1) / results.error)
        # rms displacements of an eighth of the width: 0.5 = sqrt(2 t)
        assert results.window[1] == pytest.approx(0.12, abs=0.03)
        assert results.window[0] == pytest.approx(results.window[1] / 2, abs=walks.FRAME * 0.51)
    assert np.sqrt(np.mean(np.square(deviations))) < 1.6
    assert abs(np.mean(deviations)) < 1
    noise = np.random.default_rng(5).normal(scale=0.1, size=path.shape)
    group = walks.universe(path + noise).atoms
    results = MiddleDiffusivity(AlongAxis(group), 0, walks.LENGTH, longest=10).run().results
    assert results.diffusivity == pytest.approx(0.994, abs=4 * results.error)
    assert results.msd[0] == pytest.approx(2 * walks.FRAME + 0.02, rel=0.05)
    assert results.error < 0.05


def test_displacements_by_hand() -> None:
    """One walker begins in the middle and steps by 0.1 up and down: lags 2, 4, ... see nothing."""
    z = np.full((200, 2), 0.1)  # the other never is in the middle
    z[:, 0] = 2.0 + 0.1 * (np.arange(200) % 2)
    results = MiddleDiffusivity(AlongAxis(walks.universe(z).atoms), 0, 4, longest=4).run().results
    assert results.msd == pytest.approx([0.01, 0, 0.01, 0], abs=1e-6)
    assert results.diffusivity == pytest.approx(0, abs=1e-6)
    assert results.lags == pytest.approx(walks.FRAME * np.arange(1, 5))


def test_local_derivative_is_that_of_the_weighted_fit_of_numpy() -> None:
    random = np.random.default_rng(3)
    x = np.sort(random.uniform(0, 1, 60))
    y, weights = random.normal(size=60), random.uniform(0.01, 1, 60) * (random.random(60) > 0.1)
    slopes = local_derivative(x, y, weights, 0.3)
    for place, slope in zip(x, slopes, strict=True):
        near = (np.abs(x - place) <= 0.3) & (weights > 0)
        fit = np.polynomial.Polynomial.fit(x[near], y[near], 3, w=np.sqrt(weights[near]))
        assert slope == pytest.approx(fit.deriv()(place), rel=1e-8, abs=1e-8)


def test_local_derivative_of_a_cubic_is_exact() -> None:
    x = np.linspace(0, 3, 61)
    weights = np.random.default_rng(0).uniform(0.1, 2, 61)
    slopes = local_derivative(x, 2 - x + x**3, weights, 0.3)
    assert slopes == pytest.approx(-1 + 3 * x**2, abs=1e-10)
    assert np.isnan(local_derivative(x, x, weights * (x < 0.2), 0.3)[:4]).all()


def test_jackknife_of_a_mean() -> None:
    data = np.random.default_rng(1).normal(size=(10, 4))
    value, error = jackknife(lambda total: total / 10, data)
    assert value == pytest.approx(data.mean(axis=0))
    nine = [np.delete(data, n, 0).sum(axis=0) / 10 for n in range(10)]
    assert error == pytest.approx(np.sqrt(0.9 * ((nine - np.mean(nine, axis=0)) ** 2).sum(axis=0)))


def steady_pairs(blocks: int = 6) -> tuple[Array, float, Array, Array, Array]:
    """Exact steady state about a particle: D(r) = 1 - 0.5/r, rho(r) = 1 + 1/r^4, J = 2."""
    width = 0.02
    r = 1 + width * np.arange(0.5, 150)
    fine = np.linspace(1, 4, 60001)
    slope = 2 / (4 * np.pi * fine**2 * (1 + fine**-4) * (1 - 0.5 / fine))
    x = 0.1 + np.concatenate([[0], np.cumsum((slope[1:] + slope[:-1]) / 2 * np.diff(fine))])
    number = 4 * np.pi * r**2 * (1 + r**-4) * width
    colored = number * np.interp(r, fine, x)
    repeat = np.ones((blocks, 1))
    return r, width, repeat * number, repeat * colored, 2 * repeat[:, 0]


def test_erratum_3_printed_pair_formula_fails_and_the_corrected_holds() -> None:
    """(3) of carmer-2012 has dx/dr - 2x/r, which makes D(r) negative; with dx/dr it is exact."""
    r, width, number, colored, rate = steady_pairs()
    true = 1 - 0.5 / r
    corrected, _ = color_diffusivity(r, width, number, colored, rate, 0.1)
    assert corrected == pytest.approx(true, rel=2e-3)

    x, density = colored[0] / number[0], number[0] / (4 * np.pi * r**2 * width)
    slope = local_derivative(r, x, number[0], 0.1)
    flux = -2 / (4 * np.pi * r**2)  # A flows inwards
    printed = -flux / (density * (slope - 2 * x / r))
    assert (printed[r > 1.5] < 0).all()
    assert -flux / (density * slope) == pytest.approx(true, rel=2e-3)
    # the same for B, as it must: x -> 1 - x, j -> -j
    assert flux / (density * -slope) == pytest.approx(true, rel=2e-3)


def test_erratum_3_printed_form_is_exact_for_weighted_quantities() -> None:
    """With y = r^2 x and r^2 j for x and j the printed form is the corrected one."""
    r, _width, number, colored, _rate = steady_pairs()
    x = colored[0] / number[0]
    y = r**2 * x
    slope = local_derivative(r, y, number[0], 0.1) - 2 * y / r
    assert slope == pytest.approx(r**2 * local_derivative(r, x, number[0], 0.1), rel=2e-2)


def test_pair_distances_are_those_of_nearest_images() -> None:
    positions = np.array([[[0.5, 5, 5], [9.5, 5, 5], [5, 5, 5], [5, 5, 9.0]]], dtype=np.float32)
    made = MDAnalysis.Universe.empty(4, trajectory=True)
    made.load_new(positions, format=MemoryReader, dimensions=[10, 10, 10, 90, 90, 90])
    pairs = PairDistance(made.atoms, made.atoms[:2])
    far = np.sqrt(4.5**2 + 4**2)
    assert pairs.values() == pytest.approx([1, 4.5, far, 1, 4.5, far])


def test_recorded_values_are_the_walkers_of_a_trajectory(path: Array) -> None:
    """The same result as from the atoms of a Universe, but for their single precision."""

    def profile(coordinate: Any) -> Any:
        return BayesianDiffusivity(coordinate, 0, walks.LENGTH, bins=8, lags=(40,), samples=0).run()

    group = walks.universe(path[:600, :50]).atoms
    recorded = profile(Recorded(path[:600, :50], walks.FRAME)).results
    assert recorded.diffusivity == pytest.approx(profile(AlongAxis(group)).results.diffusivity)
    assert recorded.lag == pytest.approx(0.8)


def still(walkers: int = 5, frames: int = 40) -> AlongAxis:
    return AlongAxis(walks.universe(np.full((frames, walkers), 2.0)).atoms)


BAD: list[tuple[Callable[[], Any], str]] = [
    (lambda: AlongAxis(walks.universe(np.ones((3, 2))).atoms, "r"), "axis: 'r'; it must be"),
    (lambda: Recorded(np.ones(3), 0.1), r"values: \(3,\); they must be \(frames, walkers\)"),
    (lambda: Recorded(np.ones((3, 1)), 0), "interval: 0; it must be positive"),
    (lambda: ColorDiffusivity(still(), 2, 1), "low: 2; it must be below high, 1"),
    (lambda: ColorDiffusivity(still(), 1, 3, probability=0), r"probability: 0; it must be in \(0"),
    (lambda: ColorDiffusivity(still(), 1, 3, settle=1), r"settle: 1; it must be in \[0, 1\)"),
    (lambda: ColorDiffusivity(still(), 1, 3, blocks=2), "blocks: 2; at least 3"),
    (lambda: ColorDiffusivity(still(), 1, 3).run(), "0 reactions; at least 100 are needed"),
    (lambda: ColorDiffusivity(still(), 1, 3).run(stop=5), "5 frames; more are needed"),
    (lambda: FirstPassageDiffusivity(still(), 1, 3).run(), "0 round trips to a level; at least 20"),
    (lambda: MiddleDiffusivity(still(), 3, 1), "low: 3; it must be below high, 1"),
    (lambda: MiddleDiffusivity(still(), 1, 3, longest=1), "longest: 1; a slope needs 2 lags"),
    (lambda: MiddleDiffusivity(still(), 1, 3, blocks=2), "blocks: 2; at least 3"),
    (lambda: MiddleDiffusivity(still(), 1, 3).run(stop=4), "4 frames; more are needed for 10"),
    (lambda: MiddleDiffusivity(still(), 2, 6).run(), "0 displacements begin in the middle third"),
    (lambda: BayesianDiffusivity(still(), 1, 3, lags=(2, 1)), r"lags: \[2, 1\]; positive and inc"),
    (lambda: BayesianDiffusivity(still(), 1, 3, lag=3), "lag: 3; it must be one of the lags"),
    (lambda: BayesianDiffusivity(still(), 1, 3, bins=2), "bins: 2; at least 3"),
    (lambda: BayesianDiffusivity(still(), 1, 3).run(), "no walker was ever in the bin at 1.05"),
]


@pytest.mark.parametrize(("make", "message"), BAD)
def test_bad_input_is_named(make: Callable[[], Any], message: str) -> None:
    with pytest.raises(DiffusivityError, match=message):
        make()


def test_too_few_crossings_are_counted_in_the_message() -> None:
    z = np.full((40, 6), 0.5)
    z[:, 1], z[:, 2:] = 1.5, 2.5
    z[20:, 2] = 1.5
    analysis = BayesianDiffusivity(AlongAxis(walks.universe(z).atoms), 0, 3, bins=3, lags=(1,))
    with pytest.raises(DiffusivityError, match="0 crossings of a face at a lag of 1 frames; at le"):
        analysis.run()

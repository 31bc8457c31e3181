"""Profiles of D from runs, by colours and by likelihood, and numbers made of them."""

import csv
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from analysis import RunDirectory
from analysis.analyze import summary_of
from analysis.arrays import Array
from analysis.colors import colors_of, estimate
from analysis.diffusivity import (
    AlongAxis,
    BayesianDiffusivity,
    PairDistance,
    color_diffusivity,
)
from analysis.estimate import Estimate
from analysis.measures.color_diffusivity import REACH

CONFIDENCE_95 = 2.09  # errors, of 20 blocks


@dataclass(frozen=True)
class Profile:
    """D at positions with its standard error, all (n,)."""

    place: Array
    diffusivity: Array
    error: Array

    def mean(self, low: float, high: float, spacing: float) -> Estimate:
        """Harmonic mean where low <= |place| <= high.

        What is measured is a slope, 1/D up to factors: its errors are normal, those of D are not.
        Values within `spacing` of each other share their data, so that the error is that of so
        many fewer of them.
        """
        chosen = (np.abs(self.place) >= low) & (np.abs(self.place) <= high)
        resistance = 1 / self.diffusivity[chosen]
        error = self.error[chosen] * resistance**2
        count = len(resistance)
        step = float(np.diff(self.place).min())
        together = min(max(1.0, spacing / step), count)
        mean = float(resistance.mean())
        of_mean = float(np.sqrt(together * np.sum(error**2))) / count
        return Estimate(1 / mean, of_mean / mean**2)


def table_of(
    shown: Sequence[tuple[float, str, Profile]], coordinate: str
) -> dict[str, list[float | str]]:
    """Columns of profiles, each given with its packing fraction and method."""
    rows: list[tuple[float | str, ...]] = [
        (packing, method, *map(float, row))
        for packing, method, profile in shown
        for row in zip(profile.place, profile.diffusivity, profile.error, strict=True)
    ]
    names = ("packing_fraction", "method", coordinate, "diffusivity", "error")
    return {name: [row[n] for row in rows] for n, name in enumerate(names)}


def by_colors(run: RunDirectory) -> dict[float, Profile]:
    """The profile of each reaction probability, from the table that analysis writes."""
    summary_of(run.path)
    with (run.path / "diffusivity.csv").open(encoding="utf-8") as file:
        header, *rows = csv.reader(file)
    assert header[2:] == ["density", "diffusivity", "error"], header
    numbers = np.array(rows, dtype=float)
    return {
        float(p): Profile(*numbers[numbers[:, 0] == p][:, [1, 3, 4]].T)
        for p in np.unique(numbers[:, 0])
    }


def excess(run: RunDirectory, p: float, reference: float, low: float, high: float) -> Estimate:
    """Harmonic mean of D(z) at one reaction probability over that at another, less 1.

    Both are from one trajectory, so the jackknife is of the ratio.

    Args:
        low, high: |z| from the middle.
    """
    colors = colors_of(run)
    place = np.abs(colors.positions - run.box.sizes[2] / 2)
    chosen = (place >= low) & (place <= high)

    def mean(number: Array, colored: Array, rate: Array) -> Array:
        sums = (number[np.newaxis], colored[np.newaxis], np.atleast_1d(rate))
        d, _ = color_diffusivity(colors.positions, colors.width, *sums, REACH)
        return np.asarray(1 / np.mean(1 / d[chosen]))

    def of(probability: float) -> tuple[Array, Array]:
        k = colors.reactions.probabilities.index(probability)
        return colors.chances[..., k], colors.through(colors.chance_rates[..., k])

    def ratio(number: Array, a: Array, rate_a: Array, b: Array, rate_b: Array) -> Array:
        return np.asarray(mean(number, a, rate_a) / mean(number, b, rate_b) - 1)

    return estimate(ratio, colors.number, *of(p), *of(reference))


def across(run: RunDirectory, bins: int, lags: tuple[int, ...], lag: int) -> Profile:
    """D(z) by likelihood, z from the middle."""
    atoms = run.universe().atoms
    width = run.box.sizes[2]
    radius = run.species().radius
    return _likelihood(
        BayesianDiffusivity(
            AlongAxis(atoms, "z"), radius, width - radius, bins=bins, lags=lags, lag=lag, samples=0
        ),
        run,
        width / 2,
    )


def about_particles(
    run: RunDirectory, centers: int, high: float, bins: int, lags: tuple[int, ...], lag: int
) -> Profile:
    """D(r) by likelihood."""
    atoms = run.universe().atoms
    pairs = PairDistance(atoms, atoms[:centers])
    contact = 2 * run.species().radius
    return _likelihood(
        BayesianDiffusivity(pairs, contact, high, bins=bins, lags=lags, lag=lag, samples=0),
        run,
        0.0,
    )


def _likelihood(estimator: BayesianDiffusivity, run: RunDirectory, middle: float) -> Profile:
    results = estimator.run(start=run.equilibration_frames).results
    return Profile(results.positions - middle, results.diffusivity, results.error)

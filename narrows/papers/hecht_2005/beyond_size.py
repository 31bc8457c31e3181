"""Beyond the paper: were its 462 colloids enough?

14 % at 35 mV and 2e8 / m, where the largest cluster depends on chance: the paper's box, from a few
seeds, and one of 32 cells with 4486 colloids.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from analysis import RunDirectory, correlated_mean
from analysis.arrays import Array
from analysis.clusters import BOND, cluster_series
from analysis.estimate import Estimate, mean_of_independent
from analysis.radial_distribution import RadialDistribution
from lammps_inputs import Scene
from lammps_inputs.scenes.claylike import Claylike
from narrows.papers.drawing import COLOURS
from narrows.papers.figure import Column, Directories, Outcome, PaperFigure, Quality
from narrows.papers.hecht_2005.beyond_diffusion import mobility
from narrows.papers.hecht_2005.motion import PERIOD
from narrows.papers.hecht_2005.phases import FRACTION, first_peak, layering
from narrows.papers.hecht_2005.structure import pair_correlation, production
from narrows.papers.results import Result, claimed, measured

NUMBER = "beyond-size"
LARGER = 32  # cells along an edge; 15 of the paper
SEEDS = 5  # of the paper's box
QUANTITIES = {
    "bonds": "bonds per colloid",
    "clusters": "clusters of two or more, per colloid",
    "alone": "share of colloids that are alone",
    "largest": "share of the largest cluster",
    "peak": "height of the first peak of g(r)",
    "layers": "r.m.s. of g - 1 from 6 to 8 R",
    "diffusion": f"D over {PERIOD:g} t0 [a0^2/t0]",
}
CLAIM = "462 colloids show what ten times as many do"


def small(quality: Quality) -> list[Claylike]:
    """The paper's box; the first is a state of Fig. 9."""
    return [production(0.035, 2e8, FRACTION, quality, seed=seed) for seed in range(1, SEEDS + 1)]


def large(quality: Quality) -> Claylike:
    """Ten times as large."""
    return production(0.035, 2e8, FRACTION, quality, cells=LARGER)


def scenes(quality: Quality) -> list[Scene]:
    """All runs."""
    return [*small(quality), large(quality)]


@dataclass(frozen=True)
class Look:
    """At a run: numbers of its second half by `QUANTITIES`, g(r), and the largest cluster in time.

    Attributes:
        numbers: by key.
        distance: of g(r) [R].
        correlation: g(r).
        times: of all frames, (T,) [t0].
        share: of the colloids in the largest cluster, (T,).
    """

    numbers: dict[str, Estimate]
    distance: Array
    correlation: RadialDistribution
    times: Array
    share: Array


def look(run: RunDirectory) -> Look:
    """All that is compared."""
    particles, box, radius = run.particles(), run.box, run.species().radius
    count = particles.positions.shape[1]
    found = cluster_series(particles.positions, box.sizes, box.periodic, BOND * 2 * radius)
    half = len(particles.steps) // 2
    distance, correlation = pair_correlation(run)

    def mean(values: Array) -> Estimate:
        return correlated_mean.mean(values[half:], run.interval)

    numbers = {
        "bonds": mean(found.bonds_per_colloid),
        "clusters": mean(found.number / count),
        "alone": mean(found.alone / count),
        "largest": mean(found.largest / count),
        "peak": first_peak(correlation, radius)[1],
        "layers": layering(distance, correlation),
        "diffusion": mobility(run).diffusion,
    }
    times = run.times(particles.steps)
    return Look(numbers, distance, correlation, times, found.largest / count)


def side_by_side(
    few: Sequence[float], many: float, counts: tuple[int, int]
) -> tuple[Estimate, Estimate, Estimate]:
    """A number of small boxes, of a large one, and the one less the other.

    States that still change have no error from one run. That of the large box is taken from the
    scatter of the small ones, as if it were so many of them side by side.

    Args:
        few: of each small box.
        many: of the large box.
        counts: colloids in a small and in the large box.
    """
    small = mean_of_independent(few)
    scatter, share = float(np.std(few, ddof=1)), counts[0] / counts[1]
    told, freedom = "error from the scatter of the small boxes", len(few) - 1
    large = Estimate(many, scatter * math.sqrt(share), told, freedom)
    error = scatter * math.sqrt(1 / len(few) + share)
    return small, large, Estimate(small.number - many, error, told, freedom)


def _make(directories: Directories, quality: Quality) -> Outcome:
    few = [look(directories[scene]) for scene in small(quality)]
    many = look(directories[large(quality)])
    counts = small(quality)[0].colloids, large(quality).colloids
    results: list[Result] = []
    for key, words in QUANTITIES.items():
        values = [each.numbers[key].number for each in few]
        paper, larger, apart = side_by_side(values, many.numbers[key].number, counts)
        results += [
            measured(NUMBER, f"{words}, {counts[0]} colloids", paper),
            measured(NUMBER, f"{words}, {counts[1]} colloids", larger),
            claimed(NUMBER, f"{words}: the one less the other", apart, CLAIM, "zero"),
        ]
    g = np.mean([each.correlation.g for each in few], axis=0)
    table: dict[str, Column] = {
        "r/R": many.distance.tolist(),
        f"g_{counts[0]}": g.tolist(),
        f"g_{counts[1]}": many.correlation.g.tolist(),
    }
    return Outcome(_draw(few, many, g, counts), table, results)


def _draw(few: list[Look], many: Look, g: Array, counts: tuple[int, int]) -> Figure:
    figure = Figure(figsize=(9.0, 3.9), layout="constrained")
    left, right = figure.subplots(1, 2)
    left.plot(few[0].distance, g, color=COLOURS[0], label=f"{counts[0]} colloids")
    left.plot(many.distance, many.correlation.g, color=COLOURS[1], label=f"{counts[1]} colloids")
    for each in few:
        right.plot(each.times, each.share, color=COLOURS[0], linewidth=0.8)
    right.plot(many.times, many.share, color=COLOURS[1])
    left.set(xlabel="distance $r$ [$R$]", ylabel="pair correlation $g(r)$")
    right.set(xlabel="time [$t_0$]", ylabel="share of the largest cluster", ylim=(0, 1))
    left.legend()
    return figure


FIGURES = (
    PaperFigure(
        NUMBER,
        "The paper's suspension and one ten times as large, 14 % at 35 mV, 2e8 / m: g(r), and the "
        "largest cluster in time.",
        _make,
        scenes,
    ),
)

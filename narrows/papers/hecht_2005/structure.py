"""Figs. 5 and 6: g(r) of clusters in the secondary minimum, and of a repulsive suspension."""

from functools import partial

import numpy as np

from analysis import analyze
from analysis.estimate import Estimate
from analysis.measures.radial_distribution import BINS
from analysis.radial_distribution import radial_distribution
from lammps_inputs import Scene
from lammps_inputs.scenes.claylike import Claylike
from narrows.papers.drawing import PAPER, one_panel
from narrows.papers.figure import Directories, Outcome, PaperFigure, Quality
from narrows.papers.results import PaperNumber, compared, measured

KAPPAS = {"5": 3e8, "6": 7.3e7}  # at 50 mV [1/m]
FRACTION = 0.28  # the paper does not say
PEAKS = (2.0, 4 / 3 * np.sqrt(6), 2 * np.sqrt(3), 4.0)  # A to D [R]
SHIFT = "50 mV and 3e8 / m shut the primary minimum: peaks are those of the secondary, 4 % further"


def scene(number: str, quality: Quality) -> Claylike:
    """924 colloids, without gravity."""
    duration = 900.0 if quality == "full" else 60.0
    return Claylike.make(
        surface_potential=0.05,
        kappa=KAPPAS[number],
        volume_fraction=FRACTION,
        duration=duration,
        equilibration=0.5 * duration,
        sampling_interval=2.0,
    )


def _scenes(number: str, quality: Quality) -> list[Scene]:
    return [scene(number, quality)]


def _make(number: str, directories: Directories, quality: Quality) -> Outcome:
    run = directories[scene(number, quality)]
    clusters = analyze(run.path)["clusters"]
    particles, radius = run.particles(), run.species().radius
    used = particles.steps >= run.equilibration_steps
    width = 2 * radius / BINS
    found = radial_distribution(particles.positions[used], run.box.sizes, width, 7 * radius)
    distance = found.distance / radius
    figure, axes = one_panel("distance $r$ [$R$]", "pair correlation $g(r)$")
    axes.plot(distance, found.g, drawstyle="steps-mid", linewidth=1)
    results = []
    highest = float(distance[int(np.argmax(found.g))])
    first = Estimate(highest, width / radius / 2)
    if number == "5":
        for letter, peak in zip("ABCD", PEAKS, strict=True):
            axes.axvline(peak, color=PAPER, linestyle=":", label=f"{letter}, {peak:.3g} R")
        results.append(compared(number, "peak A [R]", first, PaperNumber(2.0, 0.01), SHIFT))
        axes.legend()
    else:
        results.append(measured(number, "first peak [R]", first))
    for name in ("largest", "bonds_per_colloid"):
        estimate = Estimate(clusters[name]["value"], clusters[name]["error"])
        results.append(measured(number, f"clusters: {name.replace('_', ' ')}", estimate))
    table = {"r/R": distance.tolist(), "g": found.g.tolist(), "error": found.error.tolist()}
    return Outcome(figure, table, results)


FIGURES = tuple(
    PaperFigure(
        number,
        f"g(r) at 50 mV, kappa {kappa:.2g} / m, {FRACTION:.0%} of colloids.",
        partial(_make, number),
        partial(_scenes, number),
    )
    for number, kappa in KAPPAS.items()
)

"""Figs. 5 to 7: g(r) of clusters in the secondary minimum, and of a repulsive suspension."""

from functools import partial
from typing import Any

import numpy as np

from analysis import RunDirectory, analyze
from analysis.arrays import Array
from analysis.estimate import Estimate
from analysis.measures.radial_distribution import BINS
from analysis.radial_distribution import RadialDistribution, radial_distribution
from lammps_inputs import Scene
from lammps_inputs.scenes.claylike import Claylike
from narrows.papers.drawing import PAPER, one_panel
from narrows.papers.figure import Directories, Outcome, PaperFigure, Quality
from narrows.papers.results import PaperNumber, compared, measured

KAPPAS = {"5": 3e8, "6": 7.3e7}  # at 50 mV [1/m]
FRACTION = 0.28  # the paper does not say
FARTHEST = 9.0  # of g(r) [R]
PEAKS = (2.0, 4 / 3 * np.sqrt(6), 2 * np.sqrt(3), 4.0)  # A to D [R]
SHIFT = "50 mV and 3e8 / m shut the primary minimum: peaks are those of the secondary, 4 % further"


def production(
    surface_potential: float, kappa: float, volume_fraction: float, quality: Quality, **more: Any
) -> Claylike:
    """Without gravity; the latter two thirds are looked at, in full quality after 0.5 s.

    `more` are other fields of the scene.
    """
    duration = 900.0 if quality == "full" else 60.0
    return Claylike.make(
        surface_potential=surface_potential,
        kappa=kappa,
        volume_fraction=volume_fraction,
        duration=duration,
        equilibration=0.5 * duration,
        sampling_interval=2.0,
        **more,
    )


def scene(number: str, quality: Quality) -> Claylike:
    """924 colloids."""
    return production(0.05, KAPPAS[number], FRACTION, quality)


def pair_correlation(run: RunDirectory) -> tuple[Array, RadialDistribution]:
    """Distances [R] and g(r) of the frames after equilibration."""
    particles, radius = run.particles(), run.species().radius
    used = particles.steps >= run.equilibration_steps
    width = 2 * radius / BINS
    found = radial_distribution(particles.positions[used], run.box.sizes, width, FARTHEST * radius)
    return found.distance / radius, found


def _scenes(number: str, quality: Quality) -> list[Scene]:
    return [scene(number, quality)]


def _make(number: str, directories: Directories, quality: Quality) -> Outcome:
    run = directories[scene(number, quality)]
    clusters = analyze(run.path)["clusters"]
    distance, found = pair_correlation(run)
    figure, axes = one_panel("distance $r$ [$R$]", "pair correlation $g(r)$")
    axes.plot(distance, found.g, drawstyle="steps-mid", linewidth=1)
    results = []
    highest = float(distance[int(np.argmax(found.g))])
    first = Estimate(highest, 1 / BINS)
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


def _beside_potential(directories: Directories, quality: Quality) -> Outcome:
    """Fig. 7: g(r) of Fig. 6, and the potential."""
    repulsive = scene("6", quality)
    distance, found = pair_correlation(directories[repulsive])
    between, radius = repulsive.between, repulsive.model.reduced_radius
    assert between is not None
    figure, axes = one_panel("distance $r$ [$R$]", "$g(r)$, and $V$ [$k_B T$]")
    apart = distance > between.joint / radius
    energy = np.where(apart, between.energy(np.maximum(distance, 2.0) * radius), np.nan)
    axes.plot(distance, found.g, drawstyle="steps-mid", linewidth=1, label="$g(r)$")
    axes.plot(distance, energy, color=PAPER, label="$V$")
    axes.set_ylim(-1, 4)
    axes.legend()
    beyond = np.linspace(2.1, FARTHEST, 4000)
    minimum = float(beyond[np.argmin(between.energy(beyond * radius))])
    highest = Estimate(float(distance[int(np.argmax(found.g))]), 1 / BINS)
    results = [
        compared(
            *("7", "maximum of g(r) [R]", highest),
            PaperNumber(minimum, 2 / BINS),
            "the paper's number is where V has its minimum",
        )
    ]
    table = {"r/R": distance.tolist(), "g": found.g.tolist(), "V": energy.tolist()}
    return Outcome(figure, table, results)


FIGURES = (
    *(
        PaperFigure(
            number,
            f"g(r) at 50 mV, kappa {kappa:.2g} / m, {FRACTION:.0%} of colloids.",
            partial(_make, number),
            partial(_scenes, number),
        )
        for number, kappa in KAPPAS.items()
    ),
    PaperFigure(
        "7",
        "g(r) of Fig. 6 beside the potential.",
        _beside_potential,
        partial(_scenes, "6"),
    ),
)

"""Figs. 9 to 13: where colloids cluster, and g(r) by screening, surface potential and fraction."""

from collections.abc import Sequence
from functools import partial

import numpy as np
from matplotlib.figure import Figure

from analysis import RunDirectory, analyze
from analysis.arrays import Array
from analysis.clusters import BOND, labels
from analysis.estimate import Estimate
from analysis.radial_distribution import RadialDistribution
from lammps_inputs import Scene
from lammps_inputs.scenes.claylike import Claylike
from narrows.papers.drawing import one_panel, shades
from narrows.papers.figure import Column, Directories, Outcome, PaperFigure, Quality
from narrows.papers.hecht_2005.structure import pair_correlation, production
from narrows.papers.results import Result, claimed, measured

KAPPAS = (1.0e8, 1.4e8, 1.6e8, 2.0e8)  # of Fig. 9 from below [1/m]
SURFACE_POTENTIALS = (20, 35, 50)  # from the left [mV]
FRACTION = 0.14  # of Figs. 9 to 11
FRACTIONS = (0.07, 0.14, 0.21, 0.28, 0.35)  # of Figs. 12 and 13
LAYERS = (6.0, 8.0)  # where the paper sees broad peaks appear [R]
REVERSED = "the caption of Fig. 11 says the opposite of its text and of (1)"

CaseScenes = Sequence[tuple[str, Claylike]]


def phase_diagram(quality: Quality) -> CaseScenes:
    """Fig. 9, row by row from above."""
    return [
        (f"{psi} mV, {kappa:.2g} / m", production(psi / 1e3, kappa, FRACTION, quality))
        for kappa in reversed(KAPPAS)
        for psi in SURFACE_POTENTIALS
    ]


def by_kappa(quality: Quality) -> CaseScenes:
    """Fig. 10, at 20 mV."""
    return [(f"{kappa:.2g} / m", production(0.02, kappa, FRACTION, quality)) for kappa in KAPPAS]


def by_surface_potential(quality: Quality) -> CaseScenes:
    """Fig. 11, at 2e8 / m."""
    return [
        (f"{psi} mV", production(psi / 1e3, KAPPAS[-1], FRACTION, quality))
        for psi in SURFACE_POTENTIALS
    ]


def by_fraction(kappa: float, quality: Quality) -> CaseScenes:
    """Figs. 12 and 13, at 20 mV."""
    return [(f"{phi:.0%}", production(0.02, kappa, phi, quality)) for phi in FRACTIONS]


def _bonds(run: RunDirectory) -> Estimate:
    entry = analyze(run.path)["clusters"]["bonds_per_colloid"]
    return Estimate(entry["value"], entry["error"])


def _draw_states(cases: Sequence[tuple[str, RunDirectory]], columns: int) -> Figure:
    """The last frames seen along z, clusters by colour, colloids alone in grey."""
    rows = len(cases) // columns
    figure = Figure(figsize=(2.4 * columns, 2.5 * rows), layout="constrained")
    for (name, run), axes in zip(cases, figure.subplots(rows, columns).flat, strict=True):
        box, positions = run.box, run.particles().positions[-1]
        label, _ = labels(positions, box.sizes, box.periodic, BOND * 2 * run.species().radius)
        alone = np.bincount(label)[label] == 1
        colours = np.where(alone, "0.75", [f"C{number % 10}" for number in label])
        x, y, _ = (positions % np.array(box.sizes)).T
        axes.scatter(x, y, s=8, c=colours.tolist(), linewidths=0)
        axes.set(xticks=[], yticks=[], aspect="equal")
        axes.set_title(name, fontsize="small")
    return figure


def _make_diagram(directories: Directories, quality: Quality) -> Outcome:
    cases = [(name, directories[scene]) for name, scene in phase_diagram(quality)]
    bonds = {name: _bonds(run) for name, run in cases}
    results: list[Result] = [
        measured("9", f"bonds per colloid at {name}", value) for name, value in bonds.items()
    ]
    names = list(bonds)
    corner, opposite = bonds[names[0]], bonds[names[-1]]
    results.append(
        claimed(
            "9",
            f"bonds per colloid at {names[0]} less those at {names[-1]}",
            corner - opposite,
            "clusters in the upper left, a suspension in the lower right",
            "positive",
        )
    )
    table: dict[str, Column] = {
        "case": names,
        "bonds_per_colloid": [value.value for value in bonds.values()],
        "error": [value.error for value in bonds.values()],
    }
    return Outcome(_draw_states(cases, len(SURFACE_POTENTIALS)), table, results)


def _draw_correlations(
    cases: CaseScenes, directories: Directories
) -> tuple[Figure, dict[str, list[float]], list[RadialDistribution]]:
    """g(r) of each, shifted with respect to each other as in the paper."""
    figure, axes = one_panel("distance $r$ [$R$]", "pair correlation $g(r)$, shifted")
    found, table = [], dict[str, list[float]]()
    for number, ((name, scene), colour) in enumerate(zip(cases, shades(len(cases)), strict=True)):
        distance, correlation = pair_correlation(directories[scene])
        found.append(correlation)
        axes.plot(distance, correlation.g + 2 * number, color=colour, linewidth=1, label=name)
        table["r/R"] = distance.tolist()
        table[name] = correlation.g.tolist()
        table[f"{name} error"] = correlation.error.tolist()
    axes.legend()
    return figure, table, found


def first_peak(found: RadialDistribution, radius: float) -> tuple[Estimate, Estimate]:
    """Its distance [R], to half a bin, and its height."""
    highest = int(np.argmax(found.g))
    width = found.distance[1] - found.distance[0]
    place = Estimate(float(found.distance[highest] / radius), float(width / radius / 2))
    return place, Estimate(float(found.g[highest]), float(found.error[highest]))


def _make_screening(directories: Directories, quality: Quality) -> Outcome:
    cases = by_kappa(quality)
    figure, table, found = _draw_correlations(cases, directories)
    radius = cases[0][1].model.reduced_radius
    peaks = [first_peak(each, radius) for each in found]
    bonds = [_bonds(directories[scene]) for _, scene in cases]
    results = [
        measured("10", f"first peak at {name} [R]", place)
        for (name, _), (place, _) in zip(cases, peaks, strict=True)
    ]
    results.append(
        claimed(
            "10",
            "first peak at the least kappa less that at the largest [R]",
            peaks[0][0] - peaks[-1][0],
            "with kappa the main peak moves to smaller distances",
            "positive",
        )
    )
    results.append(
        claimed(
            "10",
            "bonds per colloid at the largest kappa less those at the least",
            bonds[-1] - bonds[0],
            "with kappa the minimum becomes deeper, so that clusters form",
            "positive",
        )
    )
    return Outcome(figure, table, results)


def _make_surface(directories: Directories, quality: Quality) -> Outcome:
    cases = by_surface_potential(quality)
    figure, table, found = _draw_correlations(cases, directories)
    radius = cases[0][1].model.reduced_radius
    heights = [first_peak(each, radius)[1] for each in found]
    results = [
        measured("11", f"height of the first peak at {name}", height)
        for (name, _), height in zip(cases, heights, strict=True)
    ]
    results.append(
        claimed(
            "11",
            "height of the first peak at 20 mV less that at 50 mV",
            heights[0] - heights[-1],
            "the surface potential adjusts the depth of the minimum: repulsion shuts it",
            "positive",
            REVERSED,
        )
    )
    return Outcome(figure, table, results)


def layering(distance: Array, found: RadialDistribution) -> Estimate:
    """Root of the mean of (g - 1)^2 between six and eight radii, what noise adds taken off."""
    inside = (distance > LAYERS[0]) & (distance < LAYERS[1])
    noise = float((found.error[inside] ** 2).mean())
    square = float(((found.g[inside] - 1) ** 2).mean()) - noise
    return Estimate(max(square, 0.0) ** 0.5, (noise / inside.sum()) ** 0.5)


def _make_fractions(
    number: str, kappa: float, directories: Directories, quality: Quality
) -> Outcome:
    cases = by_fraction(kappa, quality)
    figure, table, found = _draw_correlations(cases, directories)
    distance = np.array(table["r/R"])
    layers = [layering(distance, each) for each in found]
    results = [
        measured(number, f"r.m.s. of g - 1 from 6 to 8 R at {name}", layer)
        for (name, _), layer in zip(cases, layers, strict=True)
    ]
    results.append(
        claimed(
            number,
            "the same at 35 % less that at 7 %",
            layers[-1] - layers[0],
            "long-range correlations become more pronounced with the volume fraction",
            "positive",
        )
    )
    return Outcome(figure, table, results)


def _scenes(cases: CaseScenes) -> list[Scene]:
    return [scene for _, scene in cases]


def _fraction_scenes(kappa: float, quality: Quality) -> list[Scene]:
    return _scenes(by_fraction(kappa, quality))


FIGURES = (
    PaperFigure(
        "9",
        "Snapshots by surface potential (columns) and screening (rows), 14 % of colloids after "
        "about 1 s, seen along z.",
        _make_diagram,
        lambda quality: _scenes(phase_diagram(quality)),
    ),
    PaperFigure(
        "10",
        "g(r) by the inverse screening length, 20 mV, 14 %.",
        _make_screening,
        lambda quality: _scenes(by_kappa(quality)),
    ),
    PaperFigure(
        "11",
        "g(r) by the surface potential, 2e8 / m, 14 %.",
        _make_surface,
        lambda quality: _scenes(by_surface_potential(quality)),
    ),
    *(
        PaperFigure(
            number,
            f"g(r) by the volume fraction, 20 mV, {kappa:.2g} / m.",
            partial(_make_fractions, number, kappa),
            partial(_fraction_scenes, kappa),
        )
        for number, kappa in (("12", 1.4e8), ("13", 1.6e8))
    ),
)

"""Soft disks in a colour field under the two thermostats: Figs. 1 to 8."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from analysis.estimate import Estimate
from analysis.periodic import wrapped
from lammps_inputs import Scene
from narrows.papers.delhommelle_2005.state_points import (
    ALL,
    CRYSTAL,
    FLUID,
    PHI,
    columns,
    disks,
    ladders_of,
    largest,
    number,
    numbers,
)
from narrows.papers.drawing import one_panel, paper_remark, points
from narrows.papers.figure import Column, Directories, Outcome, PaperFigure, Quality
from narrows.papers.results import PaperNumber, Result, claimed, compared, measured

FIELD = "field $F$"
REENTRANCE = 1.75
DENSITIES = (0.5, 0.75, 0.92, 1.03)
BROKEN = {"quick": (1.5, 2.25, 10.0, 70.0), "full": (1.5, 2.25, 10.0, 70.0)}
HERE = "shorter than the paper's 5000 + 5000 time units; `--quick` from a crystal at rest"


def _fields(thermostat: str, quality: Quality) -> list[float]:
    """Of the crystal's figures."""
    if quality == "quick":
        return [0.5, 1.0, 1.5, 1.75, 4.0, 6.0] if thermostat == "kinetic" else [0.5, 1.0, 1.5, 4.0]
    shared = [0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0, 3.0, 4.0, 6.0, 8.0]
    return [*shared, 10.0, 80.0, 100.0] if thermostat == "kinetic" else [*shared, 10.0]


def _crystals(thermostat: str, quality: Quality) -> dict[float, Scene]:
    return {f: disks(CRYSTAL, f, thermostat, quality) for f in _fields(thermostat, quality)}


def _map(thermostat: str, quality: Quality) -> dict[tuple[float, float], Scene]:
    """Density and field of the maps of phi."""
    quick: tuple[tuple[float, float], ...] = tuple((n, REENTRANCE) for n in DENSITIES)
    if thermostat == "configurational":
        quick = (
            (0.5, REENTRANCE),
            (FLUID, REENTRANCE),
            (FLUID, 4.0),
            (CRYSTAL, 1.5),
            (CRYSTAL, 4.0),
        )
    fields = (0.5, 1.0, 1.5, REENTRANCE, 2.25, 4.0, 6.0, 10.0)
    full = tuple((n, f) for n in DENSITIES for f in fields)
    return {
        (n, f): disks(n, f, thermostat, quality) for n, f in (quick if quality == "quick" else full)
    }


def _series(
    directories: Directories, scenes: dict[float, Scene], keys: Sequence[str]
) -> dict[str, list[Estimate]]:
    return {key: numbers(directories, scenes.values(), key) for key in keys}


def _table(scenes: dict[float, Scene], series: dict[str, list[Estimate]]) -> dict[str, Column]:
    return {"field": list(scenes), **columns(series)}


def _energy_and_pressure(
    thermostat: str, directories: Directories, quality: Quality
) -> tuple[Figure, dict[str, Column], dict[float, Estimate], dict[float, Estimate]]:
    scenes = _crystals(thermostat, quality)
    series = _series(directories, scenes, ("potential_energy", "pressure"))
    figure, axes = one_panel(FIELD, "potential energy of a disk")
    right = axes.twinx()
    points(axes, list(scenes), series["potential_energy"], label="potential energy")
    points(right, list(scenes), series["pressure"], 1, label="pressure, potential part", mfc="none")
    right.set_ylabel("pressure, potential part")
    right.spines["right"].set_visible(True)
    if max(scenes) > 20:
        axes.set_xscale("log")
    figure.legend(loc="outside upper center", ncols=2)
    energy, pressure = (dict(zip(scenes, values, strict=True)) for values in series.values())
    return figure, _table(scenes, series), energy, pressure


def _figure_1(directories: Directories, quality: Quality) -> Outcome:
    figure, table, energy, pressure = _energy_and_pressure("kinetic", directories, quality)
    results = []
    for name, values in (("potential energy", energy), ("pressure", pressure)):
        results += [
            claimed(
                "1",
                f"{name} at F = 1 less that at F = 0.5",
                values[1.0] - values[0.5],
                "slight increases as the crystal is strained",
                "positive",
            ),
            claimed(
                "1",
                f"{name} at F = 1 less that at F = 4",
                values[1.0] - values[4.0],
                "drops at melting, then steadily decreases",
                "positive",
                HERE,
            ),
        ]
    return Outcome(figure, table, results)


def _temperature_and_order(
    thermostat: str, key: str, directories: Directories, quality: Quality
) -> tuple[Figure, dict[str, Column], dict[str, dict[float, Estimate]]]:
    scenes = _crystals(thermostat, quality)
    series = _series(directories, scenes, (key, PHI, "bond_order"))
    figure, axes = one_panel(FIELD, f"{key.replace('_', ' ')}, order parameters")
    labels = (key.replace("_", " "), r"lane order $\phi$ among neighbours", r"bond order $\psi_6$")
    for place, (label, values) in enumerate(zip(labels, series.values(), strict=True)):
        points(axes, list(scenes), values, place, label=label)
    if max(scenes) > 20:
        axes.set_xscale("log")
    axes.legend()
    axes.set_ylim(bottom=0)
    by_field = {name: dict(zip(scenes, values, strict=True)) for name, values in series.items()}
    return figure, _table(scenes, series), by_field


def _figure_2(directories: Directories, quality: Quality) -> Outcome:
    key = "configurational_temperature"
    figure, table, found = _temperature_and_order("kinetic", key, directories, quality)
    crystal = PaperNumber.printed("0.75")
    crystals = _crystals("kinetic", quality)
    results = [
        compared("2", "psi_6 at F = 0.5", found["bond_order"][0.5], crystal),
        claimed(
            "2",
            "psi_6 at F = 1 less that at F = 1.5",
            found["bond_order"][1.0] - found["bond_order"][1.5],
            "the crystal melts at F = 1.25",
            "positive",
        ),
        compared("2", "phi at F = 6", found[PHI][6.0], PaperNumber.printed("0.8"), HERE),
        measured("2", "phi of all disks at F = 6", number(directories, crystals[6.0], ALL)),
        compared(
            "2", "psi_6 at F = 4", found["bond_order"][4.0], PaperNumber.printed("0.59"), HERE
        ),
        compared("2", "T_conf at F = 6", found[key][6.0], PaperNumber.printed("0.04"), HERE),
        compared("2", "T_conf at F = 0.5", found[key][0.5], PaperNumber.printed("1.0")),
    ]
    return Outcome(figure, table, results)


def _draw_disks(axes: Axes, directories: Directories, scene: Scene) -> None:
    """The last frame, plus filled and minus open."""
    run = directories[scene]
    particles = run.particles()
    where = wrapped(particles.positions[-1], run.box.sizes)
    for name, face in (("plus", "C0"), ("minus", "none")):
        x, y = where[particles.species == name].T
        axes.scatter(x, y, s=9, facecolor=face, edgecolor="C0", linewidth=0.5)
    axes.set(xlim=(0, run.length), ylim=(0, run.width), aspect="equal", xticks=[], yticks=[])


def _snapshots(
    directories: Directories, scenes: dict[float, Scene]
) -> tuple[Figure, dict[str, Column], list[Estimate]]:
    figure = Figure(figsize=(3.0 * len(scenes), 3.4), layout="constrained")
    panels = figure.subplots(1, len(scenes), squeeze=False)[0]
    order = numbers(directories, scenes.values(), PHI)
    for axes, (field, scene), phi in zip(panels, scenes.items(), order, strict=True):
        if scene not in directories:
            axes.set(title=f"F = {field:g}: {phi.reason}", xticks=[], yticks=[])
            continue
        _draw_disks(axes, directories, scene)
        axes.set_title(f"F = {field:g}, $\\phi$ = {phi.number:.2f}", fontsize=9)
    return figure, _table(scenes, {PHI: order}), order


def _broken(quality: Quality) -> dict[float, Scene]:
    return {field: disks(FLUID, field, "kinetic", quality) for field in BROKEN[quality]}


def _figure_3(directories: Directories, quality: Quality) -> Outcome:
    figure, table, order = _snapshots(directories, _broken(quality))
    return Outcome(
        figure,
        table,
        [
            compared("3", "phi at F = 10", order[2], PaperNumber.printed("0.56"), HERE),
            compared("3", "phi at F = 70", order[3], PaperNumber.printed("0.5"), HERE),
            measured("3", "phi at F = 1.5, two lanes in the paper", order[0], HERE),
            measured("3", "phi at F = 2.25, lanes that break up", order[1], HERE),
        ],
    )


def _map_of_order(
    thermostat: str, directories: Directories, quality: Quality
) -> tuple[Figure, dict[str, Column], dict[tuple[float, float], Estimate]]:
    scenes = _map(thermostat, quality)
    order = dict(zip(scenes, numbers(directories, scenes.values(), PHI), strict=True))
    figure, axes = one_panel(FIELD, "density $n$")
    density, field = np.array(list(scenes)).T
    shown = axes.scatter(
        field,
        density,
        c=[np.nan if each.value is None else each.value for each in order.values()],
        plotnonfinite=True,
        s=240,
        marker="s",
        vmin=0,
        vmax=1,
        cmap="viridis",
    )
    for (n, f), phi in order.items():
        label = "stopped" if phi.value is None else f"{phi.value:.2f}"
        axes.annotate(label, (f, n), ha="center", va="center", color="w", fontsize=6)
    figure.colorbar(shown, label=r"lane order $\phi$ among neighbours")
    axes.margins(0.15)
    table: dict[str, Column] = {
        "density": density.tolist(),
        "field": field.tolist(),
    }
    of_all = numbers(directories, scenes.values(), ALL)
    return figure, table | columns({ALL: of_all, PHI: list(order.values())}), order


def _figure_4(directories: Directories, quality: Quality) -> Outcome:
    figure, table, order = _map_of_order("kinetic", directories, quality)
    at = {n: order[n, REENTRANCE] for n in DENSITIES}
    results: list[Result] = [
        compared("4", "phi at n = 0.5, F = 1.75", at[0.5], PaperNumber.printed("0.34"), HERE),
        compared("4", "phi at n = 1.03, F = 1.75", at[1.03], PaperNumber.printed("0.36"), HERE),
    ]
    for n in (0.75, 0.92):
        results += [
            claimed(
                "4",
                f"phi at n = {n}, F = 1.75, less 0.7",
                at[n] - 0.7,
                "phi > 0.7",
                "positive",
                HERE,
            ),
            claimed(
                "4",
                f"phi at n = {n} less that at n = 0.5, F = 1.75",
                at[n] - at[0.5],
                "lanes for intermediate densities only: reentrance",
                "positive",
                HERE,
            ),
        ]
    return Outcome(figure, table, results)


def _figure_5(directories: Directories, quality: Quality) -> Outcome:
    figure, table, energy, pressure = _energy_and_pressure("configurational", directories, quality)
    results = []
    for name, values in (("potential energy", energy), ("pressure", pressure)):
        results += [
            claimed(
                "5",
                f"{name} at F = {high:g} less that at F = {low:g}",
                values[high] - values[low],
                claim,
                "positive",
                HERE,
            )
            for low, high, claim in (
                (0.5, 1.0, "steadily increases"),
                (1.0, 1.5, "jumps at melting between 1.0 and 1.25"),
                (1.5, 4.0, "steadily increases"),
            )
        ]
    return Outcome(figure, table, results)


def _figure_6(directories: Directories, quality: Quality) -> Outcome:
    key = "kinetic_temperature"
    figure, table, found = _temperature_and_order("configurational", key, directories, quality)
    order = largest(list(found[PHI].values()))
    results = [
        compared("6", "psi_6 at F = 0.5", found["bond_order"][0.5], PaperNumber.printed("0.75")),
        compared("6", "T_kin at F = 0.5", found[key][0.5], PaperNumber.printed("1.0")),
        claimed(
            "6",
            "T_kin at F = 4 less that at F = 1.5",
            found[key][4.0] - found[key][1.5],
            "a steep increase of the kinetic temperature",
            "positive",
            HERE,
        ),
        claimed(
            "6",
            "0.12 less the largest phi",
            0.12 - order,
            "no lanes: phi <= 0.12",
            "positive",
            HERE,
        ),
    ]
    return Outcome(figure, table, results)


def _clusters(quality: Quality) -> dict[float, Scene]:
    fields = (REENTRANCE, 4.0) if quality == "quick" else (1.0, REENTRANCE, 4.0, 10.0)
    return {field: disks(FLUID, field, "configurational", quality) for field in fields}


def _figure_7(directories: Directories, quality: Quality) -> Outcome:
    scenes = _clusters(quality)
    figure, table, _ = _snapshots(directories, scenes)
    variance = numbers(directories, scenes.values(), "number_variance")
    return Outcome(
        figure,
        table,
        [
            claimed(
                "7",
                f"variance of numbers in boxes at F = {max(scenes):g} less that at F = "
                f"{min(scenes):g}",
                variance[-1] - variance[0],
                "the field induces density inhomogeneities",
                "positive",
                HERE,
            )
        ],
    )


def _figure_8(directories: Directories, quality: Quality) -> Outcome:
    figure, table, order = _map_of_order("configurational", directories, quality)
    axes = figure.axes[0]
    paper_remark(axes, 0.02, 0.02, "paper: below 0.24 everywhere", va="bottom")
    top = largest(list(order.values()))
    claim = "phi < 0.24 at every density and field"
    return Outcome(
        figure,
        table,
        [claimed("8", "0.24 less the largest phi", 0.24 - top, claim, "positive", HERE)],
    )


FIGURES = (
    PaperFigure(
        "1",
        "Potential energy and pressure against the field, kinetic thermostat, n = 1.03.",
        _figure_1,
        lambda quality: list(_crystals("kinetic", quality).values()),
        partial=True,
    ),
    PaperFigure(
        "2",
        "Configurational temperature and order parameters, kinetic thermostat, n = 1.03.",
        _figure_2,
        lambda quality: list(_crystals("kinetic", quality).values()),
        partial=True,
    ),
    PaperFigure(
        "3",
        "Snapshots at n = 0.75, kinetic thermostat; plus filled, minus open.",
        _figure_3,
        lambda quality: list(_broken(quality).values()),
        partial=True,
    ),
    PaperFigure(
        "4",
        "Lane order by density and field, kinetic thermostat.",
        _figure_4,
        lambda quality: list(_map("kinetic", quality).values()),
        partial=True,
    ),
    PaperFigure(
        "5",
        "Potential energy and pressure against the field, configurational thermostat, n = 1.03.",
        _figure_5,
        lambda quality: list(_crystals("configurational", quality).values()),
        partial=True,
    ),
    PaperFigure(
        "6",
        "Kinetic temperature and order parameters, configurational thermostat, n = 1.03.",
        _figure_6,
        lambda quality: list(_crystals("configurational", quality).values()),
        partial=True,
    ),
    PaperFigure(
        "7",
        "Snapshots at n = 0.75, configurational thermostat; plus filled, minus open.",
        _figure_7,
        lambda quality: list(_clusters(quality).values()),
        partial=True,
    ),
    PaperFigure(
        "8",
        "Lane order by density and field, configurational thermostat.",
        _figure_8,
        lambda quality: list(_map("configurational", quality).values()),
        partial=True,
    ),
)


def ladders(quality: Quality) -> list[list[Scene]]:
    """At full quality each field begins as the one before ended, as the paper does it."""
    if quality == "quick":
        return []
    scenes = [scene for figure in FIGURES for scene in figure.scenes(quality)]
    return ladders_of(scenes, "field")

"""Spheres: four thermostats in a colour field, and shear. Figs. 9 to 11."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure

from analysis.correlated_mean import mean
from analysis.estimate import Estimate
from analysis.measures.settling_speed import sampled_frames
from analysis.periodic import wrapped
from analysis.run_directory import RunDirectory
from lammps_inputs import Scene
from narrows.papers.delhommelle_2005.state_points import (
    ALL,
    PHI,
    THERMOSTATS,
    columns,
    ladders_of,
    largest,
    numbers,
    sheared,
    spheres,
)
from narrows.papers.drawing import one_panel, points
from narrows.papers.figure import Column, Directories, Outcome, PaperFigure, Quality
from narrows.papers.results import PaperNumber, Result, claimed, compared, measured

MIXED = {"kinetic_x": 0.36, "kinetic_y": 0.30, "configurational": 0.19}  # largest phi printed
STRINGS = (10.0, 20.0)  # rates; Fig. 11 has 10 and 35
FLOW = ("shear_viscosity", "configurational_temperature", "kinetic_temperature")
WAVES = 12  # wave numbers across the flow, at most


def _fields(quality: Quality) -> tuple[float, ...]:
    return (1.0, 3.0, 5.0) if quality == "quick" else (0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0)


def _driven(quality: Quality) -> dict[str, dict[float, Scene]]:
    return {
        thermostat: {field: spheres(field, thermostat, quality) for field in _fields(quality)}
        for thermostat in THERMOSTATS
    }


def _table(
    directories: Directories,
    scenes: Mapping[str, Mapping[float, Scene]],
    abscissa: str,
    keys: Sequence[str],
) -> dict[str, Column]:
    """A row for each thermostat and field, or rate."""
    rows = [(name, at, scene) for name, each in scenes.items() for at, scene in each.items()]
    names, at, order = zip(*rows, strict=True)
    series = {key: numbers(directories, order, key) for key in keys}
    return {"thermostat": names, abscissa: at, **columns(series)}


def _figure_9(directories: Directories, quality: Quality) -> Outcome:
    figure = Figure(figsize=(9.4, 4.1), layout="constrained")
    left, right = figure.subplots(1, 2)
    driven = _driven(quality)
    order, pressure = dict[str, list[Estimate]](), dict[str, list[Estimate]]()
    for place, (thermostat, scenes) in enumerate(driven.items()):
        order[thermostat] = numbers(directories, scenes.values(), PHI)
        pressure[thermostat] = numbers(directories, scenes.values(), "pressure")
        points(left, list(scenes), pressure[thermostat], place, label=THERMOSTATS[thermostat])
        points(right, list(scenes), order[thermostat], place)
    left.set(xlabel="field $F$", ylabel="pressure, potential part")
    right.set(xlabel="field $F$", ylabel=r"lane order $\phi$ among neighbours", ylim=(0, 1))
    left.legend()
    results: list[Result] = []
    for thermostat, limit in MIXED.items():
        top = largest(order[thermostat])
        results += [
            compared(
                "9",
                f"largest phi, {THERMOSTATS[thermostat]} fixed",
                top,
                PaperNumber(limit, 0.01),
                "of fewer fields and shorter runs",
            ),
            claimed(
                "9",
                f"largest phi, kinetic energy fixed, less {THERMOSTATS[thermostat]} fixed",
                largest(order["kinetic"]) - top,
                "lanes with the full kinetic thermostat only",
                "positive",
            ),
            claimed(
                "9",
                f"pressure at the largest field, {THERMOSTATS[thermostat]} fixed, less kinetic "
                "energy fixed",
                pressure[thermostat][-1] - pressure["kinetic"][-1],
                "only lanes lower the pressure; the others jam",
                "positive",
            ),
        ]
    return Outcome(figure, _table(directories, driven, "field", ("pressure", ALL, PHI)), results)


def _rates(thermostat: str, quality: Quality) -> tuple[float, ...]:
    """Those that a ladder outlives: docs/lanes.md."""
    if thermostat == "configurational":
        quick, full = (1.0, 2.0, 4.0, 5.0, 6.0, 7.0), (0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0)
        return quick if quality == "quick" else full
    if quality == "quick":
        return (1.0, 4.0, 7.0, 10.0, 20.0)
    return (0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0, 10.0, 15.0, 20.0)


def _flow_curve(quality: Quality) -> dict[str, dict[float, Scene]]:
    return {
        thermostat: {
            rate: sheared(rate, thermostat, quality) for rate in _rates(thermostat, quality)
        }
        for thermostat in ("kinetic", "configurational")
    }


def _figure_10(directories: Directories, quality: Quality) -> Outcome:
    figure, axes = one_panel("shear rate", "viscosity")
    curve = _flow_curve(quality)
    found = dict[str, dict[float, Estimate]]()
    for place, (thermostat, scenes) in enumerate(curve.items()):
        values = numbers(directories, scenes.values(), "shear_viscosity")
        found[thermostat] = dict(zip(scenes, values, strict=True))
        points(axes, list(scenes), values, place, label=THERMOSTATS[thermostat])
    axes.set(xscale="log", ylim=(0, None))
    axes.legend()
    kinetic, configurational = found["kinetic"], found["configurational"]
    fastest = max(configurational)
    lane = "with a kinetic thermostat strings form above 1.5: the viscosity drops sharply"
    results = [
        claimed(
            "10",
            "viscosity at rate 1 less that at 4, configurational temperature fixed",
            configurational[1.0] - configurational[4.0],
            "shear thinning below",
            "positive",
        ),
        claimed(
            "10",
            f"viscosity at rate {fastest:g} less that at 5, configurational temperature fixed",
            configurational[fastest] - configurational[5.0],
            "shear thickening above 7",
            "positive",
            "the multiplier still falls, and T_conf is above the temperature set",
        ),
        claimed(
            "10",
            "viscosity at rate 1 less that at 10, kinetic energy fixed",
            kinetic[1.0] - kinetic[10.0],
            lane,
            "positive",
        ),
        claimed(
            "10",
            "viscosity at rate 4, configurational less kinetic",
            configurational[4.0] - kinetic[4.0],
            lane,
            "positive",
        ),
    ]
    return Outcome(figure, _table(directories, curve, "rate", FLOW), results)


def string_order(run: RunDirectory) -> Estimate:
    """Largest S(k) of waves across the flow: that of a lattice of strings, N for perfect ones."""
    frames = run.particles().positions[sampled_frames(run)]
    _, width, height = run.box.sizes
    m = np.arange(0, WAVES + 1)
    series = []
    for frame in frames:
        y = np.exp(2j * np.pi * np.outer(m, frame[:, 1]) / width)
        z = np.exp(2j * np.pi * np.outer(np.arange(-WAVES, WAVES + 1), frame[:, 2]) / height)
        structure = np.abs(y @ z.T) ** 2 / len(frame[:, 1])
        structure[0, WAVES] = 0.0  # k = 0
        series.append(float(structure.max()))
    return mean(series)


def _figure_11(directories: Directories, quality: Quality) -> Outcome:
    scenes = {rate: sheared(rate, "kinetic", quality) for rate in STRINGS}
    figure = Figure(figsize=(7, 7), layout="constrained")
    panels = figure.subplots(len(scenes), 2)
    order = []
    for row, (rate, scene) in zip(panels, scenes.items(), strict=True):
        run = directories[scene]
        where = wrapped(run.particles().positions[-1], run.box.sizes)
        for axes, (across, up) in zip(row, ((0, 1), (1, 2)), strict=True):
            axes.scatter(where[:, across], where[:, up], s=8)
            axes.set(
                xlabel=f"${'xyz'[across]}$",
                ylabel=f"${'xyz'[up]}$",
                aspect="equal",
                title=f"rate {rate:g}",
            )
        order.append(string_order(run))
    table: dict[str, Column] = {
        "rate": list(scenes),
        "string_order": [each.value for each in order],
        "string_order_error": [each.error for each in order],
    }
    return Outcome(
        figure,
        table,
        [
            measured("11", "largest S(k) across the flow at rate 10", order[0]),
            claimed(
                "11",
                "largest S(k) across the flow at rate 20 less that at 10",
                order[1] - order[0],
                "strings become more pronounced as the rate is increased",
                "positive",
            ),
        ],
    )


FIGURES = (
    PaperFigure(
        "9",
        "Pressure and lane order of spheres in a field under four thermostats.",
        _figure_9,
        lambda quality: [s for each in _driven(quality).values() for s in each.values()],
        partial=True,
    ),
    PaperFigure(
        "10",
        "Viscosity against shear rate.",
        _figure_10,
        lambda quality: [s for each in _flow_curve(quality).values() for s in each.values()],
        partial=True,
    ),
    PaperFigure(
        "11",
        "Sheared spheres under the kinetic thermostat, seen along z and along the flow.",
        _figure_11,
        lambda quality: [sheared(rate, "kinetic", quality) for rate in STRINGS],
    ),
)


def ladders(quality: Quality) -> list[list[Scene]]:
    """Of rates; at full quality of fields too."""
    sheared_scenes = [
        scene for each in _flow_curve(quality).values() for scene in each.values()
    ] + [sheared(rate, "kinetic", quality) for rate in STRINGS]
    driven = [scene for each in _driven(quality).values() for scene in each.values()]
    return [
        *ladders_of(sheared_scenes, "rate"),
        *(ladders_of(driven, "field") if quality == "full" else []),
    ]

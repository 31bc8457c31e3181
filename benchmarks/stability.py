"""Where the method holds, where it is inaccurate and where it breaks, one axis at a time.

    python benchmarks/stability.py --out runs/stability [--axis tau_MD ...] [--long] [--jobs 2]
                                   [--page docs/stability.md]

Every point is a run directory; the command may be stopped and given again. A point is

- refused: the scene says so, before anything runs;
- broken: stopped by an error, without a number, or off by more than `Criterion.broken`;
- inaccurate: off by more than `Criterion.inaccurate`;
- stable: neither, and not off by more than `Criterion.broken` for certain;
- open: neither, and not even that is certain.

Off means that the whole 95 % interval is beyond the limit. What is broken or inaccurate has to be
told by somebody, the scene's warning, the engine's error or a note of the analysis; the exit code
is 1 when a broken point is told by nobody. Prints the table and writes it, with the map
(stability.png), into the folder; the states of each axis into the page.
"""

import argparse
import math
import re
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Literal

from matplotlib.figure import Figure

from analysis import Estimate, RunDirectoryError
from analysis.analyze import summary_of
from lammps_inputs import SceneError, make_scene
from lammps_inputs.deck import check_engine, warnings
from lammps_inputs.viscosity import viscosity
from narrows.markdown import number, replace_block, table
from run_files.progress import is_begun, read_failure
from srd_driver.sweep import Run, available_cores, is_finished, run_all

State = Literal["refused", "broken", "inaccurate", "open", "stable"]
COLOURS = {"refused": "0.6", "broken": "C3", "inaccurate": "C1", "open": "C0", "stable": "C2"}

Fields = dict[str, Any]
CHANNEL: Fields = {"duration": 300, "equilibration": 20}
SHEAR_WAVE: Fields = {"length": 96, "width": 32, "shear_wave": 0.6}


@dataclass(frozen=True)
class Criterion:
    """A ratio that is 1 when all is right, and how far off is inaccurate or broken."""

    ratio: str
    inaccurate: float
    broken: float
    unit: float | None = None  # what the number is compared with; None: its theory


FLUID_TEMPERATURE = Criterion("temperature", 0.01, 0.1, 1.0)
COLLOID_TEMPERATURE = Criterion("colloid_temperature", 0.05, 0.5, 1.0)
VISCOSITY = Criterion("viscosity", 0.1, 0.5)
MOBILITY = Criterion("settling_speed", 0.1, 0.5, 0.33)  # v_s / g in the linear regime


@dataclass(frozen=True)
class Axis:
    """One thing that varies: the fields of each of its values."""

    name: str
    scene: str
    values: tuple[float, ...]
    fields: Callable[[float], Fields]
    criterion: Criterion
    engine: str = "mpc"


@dataclass
class Point:
    """A value of an axis and what became of it."""

    axis: Axis
    value: float
    run: Run | None = None
    state: State = "stable"
    ratio: Estimate | None = None
    told: list[str] = field(default_factory=list)


def shear_wave(collision_time: float = 0.1, density: float = 10, angle: float = 90) -> Fields:
    """A decaying wave, sampled and followed according to kinetic theory's decay time."""
    theory = viscosity(density, collision_time, min(angle, 179.9))
    decay_time = 1 / (theory * (2 * math.pi / SHEAR_WAVE["width"]) ** 2)
    return SHEAR_WAVE | {
        "collision_time": collision_time,
        "density": density,
        "angle": angle,
        "sampling_interval": max(2 * collision_time, 0.05 * decay_time),
        "duration": max(60 * collision_time, 3 * decay_time),
    }


def time_step(value: float, duration: float = 400) -> Fields:
    """tau_MD at a collision time of 0.06, or one step a collision where it is longer."""
    collision_time = max(0.06, value)
    return {
        "collision_time": collision_time,
        "md_steps_per_collision": round(collision_time / value),
        "colloids": 5,
        "gravity": 0.0,
        "duration": duration,
        "equilibration": duration / 10,
    }


def slit(value: float) -> Fields:
    """A slit of that width; where it must be, the walls are nearer than the usual 2 a0."""
    return CHANNEL | {"width": value, "wall_sigma": min(2.0, value / 2), "gravity": 0.0}


def channel_collision_time(value: float) -> Fields:
    steps = min(1000, round(value / 0.001))
    return CHANNEL | {
        "collision_time": value,
        "md_steps_per_collision": steps,
        "gravity": 0.0,
        "sampling_interval": max(0.75, 2 * value),
    }


AXES = (
    Axis(
        "tau_MD",
        "channel",
        (0.001, 0.004, 0.01, 0.02, 0.03, 0.06, 0.075, 0.1, 0.2),
        time_step,
        COLLOID_TEMPERATURE,
    ),
    Axis(
        "tau_MD (reference)",
        "channel",
        (0.02, 0.06, 0.2),
        lambda value: time_step(value, duration=50),
        COLLOID_TEMPERATURE,
        "reference",
    ),
    Axis(
        "gravity",
        "channel",
        (0.1, 0.2, 0.3, 0.5, 1, 2, 3, 10, 100, 1e4),
        lambda value: CHANNEL | {"gravity": value},
        replace(MOBILITY, ratio="settling_speed / g"),
    ),
    Axis(
        "density, colloids",
        "channel",
        (0.1, 0.3, 1, 2, 3, 5, 10, 20, 50, 100, 200),
        lambda value: CHANNEL | {"density": value, "duration": min(300, 3000 / value)},
        COLLOID_TEMPERATURE,
    ),
    Axis(
        "density, fluid",
        "bulk",
        (0.1, 0.3, 0.5, 1, 2, 3, 5, 10, 20, 50, 100, 200),
        lambda value: shear_wave(density=value),
        VISCOSITY,
    ),
    Axis(
        "angle",
        "bulk",
        (1, 3, 10, 30, 60, 90, 120, 150, 170, 177, 179, 180),
        lambda value: shear_wave(angle=value),
        VISCOSITY,
    ),
    Axis(
        "collision time, fluid",
        "bulk",
        (0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1, 2, 3, 10),
        lambda value: shear_wave(collision_time=value),
        VISCOSITY,
    ),
    Axis(
        "collision time, colloids",
        "channel",
        (0.001, 0.003, 0.015, 0.05, 0.1, 0.3, 1, 3, 10),
        channel_collision_time,
        COLLOID_TEMPERATURE,
    ),
    Axis(
        "colloid radius",
        "channel",
        (0.05, 0.1, 0.2, 0.3, 0.5, 1, 2, 3, 4, 4.9),
        lambda value: (
            CHANNEL
            | {"colloid_radius": value, "gravity": 0.0, "duration": 2000 if value > 3 else 300}
        ),
        COLLOID_TEMPERATURE,
    ),
    Axis(
        "wall strength",
        "channel",
        (0, 1e-8, 1e-6, 1e-4, 1e-2, 1, 1e2, 1e4, 1e6, 1e8),
        lambda value: CHANNEL | {"wall_strength": value, "width": 5},
        COLLOID_TEMPERATURE,
    ),
    Axis(
        "colloids in 40 x 10",
        "channel",
        (1, 3, 5, 7, 8, 9, 10, 11),
        lambda value: CHANNEL | {"colloids": int(value)},
        COLLOID_TEMPERATURE,
    ),
    Axis(
        "width",
        "channel",
        (4.0, 4.001, 4.01, 4.05, 4.1, 4.3, 4.5, 5, 6, 8, 10),
        slit,
        COLLOID_TEMPERATURE,
    ),
)
LONG = (
    Axis(
        "MD steps",
        "channel",
        (1e5, 1e6, 1e7),
        lambda value: {"duration": value * 0.001 - 20, "equilibration": 20},
        COLLOID_TEMPERATURE,
    ),
    Axis(
        "MD steps, no thermostat",
        "channel",
        (1e5, 1e6, 1e7),
        lambda value: {
            "duration": value * 0.001 - 20,
            "equilibration": 20,
            "thermostat": "none",
        },
        FLUID_TEMPERATURE,
    ),
)


def points(folder: Path, axes: Iterable[Axis]) -> list[Point]:
    """All points; those that the scene refuses have no run."""
    found = []
    for axis in axes:
        for value in axis.values:
            point = Point(axis, value)
            name = f"{axis.name}={value:g}".replace(" ", "_").replace(",", "")
            try:
                scene = make_scene(axis.scene, **axis.fields(value))
                check_engine(scene, axis.engine)
            except SceneError as error:
                point.state = "refused"
                point.told.append(f"refused: {error}")
            else:
                point.run = Run(folder / name, scene, axis.engine)
                point.told += [f"warned: {warning}" for warning in warnings(scene, axis.engine)]
            found.append(point)
    return found


def execute(todo: list[Point], jobs: int) -> None:
    """Run what is neither finished nor known to fail, and judge all points."""
    runs = [point.run for point in todo if point.run and not _is_over(point.run)]
    failures = {failure.run.folder: failure.message for failure in run_all(runs, jobs)}
    for point in todo:
        if point.run:
            judge(point, failures.get(point.run.folder))


def _is_over(run: Run) -> bool:
    if not is_begun(run.folder):
        return False
    return is_finished(run) or read_failure(run.folder) is not None


def judge(point: Point, failure: str | None) -> None:
    """The state of a point that ran, and what told it."""
    assert point.run
    if is_begun(point.run.folder):
        failure = failure or read_failure(point.run.folder)
    if failure:
        point.state = "broken"
        point.told.append(f"stopped: {_cause(failure)}")
        return
    try:
        summary = summary_of(point.run.folder)
    except RunDirectoryError as error:
        point.state = "broken"
        point.told.append(f"analysis: {error}")
        return
    point.told += [f"analysis: {warning}" for warning in summary["warnings"]]
    criterion = point.axis.criterion
    entry = summary[criterion.ratio.partition(" ")[0]]
    unit = criterion.unit or entry.get("theory")
    if criterion.ratio.endswith("/ g"):
        assert unit
        unit *= point.value
    estimate = Estimate.of_json(entry)
    if estimate.value is None or estimate.error is None or not unit:
        point.state = "broken"
        reason = estimate.reason or "theory has none"
        point.told.append(f"analysis: {criterion.ratio}: {reason}")
        return
    point.ratio = estimate / unit
    off, reach = abs(point.ratio.number - 1), point.ratio.half_width()
    if off - reach > criterion.broken or not math.isfinite(off + reach):
        point.state = "broken"
    elif off - reach > criterion.inaccurate:
        point.state = "inaccurate"
    elif off + reach > criterion.broken:
        point.state = "open"


def _cause(failure: str) -> str:
    """What the engine said, without where its files are and how to go on."""
    text = failure.partition("; nothing written")[0].rpartition("ERROR")[2]
    return re.sub(r" \(\S*(/|: )[^)]*\)", "", text).removeprefix(" on proc 0: ").strip()


def map_table(judged: list[Point]) -> str:
    """One row an axis: its values by state."""
    states: tuple[State, ...] = ("stable", "open", "inaccurate", "broken", "refused")
    rows = []
    for axis in dict.fromkeys(point.axis for point in judged):
        cells = [
            ", ".join(f"{p.value:g}" for p in judged if p.axis is axis and p.state == state)
            for state in states
        ]
        rows.append((axis.name, axis.criterion.ratio, *cells))
    return table(("axis", "must be 1", *states), rows)


def table_of_points(judged: list[Point]) -> str:
    """One row a point."""
    rows = [
        (
            point.axis.name,
            f"{point.value:g}",
            number(point.ratio.value, point.ratio.error) if point.ratio else "",
            point.state,
            "; ".join(point.told).replace("\n", "; "),
        )
        for point in judged
    ]
    return table(("axis", "value", "ratio", "state", "told by"), rows)


def draw(judged: list[Point], file: Path) -> None:
    """A panel an axis: the ratio that should be 1, coloured by state."""
    axes = list(dict.fromkeys(point.axis for point in judged))
    columns = 4
    rows = math.ceil(len(axes) / columns)
    sheet = Figure(figsize=(4 * columns, 3 * rows), layout="constrained")
    panels = sheet.subplots(rows, columns, squeeze=False).flat
    for axis, panel in zip(axes, panels, strict=False):
        low, high = 0.5, 1.5
        for place, point in enumerate(point for point in judged if point.axis is axis):
            colour = COLOURS[point.state]
            if point.ratio is None:
                panel.plot(place, high, "x", color=colour)
            else:
                shown = min(max(point.ratio.number, low), high)
                panel.errorbar(place, shown, point.ratio.normal_error, fmt="o", color=colour)
        panel.axhspan(1 - axis.criterion.inaccurate, 1 + axis.criterion.inaccurate, color="0.92")
        labels = [f"{value:g}" for value in axis.values]
        panel.set_xticks(range(len(labels)), labels, rotation=60)
        panel.set(xlabel=axis.name, ylabel=axis.criterion.ratio, ylim=(low - 0.05, high + 0.05))
    for panel in list(panels):
        panel.set_visible(False)
    for state, colour in COLOURS.items():
        sheet.axes[0].plot([], [], "o", color=colour, label=state)
    sheet.axes[0].legend(fontsize="small")
    sheet.savefig(file, dpi=110)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0] if __doc__ else None)
    parser.add_argument("--out", type=Path, required=True, help="folder of the runs")
    parser.add_argument("--axis", nargs="*", help="only these")
    parser.add_argument("--long", action="store_true", help="also runs of up to 1e7 MD steps")
    parser.add_argument("--jobs", type=int, default=available_cores())
    parser.add_argument("--page", type=Path, help="Markdown page whose table is renewed")
    options = parser.parse_args()
    axes = [*AXES, *(LONG if options.long else ())]
    if options.axis:
        axes = [axis for axis in axes if axis.name in options.axis]
    judged = points(options.out, axes)
    execute(judged, options.jobs)
    text = f"{map_table(judged)}\n\n{table_of_points(judged)}"
    print(text)
    (options.out / "stability.md").write_text(text + "\n", encoding="utf-8")
    draw(judged, options.out / "stability.png")
    if options.page:
        replace_block(options.page, "table", map_table(judged))
    silent = [point for point in judged if point.state == "broken" and not point.told]
    for point in silent:
        print(f"broken without a word: {point.axis.name} = {point.value:g}", file=sys.stderr)
    return 1 if silent else 0


if __name__ == "__main__":
    sys.exit(main())

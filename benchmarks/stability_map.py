"""Where the method holds, where it is inaccurate and where it breaks, one axis at a time.

What `stability.py` and `stability_suspensions.py` have in common.

Every point is a run directory; the command may be stopped and given again. A point is

- refused: the scene says so, before anything runs;
- broken: stopped by an error, without a number, or off by more than `Criterion.broken`;
- inaccurate: off by more than `Criterion.inaccurate`;
- stable: neither, and not off by more than `Criterion.broken` for certain;
- open: neither, and not even that is certain.

Where several ratios must be 1, the worst of their states is that of the point.

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
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from matplotlib.figure import Figure

from analysis import Estimate, RunDirectoryError
from analysis.analyze import summary_of
from below_scene import changed, execute, make
from lammps_inputs import Scene, SceneError
from lammps_inputs.deck import check_engine, warnings
from narrows.markdown import number, replace_block, table
from run_files.progress import is_begun, read_failure
from srd_driver.sweep import Run, available_cores, is_finished

State = Literal["refused", "broken", "inaccurate", "open", "stable"]
COLOURS = {"refused": "0.6", "broken": "C3", "inaccurate": "C1", "open": "C0", "stable": "C2"}

STATES: tuple[State, ...] = ("stable", "open", "inaccurate", "broken", "refused")  # worse and worse

Fields = dict[str, Any]
Summary = dict[str, Any]


@dataclass(frozen=True)
class Criterion:
    """A ratio that is 1 when all is right, and how far off is inaccurate or broken."""

    ratio: str
    inaccurate: float
    broken: float
    measure: Callable[[Summary, Scene], Estimate]


def over(name: str, unit: float = 1.0) -> Callable[[Summary, Scene], Estimate]:
    """A number of the summary over what it should be; `diffusion.msd` is that of a nested one."""

    def measure(summary: Summary, scene: Scene) -> Estimate:
        for part in name.split("."):
            summary = summary[part]
        return Estimate.of_json(summary) / unit

    return measure


FLUID_TEMPERATURE = Criterion("temperature", 0.01, 0.1, over("temperature"))
COLLOID_TEMPERATURE = Criterion("colloid_temperature", 0.05, 0.5, over("colloid_temperature"))


@dataclass(frozen=True)
class Axis:
    """One thing that varies: the fields of each of its values."""

    name: str
    scene: str
    values: tuple[Any, ...]
    fields: Callable[[Any], Fields]
    criteria: tuple[Criterion, ...]
    engine: str = "mpc"


@dataclass
class Point:
    """A value of an axis and what became of it."""

    axis: Axis
    value: float | str
    run: Run | None = None
    state: State = "stable"
    ratios: dict[Criterion, Estimate] = field(default_factory=dict)
    told: list[str] = field(default_factory=list)

    @property
    def label(self) -> str:
        """The value, as in tables and names of folders."""
        return self.value if isinstance(self.value, str) else f"{self.value:g}"

    def worsen(self, state: State) -> None:
        """To a state, unless it is in a worse one."""
        self.state = max(self.state, state, key=STATES.index)

    @property
    def is_silent(self) -> bool:
        """Whether it broke without a word."""
        return self.state == "broken" and not self.told


def points(folder: Path, axes: Iterable[Axis]) -> list[Point]:
    """All points; those that the scene refuses have no run."""
    found = []
    for axis in axes:
        for value in axis.values:
            point = Point(axis, value)
            name = f"{axis.name}={point.label}".replace(" ", "_").replace(",", "")
            fields = axis.fields(value)
            try:
                scene = make(axis.scene, fields)
                with changed(fields):
                    check_engine(scene, axis.engine)
            except SceneError as error:
                point.state = "refused"
                point.told.append(f"refused: {error}")
            else:
                point.run = Run(folder / name, scene, axis.engine)
                point.told += [f"warned: {warning}" for warning in warnings(scene, axis.engine)]
            found.append(point)
    return found


def run_and_judge(todo: list[Point], jobs: int) -> None:
    """Run what is neither finished nor known to fail, and judge all points."""
    runs = {
        point.run: point.axis.fields(point.value)
        for point in todo
        if point.run and not _is_over(point.run)
    }
    failures = {failure.run.folder: failure.message for failure in execute(runs, jobs)}
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
    for criterion in point.axis.criteria:
        ratio = criterion.measure(summary, point.run.scene)
        if ratio.value is None or ratio.error is None:
            point.worsen("broken")
            point.told.append(f"analysis: {criterion.ratio}: {ratio.reason}")
        else:
            point.ratios[criterion] = ratio
            point.worsen(state_of(criterion, ratio))


def state_of(criterion: Criterion, ratio: Estimate) -> State:
    """What a ratio with an error says."""
    off, reach = abs(ratio.number - 1), ratio.half_width()
    if off - reach > criterion.broken or not math.isfinite(off + reach):
        return "broken"
    if off - reach > criterion.inaccurate:
        return "inaccurate"
    return "open" if off + reach > criterion.broken else "stable"


def _cause(failure: str) -> str:
    """What the engine said, without where its files are and how to go on."""
    text = failure.partition("; nothing written")[0].rpartition("ERROR")[2]
    return re.sub(r" \(\S*(/|: )[^)]*\)", "", text).removeprefix(" on proc 0: ").strip()


def map_table(judged: list[Point]) -> str:
    """One row an axis: its values by state."""
    rows = []
    for axis in dict.fromkeys(point.axis for point in judged):
        cells = [
            ", ".join(p.label for p in judged if p.axis is axis and p.state == state)
            for state in STATES
        ]
        rows.append((axis.name, ", ".join(each.ratio for each in axis.criteria), *cells))
    return table(("axis", "must be 1", *STATES), rows)


def table_of_points(judged: list[Point]) -> str:
    """One row a point."""
    rows = [
        (
            point.axis.name,
            point.label,
            ", ".join(number(ratio.value, ratio.error) for ratio in point.ratios.values()),
            point.state,
            "; ".join(point.told).replace("\n", "; "),
        )
        for point in judged
    ]
    return table(("axis", "value", "ratios", "state", "told by"), rows)


def draw(judged: list[Point], file: Path) -> None:
    """A panel an axis: the ratios that should be 1, each coloured by its state."""
    axes = list(dict.fromkeys(point.axis for point in judged))
    columns = 4
    rows = math.ceil(len(axes) / columns)
    sheet = Figure(figsize=(4 * columns, 3 * rows), layout="constrained")
    panels = sheet.subplots(rows, columns, squeeze=False).flat
    for axis, panel in zip(axes, panels, strict=False):
        low, high = 0.5, 1.5
        for place, point in enumerate(point for point in judged if point.axis is axis):
            if not point.ratios:
                panel.plot(place, high, "x", color=COLOURS[point.state])
            for marker, criterion in zip("osd^", axis.criteria, strict=False):
                if ratio := point.ratios.get(criterion):
                    shown = min(max(ratio.number, low), high)
                    colour = COLOURS[state_of(criterion, ratio)]
                    panel.errorbar(place, shown, ratio.normal_error, fmt=marker, color=colour)
        inaccurate = axis.criteria[0].inaccurate
        panel.axhspan(1 - inaccurate, 1 + inaccurate, color="0.92")
        labels = [point.label for point in judged if point.axis is axis]
        panel.set_xticks(range(len(labels)), labels, rotation=60)
        told = ", ".join(each.ratio for each in axis.criteria)
        panel.set(xlabel=axis.name, ylabel=told, ylim=(low - 0.05, high + 0.05))
    for panel in list(panels):
        panel.set_visible(False)
    for state, colour in COLOURS.items():
        sheet.axes[0].plot([], [], "o", color=colour, label=state)
    sheet.axes[0].legend(fontsize="small")
    sheet.savefig(file, dpi=110)


def arguments(about: str | None) -> argparse.ArgumentParser:
    """Of a benchmark of that docstring."""
    parser = argparse.ArgumentParser(description=about.partition("\n")[0] if about else None)
    parser.add_argument("--out", type=Path, required=True, help="folder of the runs")
    parser.add_argument("--axis", nargs="*", help="only these")
    parser.add_argument("--jobs", type=int, default=available_cores())
    parser.add_argument("--page", type=Path, help="Markdown page whose table is renewed")
    return parser


def draw_map(axes: Iterable[Axis], options: argparse.Namespace, mark: str) -> int:
    """All points, tables and figure in the folder, the map between the marks; the exit code."""
    if options.axis:
        axes = [axis for axis in axes if axis.name in options.axis]
    judged = points(options.out, axes)
    run_and_judge(judged, options.jobs)
    text = f"{map_table(judged)}\n\n{table_of_points(judged)}"
    print(text)
    (options.out / "stability.md").write_text(text + "\n", encoding="utf-8")
    draw(judged, options.out / "stability.png")
    if options.page:
        replace_block(options.page, mark, map_table(judged))
    silent = [point for point in judged if point.is_silent]
    for point in silent:
        print(f"broken without a word: {point.axis.name} = {point.label}", file=sys.stderr)
    return 1 if silent else 0

"""Error of every quantity against run time, for all engines and settings: chart and table.

What `pareto.py` and `pareto_suspensions.py` have in common.

1. The speed of each setting is measured, processor seconds for a unit of simulated time: all
   settings in turn, several rounds, the median of each; kept in speed.json.
2. Each setting runs for the same budget of processor time, in run directories that are skipped
   when finished: value, statistical error and so the systematic deviation from the truth.
3. A run of t seconds then has the error sqrt(b^2 + s^2 T / t), s the statistical error after T
   seconds. b is the deviation, or the error to which it is known where that is more: no setting is
   credited with an accuracy that was not measured.

The front is the smallest error any setting reaches in a time. Errors are relative; where the truth
is 0 they are in units of the quantity. Prints the tables, and writes them with the figure
(pareto.png) into the folder.
"""

import argparse
import json
import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from analysis.analyze import summary_of
from analysis.estimate import Estimate, mean_of_repeats
from below_scene import changed, execute, make
from lammps_inputs import Scene
from narrows.markdown import table
from processor_time import cost, endless
from run_files.writing import replace_text
from srd_driver.sweep import Run, available_cores

ROUNDS, PIECE_SECONDS = 3, 0.25  # of the measurement of speed
CONVERGED = 20  # budgets of the run that is the truth
TARGETS = (0.1, 0.03, 0.01)
SECONDS = np.geomspace(1, 1e5, 101)  # run times that the chart shows
COLOURS = {"srd": "C1", "mpc": "C0", "reference": "C2"}

Fields = dict[str, Any]
Summary = dict[str, Any]


@dataclass(frozen=True)
class Setting:
    """An engine and the fields that are not those of its study; and its budgets."""

    engine: str
    changes: tuple[tuple[str, Any], ...] = ()
    budgets: int = 1

    def __str__(self) -> str:
        return " ".join([self.engine, *(f"{name}={value}" for name, value in self.changes)])


def setting(engine: str, budgets: int = 1, **changes: Any) -> Setting:
    return Setting(engine, tuple(changes.items()), budgets)


@dataclass(frozen=True)
class Quantity:
    """A number of a run that is compared with its truth: theory's, or that of a converged run.

    Settings that change one of the `physics` have another truth, and are left out. `key` is the
    quantity in summary.json that has the same relative error, for the chart of `narrows advise`.
    """

    name: str
    measure: Callable[[Summary, Scene], Estimate]
    truth: float | Setting
    physics: tuple[str, ...] = ()
    key: str | None = None

    def concerns(self, chosen: Setting) -> bool:
        return not any(name in self.physics for name, _ in chosen.changes)


@dataclass(frozen=True)
class Study:
    """One scene at all settings, and what is asked of it.

    Runs are lengthened to the budget where the scene is stationary, else repeated by seeds. Fields
    may be those of `below_scene`. `unit` is a time of which the price is told [t0]: its name, and
    what it is in a scene.
    """

    scene: str
    fields: Fields
    settings: tuple[Setting, ...]
    quantities: tuple[Quantity, ...]
    stationary: bool = True
    converged: Setting | None = None
    name: str = ""
    unit: tuple[str, Callable[[Scene], float]] | None = None

    def all_fields(self, chosen: Setting) -> Fields:
        return self.fields | dict(chosen.changes)

    def make(self, chosen: Setting, **more: Any) -> Scene:
        return make(self.scene, self.all_fields(chosen) | more)

    @property
    def all_settings(self) -> tuple[Setting, ...]:
        return (*self.settings, *([self.converged] if self.converged else []))


def entry(summary: Summary, name: str) -> Estimate:
    """A number of a summary; `diffusion.msd` is that of a nested one."""
    for part in name.split("."):
        summary = summary[part]
    return Estimate.of_json(summary)


def plain(name: str, scale: float = 1) -> Callable[[Summary, Scene], Estimate]:
    return lambda summary, scene: entry(summary, name).scaled(scale)


@dataclass(frozen=True)
class Result:
    """A setting's number: what a run of `seconds` processor seconds gives, against the truth."""

    quantity: Quantity
    study: Study
    setting: Setting
    value: float
    statistical: float
    seconds: float
    deviation: float
    deviation_error: float
    price: float | None = None  # processor seconds for the study's unit of time

    @property
    def panel(self) -> str:
        """What is compared with each other."""
        return f"{self.study.name}: {self.quantity.name}" if self.study.name else self.quantity.name

    def error(self, seconds: Any) -> Any:
        """Expected error of a run of so many processor seconds."""
        floor = max(abs(self.deviation), self.deviation_error)
        return np.hypot(floor, self.statistical * np.sqrt(self.seconds / seconds))

    def time_to(self, error: float) -> float:
        """Processor seconds to that error; infinite where the deviation is larger."""
        floor = max(abs(self.deviation), self.deviation_error)
        if error <= floor:
            return math.inf
        return self.seconds * self.statistical**2 / (error**2 - floor**2)


def measure_speeds(scenes: dict[str, tuple[Scene, str, Fields]], file: Path) -> dict[str, float]:
    """Processor seconds for one time unit of each scene; those in the file are not measured."""
    known: dict[str, float] = json.loads(file.read_text()) if file.exists() else {}
    missing = [name for name in scenes if name not in known]
    rounds: dict[str, list[float]] = {name: [] for name in missing}
    for _ in range(ROUNDS):
        for name in missing:
            rounds[name].append(_cost(*scenes[name]))
    known |= {name: median(costs) for name, costs in rounds.items()}
    replace_text(file, json.dumps(known, indent=1) + "\n")
    return known


def _cost(scene: Scene, engine: str, fields: Fields) -> float:
    with changed(fields), endless(scene, engine) as simulation:
        return cost(simulation, PIECE_SECONDS)


def plan(
    study: Study, number: int, folder: Path, speeds: dict[str, float], budget: float
) -> dict[Setting, list[Run]]:
    """The runs that spend the budget on each setting."""
    planned: dict[Setting, list[Run]] = {}
    for chosen in study.all_settings:
        seconds = budget * chosen.budgets
        scene = study.make(chosen)
        affordable = seconds / speeds[_name(number, chosen)]
        if study.stationary:
            duration = max(_rounded(affordable - scene.equilibration), 20.0)
            scenes = [study.make(chosen, duration=duration)]
        else:
            count = max(2, min(12, round(affordable / (scene.duration + scene.equilibration))))
            scenes = [study.make(chosen, seed=seed) for seed in range(1, count + 1)]
        planned[chosen] = [
            Run(folder / f"{_name(number, chosen)}_seed={scene.seed}", scene, chosen.engine)
            for scene in scenes
        ]
    return planned


def _rounded(value: float) -> float:
    """To two digits, so that a run has a length one can quote."""
    return float(f"{max(value, 0):.2g}")


def _name(number: int, chosen: Setting) -> str:
    return f"{number}_{chosen}".replace(" ", "_")


def evaluate(
    study: Study, number: int, planned: dict[Setting, list[Run]], speeds: dict[str, float]
) -> Iterable[Result]:
    """All numbers of a study; settings that do not tell a number are left out."""
    summaries = {
        chosen: [(summary_of(run.folder), run.scene) for run in runs]
        for chosen, runs in planned.items()
    }
    for quantity in study.quantities:
        told = {
            chosen: mean_of_repeats([quantity.measure(*one) for one in of_runs])
            for chosen, of_runs in summaries.items()
        }
        if isinstance(quantity.truth, Setting):
            truth = told[quantity.truth]
            if truth.value is None or truth.error is None:
                print(
                    f"{study.name}: no {quantity.name}, as its truth is not known: {truth.reason}"
                )
                continue
            true_value, true_error = truth.value, truth.error
        else:
            true_value, true_error = quantity.truth, 0.0
        unit = true_value or 1.0
        for chosen in filter(quantity.concerns, study.settings):
            found = told[chosen]
            if found.value is None or not found.error:
                print(f"{study.name}: no {quantity.name} from {chosen}: {found.reason}")
                continue
            simulated = sum(summary["simulated_time"] for summary, _ in summaries[chosen])
            speed = speeds[_name(number, chosen)]
            yield Result(
                quantity,
                study,
                chosen,
                found.value,
                found.error / unit,
                simulated * speed,
                (found.value - true_value) / unit,
                math.hypot(found.error, true_error) / unit,
                speed * study.unit[1](summaries[chosen][0][1]) if study.unit else None,
            )


def recommended(results: list[Result]) -> str:
    """For each quantity and wanted error the setting that reaches it first."""
    rows = ["| quantity | error | setting | processor time |", "|---|---|---|---|"]
    for name in dict.fromkeys(result.panel for result in results):
        of_it = [result for result in results if result.panel == name]
        for target in TARGETS:
            best = min(of_it, key=lambda result: result.time_to(target))
            seconds = best.time_to(target)
            told = "none | "
            if seconds < math.inf:
                told = f"{best.setting} | " + (f"{seconds:.2g} s" if seconds > 1 else "below 1 s")
            rows.append(f"| {name} | {target:.0%} | {told} |")
    return "\n".join(rows)


def full_table(results: list[Result]) -> str:
    """Every measured number."""
    units = dict.fromkeys(result.study.unit[0] for result in results if result.study.unit)
    columns = (
        *("quantity", "setting", *(f"price of {name} [s]" for name in units)),
        *("value", "deviation", "error after 10 s, statistical"),
    )
    rows = []
    for result in results:
        after = result.statistical * math.sqrt(result.seconds / 10)
        deviation = f"{result.deviation:+.2%} +- {result.deviation_error:.2%}"
        numbers = (f"{result.value:.4g}", deviation, f"{after:.2%}")
        price = [] if result.price is None else [f"{result.price:.3g}"]
        rows.append((result.panel, str(result.setting), *price, *numbers))
    return table(columns, rows)


def chart_of(results: list[Result]) -> dict[str, Any]:
    """What `narrows advise` reads (`narrows/chart.py`)."""
    return {
        "settings": [
            {
                "scene": result.study.scene,
                "quantity": result.quantity.key,
                "engine": result.setting.engine,
                "fields": dict(result.setting.changes),
                "deviation": result.deviation,
                "deviation_error": result.deviation_error,
                "error_after_10_s": result.statistical * math.sqrt(result.seconds / 10),
            }
            for result in results
            if result.quantity.key
        ]
    }


def draw(results: list[Result], file: Path) -> None:
    """A panel a quantity: error against run time of each setting, and the front."""
    names = list(dict.fromkeys(result.panel for result in results))
    sheet = Figure(figsize=(16, 4 * math.ceil(len(names) / 4)), layout="constrained")
    panels = sheet.subplots(math.ceil(len(names) / 4), 4, squeeze=False).flat
    for name, panel in zip(names, panels, strict=False):
        of_it = [result for result in results if result.panel == name]
        for result in of_it:
            colour = COLOURS[result.setting.engine]
            panel.loglog(SECONDS, result.error(SECONDS), color=colour, lw=0.8)
        front = np.min([result.error(SECONDS) for result in of_it], axis=0)
        panel.loglog(SECONDS, front, color="k", lw=2.5, alpha=0.6)
        panel.set(title=name, xlabel="processor time [s]", ylabel="error", ylim=(2e-4, 2))
    for engine, colour in COLOURS.items():
        sheet.axes[0].plot([], [], color=colour, label=engine)
    sheet.axes[0].plot([], [], color="k", lw=2.5, alpha=0.6, label="front")
    sheet.axes[0].legend(fontsize="small")
    for panel in panels:
        panel.set_visible(False)
    sheet.savefig(file, dpi=110)


def arguments(about: str | None) -> argparse.ArgumentParser:
    """Of a benchmark of that docstring."""
    parser = argparse.ArgumentParser(description=about.partition("\n")[0] if about else None)
    parser.add_argument("--out", type=Path, required=True, help="folder of the runs")
    parser.add_argument("--quick", action="store_true", help="a third of the time")
    parser.add_argument("--jobs", type=int, default=available_cores())
    parser.add_argument("--page", type=Path, help="Markdown page whose table is renewed")
    return parser


def measure(studies: tuple[Study, ...], folder: Path, budget: float, jobs: int) -> list[Result]:
    """All runs of all studies, and the numbers of each setting; tables and figure in the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    scenes = {
        _name(number, chosen): (study.make(chosen), chosen.engine, study.all_fields(chosen))
        for number, study in enumerate(studies)
        for chosen in study.all_settings
    }
    speeds = measure_speeds(scenes, folder / "speed.json")
    planned = [plan(study, number, folder, speeds, budget) for number, study in enumerate(studies)]
    todo = {
        run: study.all_fields(chosen)
        for study, of_study in zip(studies, planned, strict=True)
        for chosen, runs in of_study.items()
        for run in runs
    }
    if failures := execute(todo, jobs):
        raise SystemExit("\n".join(f"{one.run.folder}: {one.message}" for one in failures))
    results = [
        result
        for number, (study, of_study) in enumerate(zip(studies, planned, strict=True))
        for result in evaluate(study, number, of_study, speeds)
    ]
    text = f"{recommended(results)}\n\n{full_table(results)}\n"
    print(text)
    (folder / "pareto.md").write_text(text, encoding="utf-8")
    draw(results, folder / "pareto.png")
    return results

"""Runs what is missing, makes the figures, writes the files.

A run that fails costs the figures that need it, and no others.
"""

import csv
import hashlib
import time as clock
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from importlib.metadata import version
from pathlib import Path

import matplotlib

from analysis import RunDirectory, RunDirectoryError
from lammps_inputs import Scene
from lammps_inputs.deck import Engine
from narrows.reproduce.drawing import STYLE
from narrows.reproduce.page import Made, Report, write_page
from narrows.reproduce.paper_figure import Outcome, Paper, PaperFigure, Quality
from narrows.reproduce.results import Result, write_results
from srd_driver.sweep import Advance, Run, is_finished, run_all

ENGINE: Engine = "mpc"


def select(paper: Paper, numbers: Sequence[str]) -> list[PaperFigure]:
    """The figures of these numbers in the paper's order, all of them for none.

    Raises:
        ValueError: for a number that is not among them.
    """
    known = [figure.number for figure in paper.figures]
    for number in numbers:
        if number not in known:
            raise ValueError(f"figure {number!r}: {paper.name} has {', '.join(known)}")
    return [figure for figure in paper.figures if not numbers or figure.number in numbers]


def run_of(scene: Scene, out: Path) -> Run:
    """The run of a scene; its folder is named by what it is, so that figures share it."""
    digest = hashlib.sha256((scene.toml() + ENGINE).encode()).hexdigest()[:10]
    name = f"{scene.name}-{scene.length:g}x{scene.width:g}-{scene.colloids or 'no'}-{digest}"
    return Run(out / "runs" / name, scene, ENGINE)


@dataclass
class Plan:
    """What a command will do: figures and the distinct runs they need, the longest first."""

    paper: Paper
    figures: Sequence[PaperFigure]
    quality: Quality
    out: Path
    runs: list[Run] = field(init=False)

    def __post_init__(self) -> None:
        scenes = {scene: None for figure in self.figures for scene in figure.scenes(self.quality)}
        longest_first = sorted(scenes, key=lambda s: -s.fluid_particles * s.collisions)
        self.runs = [run_of(scene, self.out) for scene in longest_first]

    def finished(self) -> int:
        """How many of the runs are finished already.

        Raises:
            RunError: when a run directory holds another scene or engine.
        """
        return sum(is_finished(run) for run in self.runs)


@dataclass(frozen=True)
class Done:
    """What came of a command: results, and one line for each figure that was left out."""

    results: list[Result]
    left_out: list[str]


def carry_out(plan: Plan, jobs: int, report: Callable[[Advance], None] | None = None) -> Done:
    """Run what is not finished, make every figure whose runs are there, write all files.

    Raises:
        RunError: before anything runs, when a run directory holds another scene or engine.
        OSError: when the results cannot be written.
    """
    began = clock.perf_counter()
    plan.out.mkdir(parents=True, exist_ok=True)
    failures = {failure.run.scene: failure for failure in run_all(plan.runs, jobs, report)}
    ran = clock.perf_counter()
    folders = {run.scene: run.folder for run in plan.runs if run.scene not in failures}
    made, left_out = list[Made](), list[str]()
    for figure in plan.figures:
        scenes = figure.scenes(plan.quality)
        failed = next((failures[scene] for scene in scenes if scene in failures), None)
        try:
            if failed:
                raise RunDirectoryError(f"{failed.run.folder}: {failed.message}")
            with matplotlib.rc_context(STYLE):
                outcome = figure.make(folders, plan.quality)
                picture = _write_figure(plan.out / f"figure-{figure.number}", outcome)
        except ValueError as error:  # RunDirectoryError, and a fit that its points do not determine
            left_out.append(f"figure {figure.number} left out: {error}")
        else:
            made.append(Made(figure, outcome, scenes, picture))
    results = [result for each in made for result in each.outcome.results]
    write_results(plan.out / "results.json", results)
    write_page(
        plan.out / "index.html",
        Report(
            plan.paper,
            plan.quality,
            made,
            left_out,
            runs=len(plan.runs),
            run_seconds=sum(_wall_seconds(folder) for folder in folders.values()),
            this_run_seconds=ran - began,
            figure_seconds=clock.perf_counter() - ran,
            jobs=jobs,
            seeds=sorted({scene.seed for scene in folders}),
            versions={name: version(name) for name in ("narrows", "lammps", "numpy", "matplotlib")},
        ),
    )
    return Done(results, left_out)


def _wall_seconds(folder: Path) -> float:
    try:
        return RunDirectory(folder).wall_seconds() or 0.0
    except RunDirectoryError:
        return 0.0


def _write_figure(stem: Path, outcome: Outcome) -> Path:
    """PNG, PDF and CSV; the PNG's path."""
    for suffix in (".png", ".pdf"):
        outcome.picture.savefig(f"{stem}{suffix}")
    with Path(f"{stem}.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(outcome.table)
        writer.writerows(zip(*outcome.table.values(), strict=True))
    return Path(f"{stem}.png")

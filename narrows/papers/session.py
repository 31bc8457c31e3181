"""Runs what is missing, makes the figures, writes the files.

A run that fails costs the figures that need all of theirs, and others their points.
"""

import csv
import hashlib
import time as clock
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from importlib.metadata import version
from itertools import pairwise
from pathlib import Path

import matplotlib

from analysis import RunDirectory, RunDirectoryError, system_picture
from lammps_inputs import Scene
from lammps_inputs.engines import default_engine
from narrows.papers.drawing import STYLE
from narrows.papers.figure import Outcome, Paper, PaperFigure, Quality
from narrows.papers.page import Made, Report, write_page
from narrows.papers.results import Result, write_results
from srd_driver.sweep import Advance, Run, is_finished, run_all

LONGEST_DRAWN = 64.0  # length of a box over its width, that a page can show
MOST_DRAWN = 5000  # particles


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


def run_of(scene: Scene, engine: str, out: Path, after: Run | None = None) -> Run:
    """The run of a scene; its folder is named by what it is, so that figures share it.

    With `after` it begins as that run ended: its field `start` is that run's directory.
    """
    before = after.folder.name if after else ""
    digest = hashlib.sha256((scene.toml() + engine + before).encode()).hexdigest()[:10]
    system = scene.system
    sizes = "x".join(f"{size:g}" for size in system.box.sizes)
    name = f"{scene.name}-{sizes}-{system.particles or 'no'}-{digest}"
    if after:
        scene = scene.make(**(scene.model_dump() | {"start": str(after.folder.resolve())}))
    return Run(out / "runs" / name, scene, engine, after)


@dataclass
class Plan:
    """What a command will do: figures and the distinct runs they need, the longest first."""

    paper: Paper
    figures: Sequence[PaperFigure]
    quality: Quality
    out: Path
    run_by_scene: dict[Scene, Run] = field(init=False)

    def __post_init__(self) -> None:
        ladders = self.paper.ladders(self.quality)
        before = {scene: last for ladder in ladders for last, scene in pairwise(ladder)}
        self.run_by_scene = {}
        for figure in self.figures:
            for scene in figure.scenes(self.quality):
                self._add(scene, before)

    def _add(self, scene: Scene, before: Mapping[Scene, Scene]) -> Run:
        """The run of a scene, after those that it comes after."""
        if scene not in self.run_by_scene:
            after = self._add(before[scene], before) if scene in before else None
            engine = self.paper.engine or default_engine(scene.system)
            self.run_by_scene[scene] = run_of(scene, engine, self.out, after)
        return self.run_by_scene[scene]

    @property
    def runs(self) -> list[Run]:
        """The distinct runs, the longest first."""
        return sorted(self.run_by_scene.values(), key=lambda run: -run.scene.system.work)

    def finished(self) -> int:
        """How many of the runs are finished already.

        Raises:
            RunError: when a run directory holds another scene or engine.
        """
        return sum(is_finished(run) for run in self.runs)


@dataclass(frozen=True)
class Done:
    """What came of a command: results, and one line for each figure or run that was left out."""

    results: list[Result]
    left_out: list[str]


def draw_system(directories: Mapping[Scene, RunDirectory], path: Path) -> tuple[Path, str] | None:
    """A picture of the largest system among the runs that fits a page, and what it shows.

    None where no run has kept its particles, or that trajectory cannot be read.
    """

    def fits(scene: Scene) -> bool:
        system = scene.system
        kept = any(output.kind == "trajectory" for output in system.outputs)
        flat = system.box.sizes[0] <= LONGEST_DRAWN * system.box.sizes[1]
        return kept and flat and 0 < system.particles <= MOST_DRAWN

    chosen = max(filter(fits, directories), key=lambda scene: scene.system.particles, default=None)
    if chosen is None:
        return None
    run = directories[chosen]
    try:
        system_picture.draw(run).savefig(path, dpi=120)
    except RunDirectoryError:  # a damaged trajectory is told of by what needs it
        return None
    sizes = " x ".join(f"{size:g}" for size in run.box.sizes)
    return path, (
        f"scene {chosen.name}, particles: {chosen.system.particles}, box {sizes}; at the "
        f"end of a run: runs/{run.path.name}."
    )


def carry_out(plan: Plan, jobs: int, report: Callable[[Advance], None] | None = None) -> Done:
    """Run what is not finished, make every figure whose runs are there, write all files.

    Raises:
        RunError: before anything runs, when a run directory holds another scene or engine.
        OSError: when the results cannot be written.
    """
    began = clock.perf_counter()
    plan.out.mkdir(parents=True, exist_ok=True)
    failed_runs = {failure.run: failure for failure in run_all(plan.runs, jobs, report)}
    ran = clock.perf_counter()
    planned = plan.run_by_scene.items()
    failures = {scene: failed_runs[run] for scene, run in planned if run in failed_runs}
    directories = {
        scene: RunDirectory(run.folder) for scene, run in planned if run not in failed_runs
    }
    made, left_out = list[Made](), list[str]()
    for figure in plan.figures:
        scenes = figure.scenes(plan.quality)
        failed = [failures[scene] for scene in scenes if scene in failures]
        lacking = [f"{each.run.folder}: {each.message}" for each in failed]
        try:
            if failed and not (figure.partial and len(failed) < len(scenes)):
                raise RunDirectoryError(lacking[0])
            with matplotlib.rc_context(STYLE):
                outcome = figure.make(directories, plan.quality)
                picture = _write_figure(plan.out / f"figure-{figure.number}", outcome)
        except ValueError as error:  # RunDirectoryError, and a fit that its points do not determine
            left_out.append(f"figure {figure.number} left out: {error}")
        else:
            left_out += [f"figure {figure.number} is without {each}" for each in lacking]
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
            system=draw_system(directories, plan.out / "system.png"),
            runs=len(plan.runs),
            engines=sorted({run.engine for run in plan.runs}),
            run_seconds=sum(run.wall_seconds() or 0.0 for run in directories.values()),
            this_run_seconds=ran - began,
            figure_seconds=clock.perf_counter() - ran,
            jobs=jobs,
            seeds=sorted({scene.seed for scene in directories}),
            versions={name: version(name) for name in ("narrows", "lammps", "numpy", "matplotlib")},
        ),
    )
    return Done(results, left_out)


def _write_figure(stem: Path, outcome: Outcome) -> Path:
    """PNG, PDF and CSV; the PNG's path."""
    for suffix in (".png", ".pdf"):
        outcome.picture.savefig(f"{stem}{suffix}")
    with Path(f"{stem}.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(outcome.table)
        writer.writerows(zip(*outcome.table.values(), strict=True))
    return Path(f"{stem}.png")

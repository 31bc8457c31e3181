"""Progress bars on a terminal; silence elsewhere."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeRemainingColumn

from srd_driver import Simulation
from srd_driver.sweep import Advance

PACE_SECONDS = 300.0  # the time remaining is told from the pace of the last five minutes
BAR = 100_000  # steps of the bar

ReportRuns = Callable[[Advance], None]
ReportAnalysis = Callable[[int, int], None]


def finish_with_progress(simulation: Simulation) -> None:
    """Run to the end, showing rate, remaining time and the mean velocity since the start."""
    if simulation.rank != 0 or not sys.stderr.isatty():
        simulation.finish()
        return
    scene = simulation.scene
    moving = bool(scene.system.species)
    begin = simulation.time
    position = simulation.mean_colloid_position() if moving else 0.0
    with Progress(
        TextColumn(scene.name, markup=False),
        BarColumn(),
        TextColumn("{task.completed:.0f} of {task.total:.0f} t0"),
        TextColumn("{task.description}"),
        TimeRemainingColumn(),
        console=Console(stderr=True),
    ) as progress:
        task = progress.add_task("", total=scene.system.clock.end)

        def report(now: Simulation) -> None:
            rate = (now.time - begin) / max(progress.tasks[0].elapsed or 0.0, 1e-3)
            description = f"{rate:.3g} t0/s"
            if moving:
                speed = (now.mean_colloid_position() - position) / (now.time - begin)
                description += f", moving at {speed:+.4f} a0/t0"
            progress.update(task, completed=now.time, description=description)

        simulation.finish(report)


@contextmanager
def progress_of_runs() -> Iterator[tuple[ReportRuns | None, ReportAnalysis | None]]:
    """One bar for all runs, then one for their analysis."""
    if not sys.stderr.isatty():
        yield None, None
        return
    with Progress(
        BarColumn(),
        TextColumn("{task.percentage:.1f} %  {task.description}"),
        TimeRemainingColumn(),
        console=Console(stderr=True),
        speed_estimate_period=PACE_SECONDS,
    ) as progress:
        tasks: dict[str, TaskID] = {}

        def show(name: str, completed: int, total: int, text: str) -> None:
            if name not in tasks:  # what was done before does not count as speed
                tasks[name] = progress.add_task(text, total=total, completed=completed)
            progress.update(tasks[name], completed=completed, description=text)

        def report_runs(now: Advance) -> None:
            failed = f", {now.failed} failed" if now.failed else ""
            text = f"{now.finished} of {now.runs} runs finished, {now.running} running{failed}"
            show("runs", round(now.work * BAR), BAR, text)

        def report_analysis(done: int, total: int) -> None:
            show("analysis", done, total, f"{done} of {total} runs analysed")

        yield report_runs, report_analysis

"""Progress bars on a terminal; elsewhere a line now and then of many runs, none of a single one."""

import sys
import time as clock
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeRemainingColumn

from srd_driver import Simulation
from srd_driver.parallel import agree, communicator
from srd_driver.progress_bar import LINE_SECONDS
from srd_driver.sweep import Advance

PACE_SECONDS = 300.0  # the time remaining is told from the pace of the last five minutes
BAR = 100_000  # steps of the bar

ReportRuns = Callable[[Advance], None]
ReportAnalysis = Callable[[int, int], None]


def finish_with_progress(simulation: Simulation) -> None:
    """Run to the end, on a terminal with a bar."""
    simulation.finish(progress=agree(communicator(), sys.stderr.isatty))


class Lines:
    """Progress for a pipe or the log of a queue: a line every half a minute.

    Args:
        say: prints a line.
        now: seconds of a clock.
    """

    def __init__(
        self,
        say: Callable[[str], None] = lambda line: print(line, file=sys.stderr, flush=True),
        now: Callable[[], float] = clock.monotonic,
    ) -> None:
        self._say = say
        self._now = now
        self._began = self._said = now()
        self._work: float | None = None  # done before

    def report_runs(self, now: Advance) -> None:
        """What `run_all` calls."""
        if self._work is None:
            self._work = now.work
        if not self._is_time():
            return
        done = now.work - self._work
        left = ""
        if done > 0:
            minutes = (self._now() - self._began) * (1 - now.work) / done / 60
            left = f", about {minutes:.0f} min left" if minutes >= 1 else ", less than 1 min left"
        self._say(f"{100 * now.work:.1f} %: {_counts(now)}{left}")

    def report_analysis(self, done: int, total: int) -> None:
        """What `tabulate` calls."""
        if self._is_time():
            self._say(f"{done} of {total} runs analysed")

    def _is_time(self) -> bool:
        if self._now() - self._said < LINE_SECONDS:
            return False
        self._said = self._now()
        return True


def _counts(now: Advance) -> str:
    failed = f", {now.failed} failed" if now.failed else ""
    return f"{now.finished} of {now.runs} runs finished, {now.running} running{failed}"


@contextmanager
def progress_of_runs() -> Iterator[tuple[ReportRuns, ReportAnalysis]]:
    """One bar for all runs, then one for their analysis; without a terminal, lines on stderr."""
    if not sys.stderr.isatty():
        lines = Lines()
        yield lines.report_runs, lines.report_analysis
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
            show("runs", round(now.work * BAR), BAR, _counts(now))

        def report_analysis(done: int, total: int) -> None:
            show("analysis", done, total, f"{done} of {total} runs analysed")

        yield report_runs, report_analysis


@contextmanager
def progress_of_pictures() -> Iterator[ReportAnalysis | None]:
    """A bar on a terminal, for pictures drawn one after the other."""
    if not sys.stderr.isatty():
        yield None
        return
    with Progress(
        BarColumn(),
        TextColumn("{task.completed} of {task.total} pictures"),
        TimeRemainingColumn(),
        console=Console(stderr=True),
    ) as progress:
        task = progress.add_task("", total=None)
        yield lambda done, total: progress.update(task, completed=done, total=total)

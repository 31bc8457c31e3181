"""`narrows sweep` and `narrows status`: many runs of a scene, and how far runs are."""

import shlex
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import Annotated, Any

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeRemainingColumn

from lammps_inputs import SceneError, parse_assignment
from lammps_inputs.deck import DEFAULT_ENGINE, Engine
from lammps_inputs.limits import warnings
from narrows.messages import say, user_errors, warn
from narrows.run_cli import SceneFile, SceneName, Settings, scene_fields
from srd_driver import RunError, sweep_definition
from srd_driver.parallel import communicator
from srd_driver.status import Status, status_of, stored_run
from srd_driver.sweep import Advance, available_cores, command, is_finished, run_all
from srd_driver.sweep_definition import Sweep

PACE_SECONDS = 300.0  # the time remaining is told from the pace of the last five minutes
ReportRuns = Callable[[Advance], None]
ReportAnalysis = Callable[[int, int], None]
BAR = 100_000  # steps of the bar
WAYS_OUT = (signal.SIGTERM, signal.SIGHUP)


def sweep(
    scene: SceneName,
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="new, or of this sweep")],
    over: Annotated[
        list[str] | None,
        typer.Option("--over", metavar="FIELD=V1,V2,...", help="a field and its values"),
    ] = None,
    settings: Settings = None,
    file: SceneFile = None,
    engine: Annotated[Engine, typer.Option(help="of all runs")] = DEFAULT_ENGINE,
    repeats: Annotated[
        int, typer.Option(metavar="R", min=1, help="runs of each point: seed, seed + 1, ...")
    ] = 1,
    jobs: Annotated[
        int | None, typer.Option(metavar="N", min=1, help="runs at a time; default: the cores")
    ] = None,
    commands: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE", help="run nothing; write a command for each run (- for stdout)"
        ),
    ] = None,
) -> None:
    """Run a scene at all combinations of field values; again, to go on or to extend it."""
    with user_errors():
        if communicator().size > 1:
            raise RunError("a sweep starts a process for each run itself: give it without mpirun")
        asked = sweep_definition.plan(
            out, scene, _fixed(scene, file, settings, over), _lists(over), repeats, engine
        )
        told = (warning for run in asked.runs for warning in warnings(run.scene, run.engine))
        warn(dict.fromkeys(told))
        sweep_definition.store(asked)
        if commands:
            _write_commands(asked, commands)
        else:
            _execute(asked, jobs or available_cores())


def status(
    directory: Annotated[Path, typer.Argument(metavar="DIR", help="of a sweep or a run")],
) -> None:
    """Whether each run is finished, running, failed, stopped or waiting; how far, and how fast."""
    with user_errors():
        if sweep_definition.is_sweep(directory):
            runs = sweep_definition.read(directory).runs
        else:
            runs = (stored_run(directory),)
        found = {run.folder.name: status_of(run) for run in runs}
        width = max(map(len, found), default=0)
        for name, entry in found.items():
            say(f"{name:<{width}}  {_line(entry)}")
        if len(runs) > 1:
            states = [entry.state for entry in found.values()]
            counts = {state: states.count(state) for state in dict.fromkeys(states)}
            say(f"{len(runs)} runs: " + ", ".join(f"{n} {state}" for state, n in counts.items()))


def _line(entry: Status) -> str:
    speed = "" if entry.speed is None else f"  {entry.speed:.3g} t0/s"
    failure = "" if entry.failure is None else f"  {entry.failure}"
    return f"{entry.state:<8}  {entry.time:8g} of {entry.end:g} t0{speed}{failure}"


def _lists(over: list[str] | None) -> dict[str, list[Any]]:
    """The values of each swept field."""
    lists: dict[str, list[Any]] = {}
    for text in over or []:
        field, separator, values = text.partition("=")
        field = field.strip()
        if not separator or not field:
            raise SceneError([f"--over {text!r}: must have the form field=value,value,..."])
        if field in lists:
            raise SceneError([f"--over {text!r}: {field} is swept already"])
        lists[field] = [parse_assignment(f"{field}={value}")[1] for value in values.split(",")]
    return lists


def _fixed(
    scene: str, file: Path | None, settings: list[str] | None, over: list[str] | None
) -> dict[str, Any]:
    """The fields that are the same at all points."""
    swept = _lists(over)
    for text in settings or []:
        field, value = parse_assignment(text)
        if field in swept:
            raise SceneError.of_field(field, value, "is swept by --over; give it once")
    return scene_fields(scene, {}, file, settings)


def _write_commands(asked: Sweep, file: Path) -> None:
    lines = [shlex.join(command(run)) + "\n" for run in asked.runs if not is_finished(run)]
    if str(file) == "-":
        sys.stdout.writelines(lines)
        return
    file.write_text("".join(lines), encoding="utf-8")
    say(
        f"{file}: {len(lines)} of {len(asked.runs)} runs are to be done; "
        f"then: narrows analyze {asked.directory}"
    )


def _execute(asked: Sweep, jobs: int) -> None:
    try:
        from analysis import tabulate  # here, so that `narrows --help` stays fast

        with interrupted_by_signals(), progress_bar() as (report_runs, report_analysis):
            failures = run_all(asked.runs, jobs, report_runs)
            table = tabulate(asked.directory, jobs, renew=False, report=report_analysis)
    except KeyboardInterrupt:
        done = sum(is_finished(run) for run in asked.runs)
        raise KeyboardInterrupt(
            f"{done} of {len(asked.runs)} runs are finished; give the same command again to go on"
        ) from None
    say(
        f"{asked.directory}: {len(asked.runs) - len(failures)} of {len(asked.runs)} runs finished; "
        f"{len(table.rows)} points in {asked.directory / 'table.csv'}"
    )
    problems = [f"{failure.run.folder.name}: {failure.message}" for failure in failures]
    if problems or table.problems:
        raise RunError("\n".join(problems + table.problems))


@contextmanager
def interrupted_by_signals() -> Iterator[None]:
    """A queueing system's SIGTERM, or a closed terminal, is a Ctrl-C."""

    def interrupt(_: int, __: FrameType | None) -> None:
        raise KeyboardInterrupt

    before = {number: signal.signal(number, interrupt) for number in WAYS_OUT}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


@contextmanager
def progress_bar() -> Iterator[tuple[ReportRuns | None, ReportAnalysis | None]]:
    """On a terminal: one bar for all runs, then one for their analysis."""
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

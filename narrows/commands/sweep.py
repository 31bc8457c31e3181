"""`narrows sweep`: many runs of a scene."""

import shlex
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from lammps_inputs import SceneError, parse_assignment
from lammps_inputs.deck import warnings
from narrows.messages import say, user_errors, warn
from narrows.progress import progress_of_runs
from narrows.scene_options import (
    ENGINES,
    Longest,
    SceneFile,
    SceneName,
    Settings,
    Until,
    scene_fields,
)
from run_files import RunDirectoryError
from run_files.manifest import CHANGEABLE
from srd_driver import RunError, sweep_definition
from srd_driver.parallel import communicator
from srd_driver.signals import interrupted_by_signals
from srd_driver.sweep import Failure, Run, available_cores, is_finished, run_all
from srd_driver.sweep_definition import Sweep

if TYPE_CHECKING:
    from analysis import SweepTable


def sweep(
    scene: SceneName,
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="new, or of this sweep")],
    over: Annotated[
        list[str] | None,
        typer.Option("--over", metavar="FIELD=V1,V2,...", help="a field and its values"),
    ] = None,
    settings: Settings = None,
    file: SceneFile = None,
    engine: Annotated[str | None, typer.Option(metavar=ENGINES, help="of all runs")] = None,
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
    until: Until = None,
    longest: Longest = None,
) -> None:
    """Run a scene at all combinations of field values; again, to go on or to extend it."""
    with user_errors():
        if commands and until:
            raise SceneError(["--commands: not with --until, which decides while runs go on"])
        if longest is not None and not until:
            raise SceneError.of_field("longest", longest, "only with --until")
        if communicator().size > 1:
            raise RunError("a sweep starts a process for each run itself: give it without mpirun")
        asked = sweep_definition.plan(
            out, scene, _fixed(scene, file, settings, over), _lists(over), repeats, engine
        )
        told = (warning for run in asked.runs for warning in warnings(run.scene, run.engine))
        warn(dict.fromkeys(told))
        if until:
            _execute_until(asked, jobs or available_cores(), until, longest)
            return
        sweep_definition.store(asked)
        if commands:
            _write_commands(asked, commands)
        else:
            _execute(asked, jobs or available_cores())


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
    return scene_fields(scene, file, settings)


def _is_done(run: Run) -> bool:
    try:
        return is_finished(run)
    except RunDirectoryError:  # its command, or the table, will tell
        return False


def _write_commands(asked: Sweep, file: Path) -> None:
    lines = [shlex.join(_command(run)) + "\n" for run in asked.runs if not _is_done(run)]
    if str(file) == "-":
        sys.stdout.writelines(lines)
        return
    file.write_text("".join(lines), encoding="utf-8")
    say(
        f"{file}: {len(lines)} of {len(asked.runs)} runs are to be done; "
        f"then: narrows analyze {asked.directory}"
    )


def _command(run: Run) -> list[str]:
    """The command line of a run, to be given again and again until it is finished."""
    default = {name: field.default for name, field in type(run.scene).model_fields.items()}
    settings = [
        f"{name}={list(value) if isinstance(value, tuple) else value}"
        for name, value in run.scene.model_dump().items()
        if value != default[name] or name in CHANGEABLE
    ]
    return [
        *(sys.executable, "-m", "narrows", "run", run.scene.name, "--engine", run.engine),
        *(word for setting in settings for word in ("--set", setting)),
        *("--out", str(run.folder), "--resume"),
    ]


def _execute(asked: Sweep, jobs: int) -> None:
    try:
        from analysis import tabulate  # here, so that `narrows --help` stays fast

        with interrupted_by_signals(), progress_of_runs() as (report_runs, report_analysis):
            failures = run_all(asked.runs, jobs, report_runs)
            table = tabulate(asked.directory, jobs, renew=False, report=report_analysis)
    except KeyboardInterrupt:
        raise _interrupted(asked) from None
    _tell(asked, failures, table)


def _execute_until(asked: Sweep, jobs: int, until: list[str], longest: float | None) -> None:
    from narrows.until import sweep_until

    try:
        with interrupted_by_signals(), progress_of_runs() as (report_runs, report_analysis):
            done = sweep_until(asked, until, jobs, longest, report_runs, report_analysis)
    except KeyboardInterrupt:
        raise _interrupted(asked) from None
    _tell(asked, done.failures, done.table, done.missed)


def _interrupted(asked: Sweep) -> KeyboardInterrupt:
    done = sum(_is_done(run) for run in asked.runs)
    return KeyboardInterrupt(
        f"{done} of {len(asked.runs)} runs are finished; give the same command again to go on"
    )


def _tell(
    asked: Sweep, failures: list[Failure], table: "SweepTable", missed: Sequence[str] = ()
) -> None:
    say(
        f"{asked.directory}: {len(asked.runs) - len(failures)} of {len(asked.runs)} runs finished; "
        f"{len(table.rows)} points in {asked.directory / 'table.csv'}"
    )
    problems = [f"{failure.run.folder.name}: {failure.message}" for failure in failures]
    problems += [f"not precise at the longest time: {point}" for point in missed]
    if problems or table.problems:
        raise RunError("\n".join(problems + table.problems))

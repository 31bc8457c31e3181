"""`narrows status`: how far runs are."""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from narrows.messages import say, user_errors
from narrows.papers import is_reproduction
from run_files import RunDirectoryError
from run_files.sweep_file import is_sweep
from srd_driver import RunError, sweep_definition
from srd_driver.status import Status, status_of, stored_run
from srd_driver.sweep import Run

if TYPE_CHECKING:
    from narrows.papers.session import Plan

BY_URGENCY = ("failed", "running", "by hand", "stopped", "waiting", "finished")  # states


def status(
    directory: Annotated[
        Path, typer.Argument(metavar="DIR", help="of a run, a sweep or a reproduced paper")
    ],
) -> None:
    """Whether each run is finished, running, failed, stopped or waiting; how far, and how fast."""
    with user_errors():
        if is_reproduction(directory):
            from narrows.papers.reproduction_file import read_plans  # loads what makes figures

            for plan in read_plans(directory):
                _tell_reproduction(plan)
            return
        if is_sweep(directory):
            runs = sweep_definition.read(directory).runs
        else:
            runs = (stored_run(directory),)
        found = {run.folder.name: _status_or_damage(run) for run in runs}
        width = max(map(len, found), default=0)
        for name, entry in found.items():
            say(f"{name:<{width}}  {_line(entry)}")
        if len(runs) > 1:
            say(f"{len(runs)} runs: {_counts(found.values())}")


def _tell_reproduction(plan: "Plan") -> None:
    """A line for each figure, one for each run that is under way or in trouble, and a sum."""
    say(f"{plan.paper.name}, {plan.quality} quality")
    found = {scene: _status_or_damage(run) for scene, run in plan.run_by_scene.items()}
    width = max(len(figure.number) for figure in plan.figures)
    for figure in plan.figures:
        entries = [found[scene] for scene in dict.fromkeys(figure.scenes(plan.quality))]
        say(f"  {figure.number:<{width}}  {_counts(entries) or 'needs no runs'}")
    for scene, run in plan.run_by_scene.items():
        entry = found[scene]
        if entry.state in ("failed", "running", "stopped"):
            say(f"  {run.folder.name}  {_line(entry)}")
    say(f"  {len(plan.runs)} runs: {_counts(found.values()) or 'none needed'}")


def _counts(entries: Iterable[Status]) -> str:
    """`2 running, 3 waiting`."""
    states: Sequence[str] = [entry.state for entry in entries]
    return ", ".join(f"{states.count(each)} {each}" for each in BY_URGENCY if each in states)


def _status_or_damage(run: Run) -> Status:
    """A run that is damaged does not hide the others."""
    try:
        return status_of(run)
    except (RunDirectoryError, RunError) as error:
        return Status("failed", 0.0, run.scene.system.clock.end, None, str(error))


def _line(entry: Status) -> str:
    speed = "" if entry.speed is None else f"  {entry.speed:.3g} t0/s"
    failure = "" if entry.failure is None else f"  {entry.failure}"
    return f"{entry.state:<8}  {entry.time:8g} of {entry.end:g} t0{speed}{failure}"

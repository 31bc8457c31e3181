"""`narrows status`: how far runs are."""

from pathlib import Path
from typing import Annotated

import typer

from narrows.messages import say, user_errors
from run_files import RunDirectoryError
from run_files.sweep_file import is_sweep
from srd_driver import RunError, sweep_definition
from srd_driver.status import Status, status_of, stored_run
from srd_driver.sweep import Run


def status(
    directory: Annotated[Path, typer.Argument(metavar="DIR", help="of a sweep or a run")],
) -> None:
    """Whether each run is finished, running, failed, stopped or waiting; how far, and how fast."""
    with user_errors():
        if is_sweep(directory):
            runs = sweep_definition.read(directory).runs
        else:
            runs = (stored_run(directory),)
        found = {run.folder.name: _status_or_damage(run) for run in runs}
        width = max(map(len, found), default=0)
        for name, entry in found.items():
            say(f"{name:<{width}}  {_line(entry)}")
        if len(runs) > 1:
            states = [entry.state for entry in found.values()]
            counts = {state: states.count(state) for state in dict.fromkeys(states)}
            say(f"{len(runs)} runs: " + ", ".join(f"{n} {state}" for state, n in counts.items()))


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

"""How far runs are, told from their run directories alone, while they run or not."""

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from lammps_inputs import make_scene
from run_files.manifest import read_manifest
from run_files.progress import is_begun, read_failure, read_progress
from srd_driver.resume import (
    is_half_made,
    newest_step,
    stored_fields,
    tells_scene,
    written_step,
)
from srd_driver.run_lock import is_locked
from srd_driver.sweep import Run, is_finished

State = Literal["finished", "running", "failed", "stopped", "waiting", "by hand"]


@dataclass(frozen=True)
class Status:
    """How far a run is.

    Attributes:
        state: stopped: half way, without an error (killed, or interrupted); waiting: not begun;
            by hand: a deck that `lmp` runs, or ran, half way.
        time: simulated so far, equilibration included [t0]; of a run that does not run now, up to
            its newest checkpoint.
        end: at which the run is finished [t0].
        speed: simulated time per wall time up to the newest checkpoint, None before the first
            [t0/s].
        failure: the error that stopped a failed run.
    """

    state: State
    time: float
    end: float
    speed: float | None
    failure: str | None


def status_of(run: Run) -> Status:
    """How far the run is.

    Raises:
        RunError: when its directory holds another run.
    """
    clock = run.scene.system.clock
    step, end = clock.time_step, clock.end
    locked = is_locked(run.folder)
    if not is_begun(run.folder):
        if locked or is_half_made(run.folder) or not tells_scene(run.folder):
            return Status("running" if locked else "waiting", 0.0, end, None, None)
        return _status_of_deck(run.folder)
    finished = is_finished(run)
    progress = read_progress(run.folder)
    speed = progress.step * step / progress.wall_seconds if progress.wall_seconds else None
    failure = read_failure(run.folder)
    if finished:
        return Status("finished", progress.step * step, end, speed, None)
    if locked:
        return Status("running", newest_step(run.folder) * step, end, speed, None)
    state: State = "stopped" if failure is None else "failed"
    return Status(state, progress.step * step, end, speed, failure)


def _status_of_deck(directory: Path) -> Status:
    """How far a deck is that is run by hand, by its outputs; whether lmp still runs, none tells."""
    clock = read_manifest(directory).system.clock  # as -var made it
    done, end = written_step(directory), clock.total_steps
    state: State = "finished" if done >= end else "by hand" if done else "waiting"
    return Status(state, done * clock.time_step, end * clock.time_step, None, None)


def stored_run(directory: Path) -> Run:
    """The run of a run directory.

    Raises:
        RunError: when it holds none.
        SceneError: when its scene is not one of this version.
    """
    fields = stored_fields(directory)
    scene = make_scene(str(fields.pop("scene", None)), **fields)
    return Run(directory, scene, read_manifest(directory).engine)

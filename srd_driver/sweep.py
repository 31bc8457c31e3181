"""Many independent runs: each its own run directory and its own process on one core.

What is finished is told by the run directories alone, so the same runs may be started again after
a kill, by another command or by a queueing system: finished ones are skipped, half ones go on.
"""

import contextlib
import os
import signal
import subprocess
import time as clock
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from pathlib import Path

from lammps_inputs import Scene
from run_files import RunDirectoryError
from run_files.progress import is_begun, read_progress, write_failure
from srd_driver import worker
from srd_driver.resume import newest_step, refuse_another_scene, tells_scene
from srd_driver.run_lock import is_locked

POLL_SECONDS = 0.2
ORPHANED = "the run that it begins from has failed"
LAUNCHER = ("PMI_", "PMIX_")  # by which mpirun or srun would claim our processes for its job


@dataclass(frozen=True)
class Run:
    """A scene in an engine, and the run directory it belongs to.

    Attributes:
        after: a run that must have finished before, if any: its last state is the start.
    """

    folder: Path
    scene: Scene
    engine: str
    after: "Run | None" = None


@dataclass(frozen=True)
class Failure:
    """A run that stopped, and why; `message` names the file of its output."""

    run: Run
    message: str


@dataclass(frozen=True)
class Advance:
    """How far the runs are together.

    `work` is the fraction of all particle updates done, which run time is proportional to.
    """

    work: float
    finished: int
    failed: int
    running: int
    runs: int


def is_finished(run: Run) -> bool:
    """Whether the run directory has all of the run.

    Raises:
        RunError: when the directory holds another scene or engine.
    """
    if tells_scene(run.folder):
        refuse_another_scene(run.scene, run.engine, run.folder)
    if not is_begun(run.folder):
        return False
    return read_progress(run.folder).step >= run.scene.system.clock.total_steps


def available_cores() -> int:
    """Cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def run_all(
    runs: Sequence[Run], jobs: int, report: Callable[[Advance], None] | None = None
) -> list[Failure]:
    """Execute what is not finished, at most `jobs` runs at a time.

    A run that stops with an error does not stop the others. A run that another process has taken
    up is waited for. An interrupt (KeyboardInterrupt) lets the running ones write a checkpoint
    first; a second one kills them. `report` is called several times a second.

    Raises:
        RunError: before anything runs, when a run directory holds another scene or engine.
    """
    runs = list(dict.fromkeys(runs))
    waiting: list[Run] = []
    failures: list[Failure] = []
    for each in runs:
        try:
            if not is_finished(each):
                waiting.append(each)
        except RunDirectoryError as error:  # one damaged run does not stop the others
            failures.append(Failure(each, str(error)))
    running: dict[Run, subprocess.Popen[bytes]] = {}
    try:
        while waiting or running:
            while orphans := _orphans(waiting, failures):  # and those that begin from them
                waiting = [run for run in waiting if run not in orphans]
                failures += [Failure(run, ORPHANED) for run in orphans]
            while len(running) < jobs and (run := _next(waiting, running)):
                waiting.remove(run)
                if not is_finished(run):  # another process may have done it
                    running[run] = _start(run)
            for run in [run for run in running if running[run].poll() is not None]:
                code = running.pop(run).returncode
                if code == 0:
                    _log(run).unlink(missing_ok=True)
                elif is_locked(run.folder) or is_finished(run):  # another process was quicker
                    waiting.append(run)
                else:
                    failures.append(_failure(run, code))
            if report:
                report(_advance(runs, [*waiting, *running], failures, len(running)))
            clock.sleep(POLL_SECONDS)
    finally:
        _stop(running)
    return failures


def _next(waiting: Sequence[Run], running: Collection[Run]) -> Run | None:
    unfinished = {*waiting, *running}
    ready = (run for run in waiting if run.after not in unfinished)
    return next((run for run in ready if not is_locked(run.folder)), None)


def _orphans(waiting: Sequence[Run], failures: Sequence[Failure]) -> list[Run]:
    failed = {failure.run for failure in failures}
    return [run for run in waiting if run.after in failed]


def _start(run: Run) -> subprocess.Popen[bytes]:
    run.folder.parent.mkdir(parents=True, exist_ok=True)
    alone = {name: value for name, value in os.environ.items() if not name.startswith(LAUNCHER)}
    one_core = {"OMP_NUM_THREADS": "1", "NUMBA_NUM_THREADS": "1"}
    with _log(run).open("wb") as log:
        return subprocess.Popen(
            worker.command(run.folder, run.scene, run.engine),
            stdin=subprocess.DEVNULL,
            stdout=log,
            stderr=subprocess.STDOUT,
            env=alone | one_core,
            start_new_session=True,  # Ctrl-C reaches it through us only
        )


def _log(run: Run) -> Path:
    """What the process of the run says; beside the run directory, kept when it fails."""
    return run.folder.with_name(run.folder.name + ".log")


def _stop(running: dict[Run, subprocess.Popen[bytes]]) -> None:
    """Let the processes write a checkpoint and end; a second interrupt kills them."""
    for process in running.values():
        process.terminate()
    try:
        for process in running.values():
            process.wait()
    except KeyboardInterrupt:
        for process in running.values():
            process.kill()
            process.wait()
        raise
    finally:
        for run in running:
            _log(run).unlink(missing_ok=True)


def _failure(run: Run, code: int) -> Failure:
    """Why the process of the run ended; kept in the run directory too, if that was made."""
    log = _log(run)
    said = log.read_text(encoding="utf-8", errors="replace").strip() if log.exists() else ""
    if code < 0:
        reason = f"killed by {signal.Signals(-code).name}"
    else:
        reason = said.splitlines()[-1] if said else f"exit code {code}"
    if is_begun(run.folder):
        write_failure(run.folder, reason)
    return Failure(run, f"{reason} (its output: {log})")


def _advance(
    runs: Sequence[Run], unfinished: Sequence[Run], failures: Sequence[Failure], running: int
) -> Advance:
    work = {run: run.scene.system.work for run in runs}
    open_runs = [*unfinished, *(failure.run for failure in failures)]
    left = sum(work[run] * (1 - _fraction(run)) for run in open_runs)
    finished = len(runs) - len(open_runs)
    return Advance(1 - left / sum(work.values()), finished, len(failures), running, len(runs))


def _fraction(run: Run) -> float:
    if not is_begun(run.folder):
        return 0.0
    with contextlib.suppress(RunDirectoryError):
        return min(1.0, newest_step(run.folder) / run.scene.system.clock.total_steps)
    return 0.0

"""Many independent runs: each its own run directory and its own process on one core.

What is finished is told by the run directories alone, so the same runs may be started again after
a kill, by another command or by a queueing system: finished ones are skipped, half ones go on.
"""

import os
import subprocess
import sys
import time as clock
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from lammps_inputs import Scene
from lammps_inputs.deck import Engine
from srd_driver import run_directory
from srd_driver.run_directory import CHANGEABLE

POLL_SECONDS = 0.2


@dataclass(frozen=True)
class Run:
    """A scene in an engine, and the run directory it belongs to."""

    folder: Path
    scene: Scene
    engine: Engine


@dataclass(frozen=True)
class Failure:
    """A run that stopped, and why; `message` names its log."""

    run: Run
    message: str


@dataclass(frozen=True)
class Advance:
    """How far the runs are together.

    `work` is the fraction of all fluid-particle updates done, which run time is proportional to.
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
    if not run_directory.is_begun(run.folder):
        return False
    run_directory.refuse_another_scene(run.scene, run.engine, run.folder)
    return run_directory.read_progress(run.folder).step >= run.scene.total_steps


def command(run: Run) -> list[str]:
    """The command that begins the run or goes on with it; it may be given again and again."""
    default = {name: field.default for name, field in type(run.scene).model_fields.items()}
    settings = [
        f"{name}={value}"
        for name, value in run.scene.model_dump().items()
        if value != default[name] or name in CHANGEABLE
    ]
    return [
        *(sys.executable, "-m", "narrows", "run", run.scene.name, "--engine", run.engine),
        *(word for setting in settings for word in ("--set", setting)),
        *("--out", str(run.folder), "--resume"),
    ]


def run_all(
    runs: Sequence[Run], jobs: int, report: Callable[[Advance], None] | None = None
) -> list[Failure]:
    """Execute what is not finished, at most `jobs` runs at a time.

    A run that stops with an error does not stop the others. A run that another process has taken
    up is waited for. An interrupt (KeyboardInterrupt) lets the running ones write a checkpoint
    first. `report` is called several times a second.

    Raises:
        RunError: before anything runs, when a run directory holds another scene or engine.
    """
    waiting = [run for run in runs if not is_finished(run)]
    finished, failures = len(runs) - len(waiting), list[Failure]()
    running: list[tuple[Run, subprocess.Popen[bytes]]] = []
    try:
        while waiting or running:
            while waiting and len(running) < jobs:
                run = waiting.pop(0)
                running.append((run, _start(run)))
            for run, process in list(running):
                if process.poll() is None:
                    continue
                running.remove((run, process))
                if process.returncode == 0:
                    _log(run).unlink(missing_ok=True)
                    finished += 1
                else:
                    failures.append(Failure(run, _message(run, process.returncode)))
            if report:
                work = _work_done(runs)
                report(Advance(work, finished, len(failures), len(running), len(runs)))
            clock.sleep(POLL_SECONDS)
    finally:
        for _, process in running:
            process.terminate()
        for _, process in running:
            process.wait()
    return failures


def _start(run: Run) -> subprocess.Popen[bytes]:
    run.folder.parent.mkdir(parents=True, exist_ok=True)
    one_core = {"OMP_NUM_THREADS": "1", "NUMBA_NUM_THREADS": "1"}
    with _log(run).open("wb") as log:
        return subprocess.Popen(
            command(run),
            stdin=subprocess.DEVNULL,
            stdout=log,
            stderr=subprocess.STDOUT,
            env=os.environ | one_core,
            start_new_session=True,  # Ctrl-C reaches it through us only
        )


def _log(run: Run) -> Path:
    """What the process of the run says; beside the run directory, kept when it fails."""
    return run.folder.with_name(run.folder.name + ".log")


def _message(run: Run, code: int) -> str:
    lines = _log(run).read_text(encoding="utf-8", errors="replace").strip().splitlines()
    reason = lines[-1].removeprefix("narrows: ") if lines else "no message"
    if code < 0:
        reason = f"killed by signal {-code}"
    return f"{reason} (log: {_log(run)})"


def _work_done(runs: Sequence[Run]) -> float:
    total = done = 0.0
    for run in runs:
        work = run.scene.fluid_particles * run.scene.collisions
        total += work
        if run_directory.is_begun(run.folder):
            step = run_directory.newest_step(run.folder)
            done += work * min(1.0, step / run.scene.total_steps)
    return done / total

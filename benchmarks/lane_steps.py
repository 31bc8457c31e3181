"""Error of driven mixtures against the time step: of a trajectory, and of averages.

    python benchmarks/lane_steps.py --out runs/lane-steps [--scale 1] [--page docs/lanes.md]

Trajectory: 120 disks in the numpy reference, the splitting of the compiled styles and the fourth-
order predictor-corrector by which the paper integrates, against the latter at an eighth of the
shortest step. Averages: runs of the same length from the same states, by the compiled styles; one
run a step, so that their differences are to be judged by the errors. Seconds are of the processor,
for a unit of time. Prints the tables, and renews them in a page; finished runs are kept. `--scale`
makes all runs longer or shorter.
"""

import argparse
import json
import resource
import sys
from pathlib import Path
from typing import Any, Literal

import numpy as np

from analysis import analyze
from analysis.estimate import Estimate
from lammps_inputs import make_scene
from lammps_inputs.placement import Hexagonal
from lammps_inputs.potentials.soft_disk import SoftDisk
from lammps_inputs.system import Box, Species
from narrows.markdown import number, replace_block, table
from srd_driver.reference.isothermal import Isothermal
from srd_driver.reference.soft_pairs import SoftPairs
from srd_driver.sweep import Run, run_all

STEPS = (0.004, 0.002, 0.001, 0.0005)
SAFE = {10.0: 0.0001}  # step of the run to begin from, by field; else 0.001
STOPPED = "stopped by name"
TIME = 0.064  # of the trajectories: later, rounding has grown
KEYS = ("lane_order", "current", "configurational_temperature", "potential_energy")
KINDS: tuple[Literal["kinetic", "configurational"], ...] = ("kinetic", "configurational")


def trajectories() -> str:
    """Table: largest error of positions and velocities, by method and step."""
    columns, rows, spacing = 10, 6, np.sqrt(2 / (np.sqrt(3) * 0.92))
    lengths = np.array([columns * spacing, rows * np.sqrt(3) * spacing])
    box = Box((float(lengths[0]), float(lengths[1])), (True, True))
    random = np.random.default_rng(5)
    lattice = Hexagonal(columns, rows).positions(box, (Species("disks", 120, 1.0),), 1)
    positions = lattice + random.normal(0, 0.07, lattice.shape)
    velocities = random.normal(size=lattice.shape)
    velocities -= velocities.mean(axis=0)
    field = np.zeros_like(lattice)
    field[:, 0] = np.where(np.arange(120) % 2, 4.0, -4.0)
    lines = []
    for kind in KINDS:
        pairs = SoftPairs(SoftDisk(), lengths)
        equations = Isothermal(kind, pairs, positions, velocities, np.ones(120), field, 1.0)
        exact = equations.gear(STEPS[-1] / 8, TIME)
        for step in STEPS:
            errors = [
                float(np.abs(method(step, TIME) - exact).max())
                for method in (equations.split, equations.gear)
            ]
            lines.append((kind, f"{step:g}", *(f"{error:.1e}" for error in errors)))
    return table(("thermostat", "step", "splitting", "Gear, fourth order"), lines)


def averages(
    out: Path, title: str, fields: dict[str, Any], times: dict[str, float]
) -> list[tuple[str, ...]]:
    """A row for each step, all from the state that the first run leaves."""
    name = title.replace(", ", "-").replace(" ", "")
    safe = SAFE.get(fields["field"], 0.001)
    first = make_scene("lanes", **fields, time_step=safe, **times)
    start = out / f"{name}-start"
    if failures := run_all([Run(start, first, "md")], jobs=1):
        print(failures[0].message, file=sys.stderr)
        return [(title, f"{safe:g}, to begin", STOPPED, *[""] * len(KEYS))]
    lines = []
    for step in STEPS:
        scene = make_scene(
            "lanes",
            **fields,
            time_step=step,
            start=str(start),
            sampling_interval=times["sampling_interval"],
            equilibration=times["duration"] / 10,
            duration=times["duration"],
        )
        folder, before = out / f"{name}-{step:g}", seconds()
        failures = run_all([Run(folder, scene, "md")], jobs=1)
        spent = out / f"{name}-{step:g}.seconds"
        if failures:
            print(failures[0].message, file=sys.stderr)
            lines.append((title, f"{step:g}", STOPPED, *[""] * len(KEYS)))
            continue
        if not spent.exists():
            spent.write_text(json.dumps(seconds() - before))
        summary = analyze(folder)
        found = (Estimate.of_json(summary[key]) for key in KEYS)
        values = (number(of.value, of.error) for of in found)
        price = json.loads(spent.read_text()) / scene.system.clock.end
        lines.append((title, f"{step:g}", *values, f"{price:.3f}"))
    return lines


def seconds() -> float:
    """Processor time of the finished runs."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--scale", type=float, default=1.0)
    parser.add_argument("--page", type=Path, help="whose tables to renew")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    scale = options.scale
    lanes = {"equilibration": 500 * scale, "duration": 300 * scale, "sampling_interval": 2.0}
    fluid = {"equilibration": 20 * scale, "duration": 40 * scale, "sampling_interval": 0.5}
    cases: dict[str, tuple[dict[str, Any], dict[str, float]]] = {
        "kinetic, n 0.75, F 1.75": ({"density": 0.75, "field": 1.75}, lanes),
        "configurational, n 1.03, F 4": ({"field": 4.0, "thermostat": "configurational"}, fluid),
        "configurational, n 1.03, F 10": ({"field": 10.0, "thermostat": "configurational"}, fluid),
    }
    rows = [
        row
        for name, (fields, times) in cases.items()
        for row in averages(options.out, name, fields, times)
    ]
    columns = ("run", "step", "phi", "current", "T_conf", "energy", "s a unit of time")
    text = f"{trajectories()}\n\n{table(columns, rows)}"
    print(text)
    if options.page:
        replace_block(options.page, "lane-steps", text)


if __name__ == "__main__":
    main()

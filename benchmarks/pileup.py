"""Density of the fluid along the channel while a chain falls through it, measured and predicted.

    narrows reproduce tabatabaei-2009 beyond-flux --out runs/thesis
    python benchmarks/pileup.py --law runs/thesis/results.json --out runs/pileup \
        [--page docs/beyond.md]

The thesis' chain of Fig. 4.12, 31 colloids in 300 x 10, run by plain `lmp` with the deck that
`narrows deck` writes and a `fix_modify save` of the whole fluid now and then. The prediction is
that of `analysis.two_fluid` with the constants that the figure beyond-flux measured.
"""

import argparse
import json
import math
import subprocess
import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from analysis import Estimate
from analysis.estimate import mean_of_independent
from analysis.two_fluid import TwoFluid
from lammps_inputs.scenes.channel import Channel
from narrows.markdown import number, replace_block, table
from run_files.fluid_file import read_fluid

Array = NDArray[np.float64]

SEEDS, TIMES, BIN, CELL = (1, 2, 3, 4), (60, 300, 600), 15.0, 1.0
SCENE = Channel.make(
    length=300, colloids=31, spacing=5, equilibration=0, duration=600, sampling_interval=3.0
)


def run(folder: Path, seed: int) -> None:
    """One run with the fluid saved at `TIMES`."""
    fields = SCENE.model_dump() | {"seed": seed}
    names = ("length", "colloids", "spacing", "equilibration", "duration", "sampling_interval")
    settings = [f"--set={name}={fields[name]}" for name in (*names, "seed")]
    command = ["deck", "channel", "--engine", "mpc", "--out", str(folder), *settings]
    subprocess.run([sys.executable, "-m", "narrows", *command], check=True, stdout=sys.stderr)
    script = folder / "in.lammps"
    *setup, last = script.read_text(encoding="utf-8").splitlines()
    assert last.startswith("run ")
    for time in TIMES:
        setup += [
            f"run {round(time / SCENE.system.clock.time_step)} upto",
            f"fix_modify solvent save fluid.{time}",
        ]
    script.write_text("\n".join(setup) + "\n", encoding="utf-8")
    lmp = Path(sys.executable).with_name("lmp")
    subprocess.run([lmp, "-in", script.name, "-screen", "none"], cwd=folder, check=True)


def fluid_density(file: Path) -> Array:
    """Number density in bins along x over n_f, from a saved fluid."""
    x = read_fluid(file).positions[:, 0] % SCENE.length
    counts, _ = np.histogram(x, round(SCENE.length / BIN), (0, SCENE.length))
    return np.asarray(counts / (BIN * SCENE.width * SCENE.density))


def predicted(results: Path) -> Array:
    """The same from the two conservation laws, (T, bins)."""
    entries = json.loads(results.read_text(encoding="utf-8"))
    found = {entry["quantity"]: entry["value"] for entry in entries}
    slope = found["c of v = c rho + c' at rest [a0^3/t0]"]
    intercept = found["c' of v = c rho + c' at rest [a0/t0]"]
    coupling = found["flux of the fluid per force, X [a0^3/t0]"]
    area = math.pi * SCENE.colloid_radius**2
    suspension = TwoFluid(
        lambda rho: intercept + slope * rho,
        lambda rho: np.full_like(rho, coupling),
        found["permeability of the pure fluid, K [a0^3/t0]"],
        SCENE.colloid_mass * SCENE.gravity,
        area,
        SCENE.density,
    )
    rho = np.zeros(round(SCENE.length / CELL))
    rho[: round(31 * 5 / CELL)] = 0.02
    colloids, fluid = suspension.solve(rho, CELL, TIMES)
    free = fluid * (1 - area * colloids)
    return np.asarray(free.reshape(len(TIMES), -1, round(BIN / CELL)).mean(axis=2))


COLUMNS = (
    *("t [t0]", "most", "predicted", "least", "predicted"),
    *("r.m.s. difference", "r.m.s. error"),
)


def told(mean: Estimate) -> str:
    """`1.446 +- 0.020`."""
    return number(mean.value, mean.error)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--law", type=Path, required=True, help="results.json with beyond-flux")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--page", type=Path, help="Markdown page whose table is renewed")
    arguments = parser.parse_args()
    law = predicted(arguments.law)
    for seed in SEEDS:
        folder = arguments.out / f"seed-{seed}"
        if not (folder / f"fluid.{TIMES[-1]}").exists():
            run(folder, seed)
    figure = Figure(figsize=(8, 3.8), layout="constrained")
    axes = figure.subplots()
    x = BIN * (np.arange(law.shape[1]) + 0.5)
    rows = []
    for place, time in enumerate(TIMES):
        runs = np.array(
            [fluid_density(arguments.out / f"seed-{seed}" / f"fluid.{time}") for seed in SEEDS]
        )
        means = [mean_of_independent(column) for column in runs.T]
        mean = np.array([each.number for each in means])
        error = np.array([each.standard_error for each in means])
        axes.errorbar(
            x, mean, error, fmt="o", ms=4, capsize=2, color=f"C{place}", label=f"t = {time}"
        )
        axes.plot(x, law[place], color=f"C{place}")
        rows.append(
            (
                f"{time}",
                *(told(means[mean.argmax()]), f"{law[place].max():.3f}"),
                *(told(means[mean.argmin()]), f"{law[place].min():.3f}"),
                *(f"{math.sqrt((a**2).mean()):.3f}" for a in (mean - law[place], error)),
            )
        )
    text = table(COLUMNS, rows)
    print(text)
    if arguments.page:
        replace_block(arguments.page, "pileup", text)
    axes.set(
        xlabel="along the channel x  [a0];  gravity to the right",
        ylabel="fluid particles per a0$^2$ over $n_f$",
        xlim=(0, SCENE.length),
    )
    axes.legend()
    figure.savefig(arguments.out / "pileup.png", dpi=150)


if __name__ == "__main__":
    main()

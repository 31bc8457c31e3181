"""fix mpc, the numpy reference and fix srd on the same scenes: one table, one figure.

    python benchmarks/crosscheck.py --out runs/crosscheck [--page docs/crosscheck.md]

Runs what is missing in the folder (it can be stopped and started again) on all cores, then analyses
all. Values are means over the seeds; their errors are those of the runs and of the scatter between
them, together. Writes the table and the figure into the folder, and the table into the page.
"""

import argparse
import sys
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from analysis import Estimate, analyze
from analysis.estimate import mean_of_repeats
from analysis.flow import momentum_profile
from analysis.run_directory import RunDirectory
from analysis.shear_wave import wave_amplitude
from lammps_inputs import make_scene
from narrows.markdown import number, replace_block, table
from srd_driver.sweep import Run, available_cores, run_all

ENGINES: tuple[str, ...] = ("mpc", "reference", "srd")
COLORS = ("C2", "C0", "C1")
SEEDS = tuple(range(1, 11))
COLLOIDS = (1, 3, 5)  # in 40 x 10


def few(colloids: int) -> str:
    return f"channel, {colloids} colloid" + ("s" if colloids > 1 else "")


SCENES: dict[str, dict[str, Any]] = {
    "bulk": {
        "length": 320,
        "width": 40,
        "shear_wave": 0.5,
        "duration": 60,
        "sampling_interval": 0.5,
    },
    "poiseuille": {"duration": 2000, "equilibration": 300},
    **{few(n): {"colloids": n, "duration": 300, "equilibration": 50} for n in COLLOIDS},
    "channel, chain": {
        "length": 100,
        "colloids": 20,
        "spacing": 5,
        "duration": 150,
        "equilibration": 50,
    },
}
QUANTITIES: dict[str, list[str]] = {
    "bulk": ["viscosity", "temperature"],
    "poiseuille": ["viscosity", "viscosity_curvature", "wall_slip", "temperature"],
    **{
        few(n): ["settling_speed", "settling_speed_rest", "colloid_temperature", "temperature"]
        for n in COLLOIDS
    },
    "channel, chain": ["settling_speed", "settling_speed_rest", "zigzag.amplitude_rms"],
}


def run_of(folder: Path, name: str, engine: str, seed: int) -> Run:
    scene = make_scene(name.partition(",")[0], **SCENES[name], seed=seed)
    return Run(
        folder / f"{name.replace(', ', '-').replace(' ', '-')}-{engine}-{seed}", scene, engine
    )


def found(summary: dict[str, Any], quantity: str) -> dict[str, Any]:
    """The entry of a summary; `zigzag.amplitude_rms` is within `zigzag`."""
    for key in quantity.split("."):
        summary = summary[key]
    return summary


def over_seeds(summaries: list[dict[str, Any]], quantity: str) -> Estimate:
    """Mean of a quantity over independent runs."""
    return mean_of_repeats([Estimate.of_json(found(summary, quantity)) for summary in summaries])


COLUMNS = (
    "scene",
    "quantity",
    "fix mpc",
    "reference",
    "fix srd",
    "theory",
    "mpc against reference",
)


def as_table(summaries: dict[tuple[str, str], list[dict[str, Any]]]) -> str:
    """The comparison as Markdown; the last column is their distance in normal deviations."""
    rows = []
    for scene, quantities in QUANTITIES.items():
        for quantity in quantities:
            means = {name: over_seeds(summaries[scene, name], quantity) for name in ENGINES}
            theory = found(summaries[scene, ENGINES[0]][0], quantity).get("theory")
            rows.append(
                (
                    scene,
                    quantity,
                    *(number(mean.value, mean.error) for mean in means.values()),
                    f"{theory:.4f}" if theory else "",
                    f"{means['mpc'].deviation(means['reference']):+.1f}",
                )
            )
    return table(COLUMNS, rows)


def figure(folder: Path, file: Path) -> None:
    """Shear-wave decay, Poiseuille profile and settling of the engines."""
    sheet = Figure(figsize=(13, 3.8), layout="constrained")
    decay, profile, settling = sheet.subplots(1, 3)
    for engine, color in zip(ENGINES, COLORS, strict=True):
        style: dict[str, Any] = {"color": color, "label": engine}
        wave: list[NDArray[np.float64]] = []
        velocity: list[NDArray[np.float64]] = []
        moved: list[NDArray[np.float64]] = []
        for seed in SEEDS:
            bulk = RunDirectory(run_of(folder, "bulk", engine, seed).folder)
            fluid = bulk.profile()
            wave.append(wave_amplitude(fluid.y, bulk.width, fluid.counts, fluid.velocity_x))
            times = bulk.times(fluid.steps)
            slit = RunDirectory(run_of(folder, "poiseuille", engine, seed).folder)
            fluid = slit.profile()
            used = fluid.steps > slit.equilibration_steps
            flow = momentum_profile(fluid.counts[used], fluid.velocity_x[used])
            velocity.append(flow.mean(axis=0))
            channel = RunDirectory(run_of(folder, few(1), engine, seed).folder)
            averages = channel.table()
            x = channel.particles().positions[:, 0, 0]
            drift = np.cumsum(averages["mean_velocity_x"]) * channel.interval
            moved.append(x[1:] - x[0] - drift)
            ends = channel.times(averages.steps)
        decay.semilogy(times, np.mean(wave, axis=0), **style)
        profile.plot(fluid.y, np.mean(velocity, axis=0), **style)
        settling.plot(ends, np.mean(moved, axis=0), **style)
    decay.set(xlabel="time $t$ [$t_0$]", ylabel="shear wave $A(t)$ [$a_0/t_0$]")
    profile.set(xlabel="$y$ [$a_0$]", ylabel="$v_x$ [$a_0/t_0$]")
    settling.set(xlabel="time $t$ [$t_0$]", ylabel="settled, co-moving frame [$a_0$]")
    for axes, title in zip(
        (decay, profile, settling), ("bulk", "Poiseuille", "one colloid"), strict=True
    ):
        axes.set_title(title)
        axes.legend()
    sheet.savefig(file, dpi=150)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0] if __doc__ else None)
    parser.add_argument("--out", type=Path, required=True, help="folder of the runs")
    parser.add_argument("--page", type=Path, help="Markdown page whose table is renewed")
    options = parser.parse_args()
    folder: Path = options.out
    runs = {
        (name, engine, seed): run_of(folder, name, engine, seed)
        for name, engine, seed in product(SCENES, ENGINES, SEEDS)
    }
    failures = run_all(list(runs.values()), available_cores())
    if failures:
        sys.exit("\n".join(f"{failure.run.folder}: {failure.message}" for failure in failures))
    summaries: dict[tuple[str, str], list[dict[str, Any]]] = {}
    for (name, engine, _), run in runs.items():
        summaries.setdefault((name, engine), []).append(analyze(run.folder))
    text = as_table(summaries)
    (folder / "crosscheck.md").write_text(text + "\n", encoding="utf-8")
    figure(folder, folder / "crosscheck.png")
    if options.page:
        replace_block(options.page, "table", text)
    print(text)


if __name__ == "__main__":
    main()

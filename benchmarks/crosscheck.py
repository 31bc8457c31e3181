"""fix srd and the numpy reference on the same scenes, side by side: one table, one figure.

    python benchmarks/crosscheck.py --out runs/crosscheck

Runs what is missing in the folder (it can be stopped and started again), two runs at a time, then
analyses all. Values are means over the seeds with the standard error that their scatter gives.
"""

import argparse
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from analysis import analyze
from analysis.flow import momentum_profile
from analysis.run_directory import RunDirectory
from analysis.shear_wave import wave_amplitude

ENGINES = ("srd", "reference")
SEEDS = (1, 2, 3, 4)
SCENES: dict[str, list[str]] = {
    "bulk": ["length=320", "width=40", "shear_wave=0.5", "duration=60", "sampling_interval=0.5"],
    "poiseuille": ["duration=2000", "equilibration=300"],
    "channel": ["colloids=1", "duration=300", "equilibration=50"],
}
QUANTITIES = {
    "bulk": ["viscosity", "temperature"],
    "poiseuille": ["viscosity", "viscosity_curvature", "wall_slip", "temperature"],
    "channel": ["settling_speed", "settling_speed_rest", "colloid_temperature", "temperature"],
}


def run(folder: Path, scene: str, engine: str, seed: int) -> None:
    """One run, or what is missing of it."""
    settings = [f"--set={setting}" for setting in [*SCENES[scene], f"seed={seed}"]]
    command = ["run", scene, "--engine", engine, "--resume", "--out", str(folder), *settings]
    subprocess.run([sys.executable, "-m", "narrows", *command], check=True, stdout=sys.stderr)


def over_seeds(summaries: list[dict[str, Any]], quantity: str) -> tuple[float, float]:
    """Mean and standard error of a quantity over independent runs."""
    values = np.array([summary[quantity]["value"] for summary in summaries])
    return float(values.mean()), float(values.std(ddof=1) / np.sqrt(len(values)))


def table(summaries: dict[tuple[str, str], list[dict[str, Any]]]) -> str:
    """The comparison as Markdown."""
    rows = ["| scene | quantity | fix srd | reference | theory |", "|---|---|---|---|---|"]
    for scene, quantities in QUANTITIES.items():
        for quantity in quantities:
            cells = []
            for engine in ENGINES:
                value, error = over_seeds(summaries[scene, engine], quantity)
                cells.append(f"{value:.4f} +- {error:.4f}")
            theory = summaries[scene, ENGINES[0]][0][quantity].get("theory")
            told = f"{theory:.4f}" if theory else ""
            rows.append(f"| {scene} | {quantity} | {cells[0]} | {cells[1]} | {told} |")
    return "\n".join(rows)


def figure(folder: Path, file: Path) -> None:
    """Shear-wave decay, Poiseuille profile and settling of both engines."""
    sheet = Figure(figsize=(13, 3.8), layout="constrained")
    decay, profile, settling = sheet.subplots(1, 3)
    for engine, color in zip(ENGINES, ("C1", "C0"), strict=True):
        style: dict[str, Any] = {"color": color, "label": engine}
        wave: list[NDArray[np.float64]] = []
        velocity: list[NDArray[np.float64]] = []
        moved: list[NDArray[np.float64]] = []
        for seed in SEEDS:
            run_ = RunDirectory(folder / f"bulk-{engine}-{seed}")
            fluid = run_.fluid_profile
            wave.append(
                wave_amplitude(fluid.y, run_.field("width"), fluid.counts, fluid.velocity_x)
            )
            times = run_.times(fluid.steps)
            run_ = RunDirectory(folder / f"poiseuille-{engine}-{seed}")
            fluid = run_.fluid_profile
            used = fluid.steps > run_.equilibration_steps
            flow = momentum_profile(fluid.counts[used], fluid.velocity_x[used])
            velocity.append(flow.mean(axis=0))
            run_ = RunDirectory(folder / f"channel-{engine}-{seed}")
            x = run_.colloids.positions[1:, :, 0].mean(axis=1) - run_.colloids.positions[0, :, 0]
            carried = np.cumsum(run_.observables.mean_velocity_x) * run_.interval
            moved.append(x - carried)
            ends = run_.times(run_.observables.steps)
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
    folder: Path = parser.parse_args().out
    todo = list(product(SCENES, ENGINES, SEEDS))
    with ThreadPoolExecutor(max_workers=2) as workers:
        runs = [
            workers.submit(run, folder / f"{scene}-{engine}-{seed}", scene, engine, seed)
            for scene, engine, seed in todo
        ]
        for finished in runs:
            finished.result()
    summaries: dict[tuple[str, str], list[dict[str, Any]]] = {}
    for scene, engine, seed in todo:
        summary = analyze(folder / f"{scene}-{engine}-{seed}")
        summaries.setdefault((scene, engine), []).append(summary)
    text = table(summaries)
    (folder / "crosscheck.md").write_text(text + "\n", encoding="utf-8")
    figure(folder, folder / "crosscheck.png")
    print(text)


if __name__ == "__main__":
    main()

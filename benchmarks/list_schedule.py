"""What it costs that checkpoints leave no trace: lists at every collision against lists on demand.

    python benchmarks/list_schedule.py --out runs/lists --pairs 5

The channel's deck of the engine mpc runs in turn as it is and with LAMMPS's own schedule
(`delay 0 every 1 check yes`, skin 0.5), which builds lists when a colloid has crossed half the
skin. Processor time of one process; medians and quartiles of the ratios of pairs.
"""

import argparse
import os
import resource
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np

from lammps_inputs import Scene, make_scene
from lammps_inputs.deck import write_deck

SCENES = {
    "3 colloids, 40 x 10": make_scene("channel", equilibration=0, duration=400),
    "31 colloids, 300 x 10": make_scene(
        "channel", equilibration=0, duration=80, length=300, colloids=31, spacing=4.2
    ),
}
ON_DEMAND = "neigh_modify delay 0 every 1 check yes"


def decks(scene: Scene, folder: Path) -> tuple[Path, Path]:
    """The deck as it is, and with lists on demand."""
    now, before = folder / "now", folder / "before"
    for directory in (now, before):
        shutil.rmtree(directory, ignore_errors=True)
        directory.mkdir(parents=True)
        write_deck(scene, directory, "mpc")
    script = before / "in.lammps"
    lines = script.read_text().splitlines(keepends=True)
    assert any(line.startswith("neigh_modify") for line in lines)
    lines = [ON_DEMAND + "\n" if line.startswith("neigh_modify") else line for line in lines]
    script.write_text("".join(lines))
    return now, before


def processor_seconds(directory: Path) -> float:
    """Of one run of a deck [s]."""
    lmp = Path(sys.executable).with_name("lmp")
    environment = os.environ | {"PATH": f"{lmp.parent}:{os.environ['PATH']}"}
    environment["OMP_NUM_THREADS"] = "1"
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    words = [str(lmp), "-in", "in.lammps", "-screen", "none"]
    subprocess.run(words, cwd=directory, env=environment, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--pairs", type=int, default=5)
    given = parser.parse_args()
    print("| scene | at collisions [s] | on demand [s] | ratio | quartiles |")
    print("|---|---|---|---|---|")
    for name, scene in SCENES.items():
        now, before = decks(scene, given.out / name.replace(" ", "_"))
        pairs = np.array(
            [(processor_seconds(now), processor_seconds(before)) for _ in range(given.pairs)]
        )
        low, middle, high = np.percentile(pairs[:, 0] / pairs[:, 1], [25, 50, 75])
        seconds = np.median(pairs, axis=0)
        ratio = f"{middle:.3f} | {low:.3f} to {high:.3f}"
        print(f"| {name} | {seconds[0]:.2f} | {seconds[1]:.2f} | {ratio} |", flush=True)


if __name__ == "__main__":
    main()

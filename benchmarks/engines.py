"""fix mpc against the tuned fix srd decks: speed, ranks, sizes, and how far from the memory.

    python benchmarks/engines.py --out runs/engines [--pairs 7] [--largest 2e7]

Every pair of runs is interleaved and repeated, and medians are compared, so that what else the
machine does falls on both. Times are LAMMPS's loop times multiplied by its share of the processor.
Prints the table, and writes it beside the figure (speed.png) into the folder.
"""

import argparse
import re
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from statistics import median

import numpy as np
from matplotlib.figure import Figure

DECKS = Path(__file__).parent / "decks"
COMMANDS = Path(sys.executable).parent


@dataclass(frozen=True)
class Deck:
    """A deck, its variables, and the particle updates or time units of one of its steps."""

    name: str
    steps: int
    per_step: float
    variables: tuple[str, ...] = ()

    def rate(self) -> float:
        """Updates or time units in a second of processor time."""
        loop, share = self._run(ranks=1)
        return self.steps * self.per_step / (loop * share)

    def speed(self, ranks: int) -> float:
        """Updates or time units in a second by the clock."""
        loop, _ = self._run(ranks)
        return self.steps * self.per_step / loop

    def _run(self, ranks: int) -> tuple[float, float]:
        """Loop time [s] and the share of a processor that LAMMPS had."""
        words = [str(COMMANDS / "lmp"), "-log", "none", "-in", str(DECKS / f"{self.name}.lmp")]
        words += ["-var", "steps", str(self.steps), *self.variables]
        if ranks > 1:
            words = [str(COMMANDS / "mpirun"), "-np", str(ranks), *words]
        done = subprocess.run(words, capture_output=True, text=True, check=True)
        loop = float(re.findall(r"Loop time of (\S+)", done.stdout)[-1])
        return loop, float(re.findall(r"(\S+)% CPU use", done.stdout)[-1]) / 100


PAIRS = {
    "channel 300 x 10, 31 colloids [time units/s]": (
        Deck("fixsrd_channel", 600, 1e-3, ("-var", "search", "0.5")),
        Deck("mpc_channel", 6000, 1e-3),
        10,
    ),
    "2D fluid, 1e5 [updates/s]": (
        Deck("fixsrd_bulk2d", 60, 1e5, ("-var", "sortf", "100")),
        Deck("mpc_bulk2d", 300, 1e5),
        4,
    ),
    "3D fluid, 3.3e5 [updates/s]": (
        Deck("fixsrd_bulk3d", 15, 10 * 32**3),
        Deck("mpc_bulk3d", 45, 10 * 32**3),
        3,
    ),
}


def copy_bandwidth() -> float:
    """Bytes read and written in a second by copying 256 MB."""
    source, target = np.ones((2, 2**25))  # written once: pages of zeros would share one frame
    seconds = []
    for _ in range(5):
        began = time.process_time()
        np.copyto(target, source)
        seconds.append(time.process_time() - began)
    return 2 * source.nbytes / min(seconds)


def bytes_per_update(dimensions: int, density: float = 10) -> float:
    """Read and written: position, velocity and cell, and a cell's sum and turn by its particles."""
    particle = 2 * dimensions * 8 + 4
    cell = {2: 32 + 48, 3: 64 + 128}[dimensions]
    return 2 * (particle + cell / density)


def compare(pairs: int) -> tuple[list[str], dict[str, list[float]]]:
    """Table rows of fix mpc against fix srd, and the ratios of the pairs."""
    rows = ["| scene | fix srd | fix mpc | ratio | asked |", "|---|---|---|---|---|"]
    ratios = {}
    for scene, (srd, mpc, asked) in PAIRS.items():
        rates = [(srd.rate(), mpc.rate()) for _ in range(pairs)]
        ratios[scene] = [ours / theirs for theirs, ours in rates]
        theirs, ours = (median(column) for column in zip(*rates, strict=True))
        rows.append(
            f"| {scene} | {theirs:.3g} | {ours:.3g} | {median(ratios[scene]):.2f} | {asked} |"
        )
    return rows, ratios


def sizes(dimensions: int, largest: float) -> dict[int, float]:
    """Updates per second by the number of particles."""
    rates = {}
    for particles in 10 ** np.arange(4.0, np.log10(largest) + 0.01, 0.66):
        n = round((particles / 10) ** (1 / dimensions))
        count = 10 * n**dimensions
        deck = Deck(
            f"mpc_bulk{dimensions}d", max(20, round(3e7 / count)), count, ("-var", "n", str(n))
        )
        rates[count] = median(deck.rate() for _ in range(3))
    return rates


def two_ranks(pairs: int) -> float:
    """Speed of two ranks over one on 1e6 particles in 2D; needs two idle processors."""
    deck = Deck("mpc_bulk2d", 150, 998560, ("-var", "n", "316"))
    return median(deck.speed(2) / deck.speed(1) for _ in range(pairs))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--pairs", type=int, default=7)
    parser.add_argument("--largest", type=float, default=2e7)
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)

    rows, ratios = compare(options.pairs)
    by_size = {dimensions: sizes(dimensions, options.largest) for dimensions in (2, 3)}
    bandwidth = copy_bandwidth()
    rows += ["", f"two ranks over one, 1e6 particles: {two_ranks(options.pairs):.2f}"]
    rows.append(f"copy bandwidth: {bandwidth:.3g} bytes/s read and written")
    for dimensions, rates in by_size.items():
        moved = bytes_per_update(dimensions) * min(rates.values())
        rows.append(
            f"{dimensions}D: {bytes_per_update(dimensions):.0f} bytes an update, at the slowest "
            f"size {moved / bandwidth:.0%} of the copy bandwidth; slowest over fastest size "
            f"{min(rates.values()) / max(rates.values()):.2f}"
        )
    text = "\n".join(rows)
    print(text)
    (options.out / "speed.md").write_text(text + "\n")

    figure = Figure(figsize=(9, 3.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    left.boxplot(list(ratios.values()), tick_labels=["channel", "2D", "3D"])
    left.set(ylabel="fix mpc / fix srd", ylim=(0, None))
    for dimensions, rates in by_size.items():
        right.semilogx(list(rates), [r / 1e6 for r in rates.values()], "o-", label=f"{dimensions}D")
        right.axhline(
            bandwidth / bytes_per_update(dimensions) / 1e6,
            ls=":",
            color=f"C{dimensions - 2}",
            label=f"{dimensions}D at copy bandwidth",
        )
    right.set(xlabel="fluid particles", ylabel="million updates/s", ylim=(0, None))
    right.legend(fontsize="small")
    figure.savefig(options.out / "speed.png", dpi=150)


if __name__ == "__main__":
    main()

"""fix mpc against the tuned fix srd decks: speed, sizes, how far from the memory, and two ranks.

    python benchmarks/engines.py --out runs/engines [--parts pairs ranks] [--page PAGE]

Every pair of runs is interleaved and repeated, and medians are compared, so that what else the
machine does falls on both. Times are LAMMPS's loop times multiplied by its share of the processor;
those of two ranks by the clock: they need an idle machine. Each part leaves its table in the folder
and can be run by itself; the page gets all that are there, between its marks of `engines`. The
figure (speed.png) is drawn when the pairs and the sizes are known.
"""

import argparse
import json
import multiprocessing
import re
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from narrows.markdown import replace_block, table

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


def copy_bandwidth(clock: Callable[[], float] = time.process_time) -> float:
    """Bytes read and written in a second of a clock by copying 256 MB."""
    source, target = np.ones((2, 2**25))  # written once: pages of zeros would share one frame
    seconds = []
    for _ in range(12):
        began = clock()
        np.copyto(target, source)
        seconds.append(clock() - began)
    return 2 * source.nbytes / median(seconds)


def two_copies() -> float:
    """Bandwidth of two processes that copy at once over that of one."""
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        together = sum(pool.map(copy_bandwidth, [time.perf_counter] * 2, chunksize=1))
        return together / pool.apply(copy_bandwidth, [time.perf_counter])


def bytes_per_update(dimensions: int, density: float = 10) -> float:
    """Read and written, counted in the passes of core/solver.h and core/tile_order.h.

    A particle's position, velocity and cell are read and written once, and moved at every 64th
    collision. A cell's sum is cleared, read and written by its particles, and read for the map; the
    map is written, and read by the particles.
    """
    state = 2 * dimensions * 8 + 4
    sort = 2 * (state + 4) + 4 * (4 + 2 * dimensions)  # numbers too, by an order of 4 bytes
    of_sum, of_map = {2: (32, 48), 3: (64, 128)}[dimensions]
    return 2 * state + sort / 64 + (4 * of_sum + 2 * of_map) / density


def compare(pairs: int) -> tuple[str, dict[str, list[float]]]:
    """The table of fix mpc against fix srd, and the ratios of the pairs."""
    rows, ratios = [], {}
    for scene, (srd, mpc, asked) in PAIRS.items():
        rates = [(srd.rate(), mpc.rate()) for _ in range(pairs)]
        ratios[scene] = [ours / theirs for theirs, ours in rates]
        theirs, ours = (median(column) for column in zip(*rates, strict=True))
        of_rates = (f"{theirs:.3g}", f"{ours:.3g}")
        rows.append((scene, *of_rates, *quartiles(ratios[scene]), f"{asked}"))
    head = ("scene", "fix srd", "fix mpc", "ratio", "quartiles", "asked")
    return table(head, rows), ratios


def sizes(dimensions: int, largest: float) -> dict[int, float]:
    """Updates per second by the number of particles."""
    rates = {}
    for particles in np.unique(np.append(10 ** np.arange(4.0, np.log10(largest), 0.66), largest)):
        n = round((particles / 10) ** (1 / dimensions))
        count = 10 * n**dimensions
        deck = Deck(
            f"mpc_bulk{dimensions}d", max(20, round(3e7 / count)), count, ("-var", "n", str(n))
        )
        rates[count] = median(deck.rate() for _ in range(3 if count < 3e6 else 1))
    return rates


def of_memory(dimensions: int, rates: dict[int, float], bandwidth: float) -> str:
    """A table of the rates beside the bandwidth of a copy."""
    fastest = max(rates.values())
    rows = [
        (
            f"{count:.3g}",
            f"{rate:.3g}",
            f"{rate / fastest:.2f}",
            f"{bytes_per_update(dimensions) * rate / bandwidth:.0%}",
        )
        for count, rate in rates.items()
    ]
    head = (f"particles, {dimensions}D", "updates/s", "of the fastest", "of the copy bandwidth")
    return (
        table(head, rows)
        + f"\n\n{bytes_per_update(dimensions):.0f} bytes an update; copy bandwidth of one core "
        + f"{bandwidth:.3g} bytes/s read and written."
    )


def two_ranks(pairs: int, largest: float) -> str:
    """A table of the speed of two ranks over one in 2D, beside two copies over one."""
    rows = []
    for particles in (1e6, largest):
        n = round((particles / 10) ** 0.5)
        deck = Deck("mpc_bulk2d", max(20, round(3e8 / particles)), 10 * n**2, ("-var", "n", str(n)))
        speeds = [deck.speed(2) / deck.speed(1) for _ in range(pairs)]
        rows.append((f"{particles:.3g} particles", *quartiles(speeds)))
    rows.append(("copies of 256 MB at once", *quartiles([two_copies() for _ in range(pairs)])))
    return table(("two over one", "median", "quartiles"), rows)


def quartiles(values: list[float]) -> tuple[str, str]:
    """The median in words, and the quartiles."""
    low, middle, high = np.quantile(values, [0.25, 0.5, 0.75])
    return f"{middle:.2f}", f"{low:.2f} to {high:.2f}"


def draw(
    ratios: dict[str, list[float]], by_size: dict[int, dict[int, float]], bandwidth: float
) -> Figure:
    """Ratios of the pairs, and speed by size."""
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
    return figure


PARTS = ("pairs", "2d", "3d", "ranks")


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--parts", nargs="+", choices=PARTS, default=PARTS)
    parser.add_argument("--pairs", type=int, default=7)
    parser.add_argument("--largest", type=float, default=2e7)
    parser.add_argument("--page", type=Path, help="a page with the marks of `engines`")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)

    for part in options.parts:
        known: dict[str, Any] = {}
        if part == "pairs":
            text, known["ratios"] = compare(options.pairs)
        elif part == "ranks":
            text = two_ranks(options.pairs, options.largest)
        else:
            known["rates"] = sizes(int(part[0]), options.largest)
            known["bandwidth"] = copy_bandwidth()
            text = of_memory(int(part[0]), known["rates"], known["bandwidth"])
        print(text, flush=True)
        (options.out / f"{part}.md").write_text(text + "\n", encoding="utf-8")
        (options.out / f"{part}.json").write_text(json.dumps(known), encoding="utf-8")
    files = [options.out / f"{part}.md" for part in PARTS]
    if options.page:
        texts = [file.read_text(encoding="utf-8").strip() for file in files if file.exists()]
        replace_block(options.page, "engines", "\n\n".join(texts))
    if all(file.exists() for file in files[:3]):
        pairs, *sized = (json.loads(file.with_suffix(".json").read_text()) for file in files[:3])
        by_size = {
            dimensions: {int(count): rate for count, rate in of["rates"].items()}
            for dimensions, of in zip((2, 3), sized, strict=True)
        }
        figure = draw(pairs["ratios"], by_size, sized[0]["bandwidth"])
        figure.savefig(options.out / "speed.png", dpi=150)


if __name__ == "__main__":
    main()

"""fix mpc with colloids of hecht-2005 against fix srd, and where its time goes.

    python benchmarks/claylike.py [--pairs 5] [--tables against ...] [--page docs/performance.md]

Coupling I against the tuned peer deck, interleaved pairs; both couplings against their parts, and
two ranks. Times are LAMMPS's loop times multiplied by its share of the processor, in milliseconds
for a collision with its MD steps.
"""

import argparse
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from statistics import median

from engines import copy_bandwidth
from narrows.markdown import replace_block, table

DECKS = Path(__file__).parent / "decks"
COMMANDS = Path(sys.executable).parent


@dataclass(frozen=True)
class Deck:
    """A deck and its variables; `nsrd` is its number of collisions."""

    name: str
    collisions: int
    variables: tuple[str, ...] = ()

    def time(self, ranks: int = 1) -> float:
        """Processor time of a collision with its MD steps [ms]; by the clock on several ranks."""
        loop, share = self._run(ranks)
        return 1e3 * loop * (share if ranks == 1 else 1) / self.collisions

    def _run(self, ranks: int) -> tuple[float, float]:
        words = [str(COMMANDS / "lmp"), "-log", "none", "-in", str(DECKS / f"{self.name}.lmp")]
        words += ["-var", "nsrd", str(self.collisions), *self.variables]
        if ranks > 1:
            words = [str(COMMANDS / "mpirun"), "-np", str(ranks), *words]
        done = subprocess.run(words, capture_output=True, text=True, check=True)
        loop = float(re.findall(r"Loop time of (\S+)", done.stdout)[-1])
        return loop, float(re.findall(r"(\S+)% CPU use", done.stdout)[-1]) / 100


def variables(**values: object) -> tuple[str, ...]:
    """Of a deck, as words for `lmp`."""
    return tuple(word for name, value in values.items() for word in ("-var", name, str(value)))


FAST = variables(nsub=20, N=462)
PAIRS = {
    "I, 231 spheres, 455 MD steps": (Deck("fixsrd_claylike", 2), Deck("mpc_claylike", 20), 20),
    "I, 462 spheres, 20 MD steps": (
        Deck("fixsrd_claylike", 10, FAST),
        Deck("mpc_claylike", 20, FAST),
        8,
    ),
}
APART = variables(fluid="collide no")
NO_FLUID = variables(particles=1, fluid="collide no")
CROWD = variables(spheres=1155)
LUBRICATED = variables(velocities="yes", lubrication="lubrication 14.44 0.02 0.3")
PARTS = {  # and what is asked
    "I, 462 spheres, 20 MD steps, the fluid not coupled": (
        Deck("mpc_claylike", 20, (*FAST, *APART)),
        "",
    ),
    "I, the fluid of two spheres, without MD steps": (
        Deck("mpc_claylike", 20, variables(N=2, nsub=1)),
        "",
    ),
    "II, 231 spheres": (Deck("mpc_cell", 20), "2.3"),
    "II, 1155 spheres": (Deck("mpc_cell", 20, CROWD), "19"),
    "II, 1155 spheres with lubrication": (Deck("mpc_cell", 20, (*CROWD, *LUBRICATED)), ""),
    "II, the fluid of two spheres, without MD steps": (
        Deck("mpc_cell", 40, variables(spheres=2, nsub=1)),
        "",
    ),
    "II, the MD steps of 231 spheres, without fluid": (Deck("mpc_cell", 20, NO_FLUID), ""),
    "II, the MD steps of 1155 spheres, without fluid": (
        Deck("mpc_cell", 20, (*CROWD, *NO_FLUID)),
        "",
    ),
}
RANKS = {
    "I, 231 spheres, 455 MD steps": Deck("mpc_claylike", 10),
    "I, 462 spheres, 20 MD steps": Deck("mpc_claylike", 20, FAST),
    "II, 231 spheres": Deck("mpc_cell", 40),
    "II, 1155 spheres": Deck("mpc_cell", 20, CROWD),
}


def against(pairs: int) -> str:
    """Coupling I and fix srd."""
    rows = []
    for name, (srd, mpc, asked) in PAIRS.items():
        times = [(srd.time(), mpc.time()) for _ in range(pairs)]
        theirs, ours = (median(column) for column in zip(*times, strict=True))
        ratio = median(srd / mpc for srd, mpc in times)
        rows.append((name, f"{theirs:.4g}", f"{ours:.3g}", f"{ratio:.1f}", str(asked)))
    return table(("coupling", "fix srd [ms]", "fix mpc [ms]", "ratio", "asked"), rows)


def parts(rounds: int) -> str:
    """Both couplings, whole and in parts."""
    rows = []
    for name, (deck, asked) in PARTS.items():
        rows.append((name, f"{median(deck.time() for _ in range(rounds)):.3g}", asked))
    bandwidth = f"Copy bandwidth: {copy_bandwidth():.3g} bytes/s read and written."
    return table(("fix mpc", "ms a collision", "asked"), rows) + "\n\n" + bandwidth


def ranks(pairs: int) -> str:
    """Two ranks, which need two idle processors."""
    rows = []
    for name, deck in RANKS.items():
        rows.append((name, f"{median(deck.time(1) / deck.time(2) for _ in range(pairs)):.2f}"))
    return table(("fix mpc", "two ranks over one (asked: 1.7)"), rows)


TABLES = {"against": against, "parts": parts, "ranks": ranks}


def main() -> None:
    """Print the tables, or put them into a page."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--pairs", type=int, default=5)
    parser.add_argument("--tables", nargs="+", choices=TABLES, default=list(TABLES))
    parser.add_argument("--page", type=Path, help="a page with the marks of `claylike-TABLE`")
    options = parser.parse_args()
    for name in options.tables:
        text = TABLES[name](options.pairs)
        if options.page:
            replace_block(options.page, f"claylike-{name}", text)
        else:
            print(text + "\n")


if __name__ == "__main__":
    main()

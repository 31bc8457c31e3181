"""fix mpc with colloids of hecht-2005 against fix srd, and where its time goes.

    python benchmarks/claylike.py --out runs/claylike [--pairs 5]

Coupling I against the tuned peer deck, interleaved pairs; both couplings against the same without
one. Times are LAMMPS's loop times multiplied by its share of the processor, in milliseconds for a
collision with its MD steps. Prints the table, and writes it into the folder.
"""

import argparse
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from statistics import median

from engines import copy_bandwidth

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
ALONE = variables(fluid="collide no")
PARTS = {
    "I, 231 spheres, the fluid not coupled": Deck("mpc_claylike", 20, ALONE),
    "II, 231 spheres": Deck("mpc_cell", 20),
    "II, 231 spheres, the fluid not coupled": Deck("mpc_cell", 20, ALONE),
    "II, 1155 spheres": Deck("mpc_cell", 20, variables(spheres=1155)),
    "II, 1155 spheres, the fluid not coupled": Deck(
        "mpc_cell", 20, (*variables(spheres=1155), *ALONE)
    ),
    "II, 1155 spheres with lubrication": Deck(
        "mpc_cell",
        20,
        variables(spheres=1155, velocities="yes", lubrication="lubrication 14.44 0.02 0.3"),
    ),
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--pairs", type=int, default=5)
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)

    rows = ["| coupling | fix srd [ms] | fix mpc [ms] | ratio | asked |", "|---|---|---|---|---|"]
    for name, (srd, mpc, asked) in PAIRS.items():
        times = [(srd.time(), mpc.time()) for _ in range(options.pairs)]
        theirs, ours = (median(column) for column in zip(*times, strict=True))
        ratio = median(srd / mpc for srd, mpc in times)
        rows.append(f"| {name} | {theirs:.4g} | {ours:.3g} | {ratio:.1f} | {asked} |")
    rows += ["", "| fix mpc | ms a collision |", "|---|---|"]
    for name, deck in PARTS.items():
        rows.append(f"| {name} | {median(deck.time() for _ in range(options.pairs)):.3g} |")
    for name, deck in (("I", Deck("mpc_claylike", 20)), ("II", Deck("mpc_cell", 40))):
        gain = median(deck.time(1) / deck.time(2) for _ in range(options.pairs))
        rows.append(f"\n{name}: two ranks over one {gain:.2f}; needs two idle processors")
    rows.append(f"copy bandwidth: {copy_bandwidth():.3g} bytes/s read and written")
    text = "\n".join(rows)
    print(text)
    (options.out / "speed.md").write_text(text + "\n")


if __name__ == "__main__":
    main()

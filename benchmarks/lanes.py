"""The thermostats of lane formation against LAMMPS's own isokinetic one: speed, sizes, ranks.

    python benchmarks/lanes.py --out runs/lanes [--pairs 7] [--largest 1e5] [--page docs/lanes.md]

The peer is `fix nvk` with LAMMPS's fastest pair style for the same potential, lj/cut/opt with a
sigma that leaves its twelfth power alone. All runs of a round are interleaved, and medians are
compared, so that what else the machine does falls on all. Times are LAMMPS's loop times multiplied
by its share of the processor. Prints the table, writes it into the folder (speed.md), and renews it
in a page.
"""

import argparse
import re
import subprocess
import sys
from pathlib import Path
from statistics import median

from narrows.markdown import replace_block

DECK = Path(__file__).parent / "decks" / "lanes.lmp"
COMMANDS = Path(sys.executable).parent
PEER = ("-var", "pair", "lj/cut/opt 2.0", "-var", "coefficients", "2.5e-37 1000.0")
KINDS: dict[str, tuple[str, ...]] = {
    "fix nvk, lj/cut/opt": (*PEER, "-var", "thermostat", "nvk"),
    "fix isokinetic, soft/disk": (),
    "fix configurational, soft/disk": ("-var", "thermostat", "configurational 1.0 10"),
}
DISKS = {896: (28, 16), 9920: (80, 62), 100000: (250, 200)}


def step_time(kind: str, disks: int, steps: int, ranks: int = 1) -> float:
    """Seconds a step: of the processor on one rank, by the clock on more."""
    columns, rows = DISKS[disks]
    words = [str(COMMANDS / "lmp"), "-log", "none", "-in", str(DECK), *KINDS[kind]]
    words += ["-var", "columns", str(columns), "-var", "rows", str(rows), "-var", "steps"]
    words.append(str(steps))
    if ranks > 1:
        words = [str(COMMANDS / "mpirun"), "-np", str(ranks), *words]
    done = subprocess.run(words, capture_output=True, text=True, check=True)
    loop = float(re.findall(r"Loop time of (\S+)", done.stdout)[-1])
    share = float(re.findall(r"(\S+)% CPU use", done.stdout)[-1]) / 100
    return loop * (share if ranks == 1 else 1) / steps


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--pairs", type=int, default=7)
    parser.add_argument("--largest", type=float, default=1e5)
    parser.add_argument("--page", type=Path, help="Markdown page whose table is renewed")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)

    peer, kinetic, configurational = KINDS
    rows = [
        "| disks | fix nvk [us] | isokinetic [us] | over nvk | configurational [us] "
        "| over isokinetic |",
        "|---|---|---|---|---|---|",
    ]
    for disks in (n for n in DISKS if n <= options.largest):
        steps = max(100, round(1e7 / disks))
        times: dict[str, list[float]] = {kind: [] for kind in KINDS}
        for _ in range(options.pairs):
            for kind in KINDS:
                times[kind].append(1e6 * step_time(kind, disks, steps))
        over = [a / b for a, b in zip(times[kinetic], times[peer], strict=True)]
        more = [a / b for a, b in zip(times[configurational], times[kinetic], strict=True)]
        rows.append(
            f"| {disks} | {median(times[peer]):.1f} | {median(times[kinetic]):.1f} | "
            f"{median(over):.2f} | {median(times[configurational]):.1f} | {median(more):.2f} |"
        )
    if options.largest >= 1e5:
        for kind in (kinetic, configurational):
            gains = [
                step_time(kind, 100000, 100) / step_time(kind, 100000, 100, 2)
                for _ in range(options.pairs)
            ]
            rows.append("")
            rows.append(f"two ranks over one, 100000 disks, {kind}: {median(gains):.2f}")
    text = "\n".join(rows)
    print(text)
    (options.out / "speed.md").write_text(text + "\n")
    if options.page:
        replace_block(options.page, "speed", text)


if __name__ == "__main__":
    main()

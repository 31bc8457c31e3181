"""Single precision beside double: speed, drifts, and points of the chart of error against run time.

    python benchmarks/single.py --out runs/single [--tables speed drift accuracy] [--page PAGE]

Pairs are interleaved; times are processor seconds, ratios those of the pairs. Prints the tables,
and puts them between the marks of a page.
"""

import argparse
import re
import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from statistics import quantiles

from accuracy import Setting, full_table, measure, setting
from engines import COMMANDS, DECKS, Deck
from narrows.markdown import replace_block, table
from pareto import STUDIES

SIZES = ((2, 316), (2, 1000), (3, 46), (3, 100))  # dimensions, edge in cells of 10 particles
NAMES = ("speed", "drift", "accuracy")
UPDATES = 4e7  # of a run
DOUBLE, SINGLE = setting("mpc"), setting("mpc", precision="single")


def speeds(pairs: int) -> str:
    """Double over single: what the same updates take."""
    rows = []
    for dimensions, edge in SIZES:
        particles = 10 * edge**dimensions
        for thermostat in ("none", "layer"):
            common = ("-var", "n", str(edge), "-var", "tstat", thermostat)
            steps = max(4, round(UPDATES / particles))
            decks = [
                Deck(
                    f"mpc_bulk{dimensions}d",
                    steps,
                    particles,
                    (*common, "-var", "precision", precision),
                )
                for precision in ("double", "single")
            ]
            rates = [(decks[0].rate(), decks[1].rate()) for _ in range(pairs)]
            double, single = (quantiles(column, n=4)[1] for column in zip(*rates, strict=True))
            low, middle, high = quantiles([ours / theirs for theirs, ours in rates], n=4)
            rows.append(
                (
                    f"{dimensions}D, {particles:.3g}, {thermostat}",
                    f"{double:.3g}",
                    f"{single:.3g}",
                    f"{middle:.2f}",
                    f"{low:.2f} to {high:.2f}",
                )
            )
    return table(("fluid", "double [updates/s]", "single", "ratio", "quartiles"), rows)


def drifts(collisions: int) -> str:
    """What is left of momentum and energy of 2560 particles."""
    rows = []
    for angle, gravity in ((90, 0.0), (130, 0.0), (90, 1e-6)):
        words = [str(COMMANDS / "lmp"), "-log", "none", "-in", str(DECKS / "mpc_drift.lmp")]
        words += ["-var", "precision", "single", "-var", "steps", str(collisions)]
        words += ["-var", "angle", str(angle), "-var", "gravity", repr(gravity)]
        done = subprocess.run(words, capture_output=True, text=True, check=True)
        lines = [
            [float(word) for word in line.split()]
            for line in done.stdout.splitlines()
            if re.fullmatch(r"\s*\d+(\s+[-+\d.e]+){3}\s*", line)
        ]
        first, last = lines[0], lines[-1]
        change = [(after - before) / 2560 for before, after in zip(first, last, strict=True)]
        rows.append(
            (
                f"{angle}, {gravity:g}",
                f"{last[0]:.0f}",
                f"{change[1]:.1e}",
                f"{change[2]:.1e}",
                f"{last[3] / first[3] - 1:.1e}",
            )
        )
    return table(
        ("angle, gravity", "collisions", "drift of <v_x> - g t", "of <v_y>", "of the energy"), rows
    )


def points(folder: Path, budget: float) -> str:
    """Values, deviations and errors of both, as in the chart; of v_s against double itself."""
    studies = []
    for study in STUDIES[:3]:
        quantities = [
            replace(each, truth=DOUBLE) if isinstance(each.truth, Setting) else each
            for each in study.quantities
            if not isinstance(each.truth, Setting) or each.name == "settling speed"
        ]
        settings = (DOUBLE, SINGLE)
        studies.append(
            replace(study, settings=settings, quantities=tuple(quantities), converged=None)
        )
    return full_table(measure(tuple(studies), folder, budget, 1))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0] if __doc__ else None)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--pairs", type=int, default=7)
    parser.add_argument("--budget", type=float, default=6.0, help="processor seconds of a setting")
    parser.add_argument("--tables", nargs="+", choices=NAMES, default=NAMES)
    parser.add_argument("--page", type=Path, help="page between whose marks tables are put")
    parser.add_argument("--collisions", type=int, default=1_000_000)
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    tables: dict[str, Callable[[], str]] = {
        "single-speed": lambda: speeds(options.pairs),
        "single-drift": lambda: drifts(options.collisions),
        "single-accuracy": lambda: points(options.out, options.budget),
    }
    for name in options.tables:
        made = tables[f"single-{name}"]()
        print(made, flush=True)
        if options.page:
            replace_block(options.page, f"single-{name}", made)


if __name__ == "__main__":
    main()

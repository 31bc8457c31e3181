"""The plugin of two installations, in turn: a wheel for every machine against a build for this one.

    python benchmarks/wheels.py LMP [--pairs 7] [--page docs/performance.md]

LMP is the `lmp` of the other environment, where narrows is built for this machine only:

    pip install . -C cmake.define.NARROWS_NATIVE=ON

Both run the same decks, one after the other, the order changing from pair to pair. The ratio is of
the processor time of whole processes, less that of one which takes a single step.
"""

import argparse
import os
import sys
import tempfile
from pathlib import Path

import numpy as np

from narrows.markdown import replace_block, table

DECKS = {  # steps, and the deck in words
    "mpc_channel": (12000, "channel of 31 colloids"),
    "mpc_bulk2d": (3000, "fluid, 2D"),
    "mpc_bulk3d": (1000, "fluid, 3D"),
}


def processor_seconds(lmp: Path, deck: Path, steps: int) -> float:
    """User time of a process, by the system's own account [s]."""
    with tempfile.TemporaryDirectory() as folder, open(os.devnull, "w") as nowhere:
        words = [str(lmp), "-in", str(deck), "-var", "steps", str(steps), "-log", "none"]
        files = [(os.POSIX_SPAWN_DUP2, nowhere.fileno(), 1)]
        home = Path.cwd()
        os.chdir(folder)
        try:
            process = os.posix_spawn(words[0], words, os.environ, file_actions=files)
        finally:
            os.chdir(home)
        _, status, used = os.wait4(process, 0)
    if status:
        raise SystemExit(f"{lmp} -in {deck} failed")
    return used.ru_utime


def main() -> None:
    """Print the table, or put it into a page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("lmp", type=Path)
    parser.add_argument("--pairs", type=int, default=7)
    parser.add_argument("--page", type=Path, help="a page with the marks of `wheels`")
    given = parser.parse_args()
    mine, other = Path(sys.executable).with_name("lmp"), given.lmp.absolute()
    rows = []
    for name, (steps, words) in DECKS.items():
        deck = Path(__file__).parent.absolute() / "decks" / f"{name}.lmp"
        start = {lmp: processor_seconds(lmp, deck, 1) for lmp in (mine, other)}
        ratios = []
        for pair in range(given.pairs):
            order = (mine, other) if pair % 2 else (other, mine)
            spent = {lmp: processor_seconds(lmp, deck, steps) - start[lmp] for lmp in order}
            ratios.append(spent[mine] / spent[other])
        low, middle, high = np.quantile(ratios, [0.25, 0.5, 0.75])
        rows.append((words, f"{middle:.3f}", f"{low:.3f} to {high:.3f}"))
    text = table(("deck", "the default build over the native one", "quartiles"), rows)
    if given.page:
        replace_block(given.page, "wheels", text)
    else:
        print(text)


if __name__ == "__main__":
    main()

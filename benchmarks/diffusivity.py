"""Do the bars of the three diffusivity estimators hold the truth, and how wide are they?

    python benchmarks/diffusivity.py [--walks 40] [--bayes 40] [--page docs/diffusivity.md]
    python benchmarks/diffusivity.py --lengths 500,1000,2000,4000,8000 [--walks 4]
        [--page docs/diffusivity.md] [--figure docs/figures/estimators.png]

Walks of 100 walkers with known D and free energy (`tests/diffusivity/walks.py`), 3000 frames, each
analysed on its own. Printed for |z - middle| < 1.2, 60 % of the slit: the fraction of positions
whose 95 % interval holds the true D, mean and scatter between walks of D over the true one,
and the mean relative error. With --lengths instead, over so many frames: the root mean square of
log D over the true one, all walks and the same positions, beside the relative error that is told;
where an estimator refuses some of the walks, how many. With --page the table goes between the marks
of that page.
"""

import argparse
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from analysis.diffusivity import (
    AlongAxis,
    BayesianDiffusivity,
    ColorDiffusivity,
    DiffusivityError,
    FirstPassageDiffusivity,
)
from analysis.diffusivity.blocks import quantile_95
from analysis.drawing import one_panel
from narrows.markdown import replace_block, table
from tests.diffusivity import walks

Array = NDArray[np.float64]

WALKERS, FRAMES, SEED = 100, 3000, 5
MIDDLE = 1.2
BLOCKS = 10
LAGS = (2, 5, 10, 20, 40)
COLUMNS = ("estimator", "walks", "intervals of 95 % that hold", "D over the truth", "error / D")


def color(coordinate: AlongAxis) -> Any:
    return ColorDiffusivity(coordinate, 0.3, 3.7, probability=0.3, reach=0.5, bin_width=0.05)


def first_passage(coordinate: AlongAxis) -> Any:
    return FirstPassageDiffusivity(coordinate, 0.3, 3.7, reach=0.5, bin_width=0.05)


def bayes(coordinate: AlongAxis) -> Any:
    return BayesianDiffusivity(coordinate, 0, walks.LENGTH, bins=16, lags=LAGS, samples=0)


def row(name: str, make: Callable[[AlongAxis], Any], count: int) -> tuple[str, ...]:
    """The estimator on so many walks."""
    inside, ratios, errors = [], [], []
    for number in range(count):
        path = walks.walk(WALKERS, FRAMES, seed=SEED + number)
        results = make(AlongAxis(walks.universe(path).atoms)).run().results
        middle = np.abs(results.positions - walks.LENGTH / 2) < MIDDLE
        d, error = results.diffusivity[middle], results.error[middle]
        true = walks.diffusivity(results.positions[middle])
        reach = quantile_95(BLOCKS) * error
        interval = results.get("interval")
        low, high = (d - reach, d + reach) if interval is None else interval[:, middle]
        inside.append(np.mean((low < true) & (true < high)))
        ratios.append(np.mean(d / true))
        errors.append(np.mean(error / d))
    scatter = np.std(inside, ddof=1) / np.sqrt(count)
    return (
        name,
        str(count),
        f"{np.mean(inside):.3f} +- {scatter:.3f}",
        f"{np.mean(ratios):.3f} +- {np.std(ratios, ddof=1):.3f}",
        f"{np.mean(errors):.3f}",
    )


def deviation(make: Callable[[AlongAxis], Any], frames: int, count: int) -> tuple[Array, int]:
    """RMS of log (D / truth) and mean relative error (2,), and how many walks were enough."""
    squares, told = list[Array](), list[Array]()
    for number in range(count):
        path = walks.walk(WALKERS, frames, seed=SEED + number)
        try:
            results = make(AlongAxis(walks.universe(path).atoms)).run().results
        except DiffusivityError:
            continue
        middle = np.abs(results.positions - walks.LENGTH / 2) < MIDDLE
        d, error = results.diffusivity[middle], results.error[middle]
        squares.append(np.log(np.abs(d) / walks.diffusivity(results.positions[middle])) ** 2)
        told.append(error / np.abs(d))
    if not squares:
        return np.full(2, np.nan), 0
    rms = np.sqrt(np.mean(np.concatenate(squares)))
    return np.array([rms, np.median(np.concatenate(told))]), len(squares)


def by_length(lengths: list[int], count: int, picture: Path | None) -> str:
    """A table and a chart of the error against the length of a trajectory."""
    found = {
        name: [deviation(make, frames, count) for frames in lengths]
        for name, make in ESTIMATORS.items()
    }
    if picture:
        figure, axes = one_panel(f"frames of {WALKERS} walkers", "relative error of $D$")
        for number, (name, values) in enumerate(found.items()):
            rms = [value[0] for value, _ in values]
            axes.loglog(lengths, rms, "o-", color=f"C{number}", label=f"{name}, from the truth")
            told = [value[1] for value, _ in values]
            axes.loglog(lengths, told, "--", color=f"C{number}", label=f"{name}, as told")
        axes.legend(fontsize="small")
        figure.savefig(picture, dpi=150)
    rows = [
        (
            f"`{name}`",
            *(
                "refused"
                if not enough
                else f"{value[0]:.3f} ({value[1]:.3f})"
                + (f", {enough} of {count}" if enough < count else "")
                for value, enough in values
            ),
        )
        for name, values in found.items()
    ]
    return table(("estimator", *(f"{frames} frames" for frames in lengths)), rows)


ESTIMATORS = {
    "ColorDiffusivity": color,
    "FirstPassageDiffusivity": first_passage,
    "BayesianDiffusivity": bayes,
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--walks", type=int, default=40)
    parser.add_argument("--bayes", type=int, default=40, help="walks of the slowest estimator")
    parser.add_argument("--lengths", help="of trajectories, in frames: the other table")
    parser.add_argument("--figure", type=Path)
    parser.add_argument("--page", type=Path)
    arguments = parser.parse_args()
    if arguments.lengths:
        lengths = [int(word) for word in arguments.lengths.split(",")]
        text = by_length(lengths, arguments.walks, arguments.figure)
        print(text)
        if arguments.page:
            replace_block(arguments.page, "lengths", text)
        return
    rows = [
        row("`ColorDiffusivity`", color, arguments.walks),
        row("`FirstPassageDiffusivity`", first_passage, arguments.walks),
        row("`BayesianDiffusivity`", bayes, arguments.bayes),
    ]
    text = table(COLUMNS, rows)
    print(text)
    if arguments.page:
        replace_block(arguments.page, "coverage", text)


if __name__ == "__main__":
    main()

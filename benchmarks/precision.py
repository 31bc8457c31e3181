"""Runs that end when they are precise: what was reached against what was asked, bias, and time.

    python benchmarks/precision.py --out runs/precision --page docs/precision.md [--jobs 2]

Series of known mean, and 30 runs each of three scenes by `sweep_until`, every seed for itself. What
is there already is not run again.
"""

import argparse
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from analysis import correlated_mean
from analysis.estimate import Estimate
from analysis.precision import Precision
from interval_coverage import autoregressive
from narrows.markdown import replace_block, table
from narrows.until import sweep_until
from srd_driver import sweep_definition
from srd_driver.sweep import available_cores

Array = NDArray[np.float64]

ERRORS = ("2%", "1%")
RUNS = 30
SERIES = 1000  # of a kind
LONGEST = 2**18  # samples
FIRST = 200  # samples at the first look
WIDTH = 0.5  # standard deviation over mean


def two_times(random: np.random.Generator) -> Array:
    """A tenth of the variance is slow."""
    fast, slow = autoregressive(1.0, LONGEST, random), autoregressive(40.0, LONGEST, random)
    return np.asarray(math.sqrt(0.9) * fast + math.sqrt(0.1) * slow)


def squares(random: np.random.Generator) -> Array:
    """Where a stretch is large it fluctuates more, so value and error go together."""
    return np.asarray((autoregressive(10.0, LONGEST, random) ** 2 - 1) / math.sqrt(2))


def energies(random: np.random.Generator) -> Array:
    """Squares again, alone: as kinetic energies, and displacements for D."""
    return np.asarray((autoregressive(2.5, LONGEST, random) ** 2 - 1) / WIDTH)


SYNTHETIC: dict[str, Callable[[np.random.Generator], Array]] = {
    "AR(1), tau = 5 samples": lambda random: autoregressive(5.0, LONGEST, random),
    "10% of the variance slow, tau = 40": two_times,
    "squares of AR(1), tau = 2.5": energies,
    "squares of AR(1), tau = 10, upon 1.8 times their mean": squares,
}


@dataclass(frozen=True)
class Study:
    """A quantity of a scene, and the run of its first look."""

    scene: str
    fields: dict[str, Any]
    quantity: str


STUDIES = {
    "v_s (`channel`)": Study(
        "channel",
        {
            "collision_time": 0.06,
            "md_steps_per_collision": 3,
            "gravity": 0.2,
            "equilibration": 20,
            "duration": 50,
        },
        "settling_speed",
    ),
    "viscosity (`poiseuille`)": Study(
        "poiseuille",
        {"length": 10, "width": 10, "gravity": 0.05, "equilibration": 30, "duration": 30},
        "viscosity",
    ),
    "D (`pore`)": Study(
        "pore",
        {
            "particles": 200,
            "packing_fraction": 0.2,
            "sampling_interval": 5,
            "equilibration": 20,
            "duration": 200,
        },
        "diffusivity.p=0.1.middle",
    ),
}


@dataclass(frozen=True)
class Reached:
    """What runs gave that were to stop at an error.

    Attributes:
        estimates: of each run.
        lengths: its time or samples.
        truth: the mean, as it is known.
        asked: the relative error.
    """

    estimates: Sequence[Estimate]
    lengths: Array
    truth: Estimate
    asked: float

    def row(self, name: str, asked: str) -> tuple[str, ...]:
        """A row of the table."""
        true = self.truth.number
        values = np.array([each.number for each in self.estimates])
        errors = np.array([each.standard_error for each in self.estimates])
        held = [
            abs(each.number - true) < (each - self.truth).half_width() for each in self.estimates
        ]
        count = len(values)
        spread = values.std(ddof=1)
        spread_error = spread / math.sqrt(2 * (count - 1))
        bias = values.mean() - true
        bias_error = math.hypot(spread / math.sqrt(count), self.truth.standard_error)
        fixed = spread**2 * self.lengths.mean() / (self.asked * true) ** 2  # length for that error
        return (
            name,
            asked,
            f"{np.sqrt(np.mean((errors / values) ** 2)):.2%}",
            f"{spread / true:.2%} +- {spread_error / true:.2%}",
            f"{bias / spread:+.2f} +- {bias_error / spread:.2f}",
            f"{np.mean(held):.0%}",
            f"{self.lengths.mean():.4g}",
            f"{self.lengths.mean() / fixed:.2f}",
        )


def stop_series(name: str, asked: str) -> Reached:
    """Series that are looked at as runs are."""
    precision = Precision.of_text(f"mean={asked}")
    random = np.random.default_rng(1)
    found = []
    for _ in range(SERIES):
        series = 1 + WIDTH * SYNTHETIC[name](random)
        length, factor = FIRST, 2.0
        while factor > 1 and length < LONGEST:
            estimate = correlated_mean.mean(series[:length])
            factor = precision.growth(estimate)
            used, length = length, min(math.ceil(length * factor), LONGEST)
        found.append((estimate, used))
    estimates, lengths = zip(*found, strict=True)
    return Reached(estimates, np.array(lengths), Estimate(1.0, 0.0), precision.error)


def stop_runs(name: str, folder: Path, jobs: int) -> list[tuple[str, Reached]]:
    """Both precisions; the truth is the mean of the longer runs, each by its time."""
    study = STUDIES[name]
    swept = {}
    for asked in ERRORS:
        plan = sweep_definition.plan(
            folder / f"{study.scene}-{asked}",
            study.scene,
            study.fields,
            {"seed": list(range(1, RUNS + 1))},
            repeats=1,
        )
        done = sweep_until(plan, [f"{study.quantity}={asked}"], jobs, longest=1e6)
        if done.failures or done.missed:
            raise SystemExit(f"{done.failures} {done.missed}")
        points = done.table.points
        stored = sweep_definition.read(plan.directory).runs
        by_name = {run.folder.name: run.scene.duration for run in stored}
        estimates = [point.estimates[study.quantity] for point in points]
        swept[asked] = estimates, np.array([by_name[point.runs[0]] for point in points])
    estimates, lengths = swept["1%"]
    truth = mean_by_length(np.array([each.number for each in estimates]), lengths)
    return [
        (asked, Reached(*swept[asked], truth, Precision.of_text(f"x={asked}").error))
        for asked in ERRORS
    ]


def mean_by_length(values: Array, lengths: Array) -> Estimate:
    """Mean over all the time that was run; what any rule of stopping leaves unbiased."""
    weights = lengths / lengths.sum()
    mean = float(values @ weights)
    scatter = float(weights**2 @ (values - mean) ** 2)
    return Estimate(mean, math.sqrt(scatter * len(values) / (len(values) - 1)))


COLUMNS = (
    *("quantity", "asked", "error told", "true error", "bias in true errors", "95 % hold"),
    *("mean length", "over a fixed run's"),
)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0] if __doc__ else None)
    parser.add_argument("--out", type=Path, required=True, help="folder of the runs")
    parser.add_argument("--page", type=Path, help="Markdown page whose table is renewed")
    parser.add_argument("--jobs", type=int, default=available_cores())
    options = parser.parse_args()
    rows: list[tuple[str, ...]] = []
    for row in measured(options.out, options.jobs):
        rows.append(row)
        print(row, flush=True)
        if options.page:  # as far as it is
            replace_block(options.page, "table", table(COLUMNS, rows))


def measured(folder: Path, jobs: int) -> Iterator[tuple[str, ...]]:
    """The rows of the table: series first, which take minutes."""
    for name in SYNTHETIC:
        for asked in ERRORS:
            yield stop_series(name, asked).row(f"{name}, {SERIES} series", asked)
    for name in STUDIES:
        for asked, reached in stop_runs(name, folder, jobs):
            yield reached.row(f"{name}, {RUNS} runs", asked)


if __name__ == "__main__":
    main()

"""The table of a sweep: one row a point, every number with its error (docs/sweep.md)."""

import csv
import io
import json
import math
import signal
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from analysis.analyze import SUMMARY, analyze, estimates, is_analysed
from analysis.estimate import Estimate, mean_of_repeats
from run_files import RunDirectoryError
from run_files.progress import is_begun, read_progress
from run_files.reading import read_json
from run_files.sweep_file import SweptRun, read_sweep
from run_files.writing import replace_text

if TYPE_CHECKING:
    import pandas  # which nobody needs: its own people have it

Row = dict[str, Any]


@dataclass(frozen=True)
class Point:
    """One combination of the swept fields.

    Attributes:
        fields: the swept ones, and whatever else differs.
        runs: names of the run directories of its finished repeats.
        estimates: means over them by quantity.
    """

    fields: Mapping[str, Any]
    runs: Sequence[str]
    estimates: Mapping[str, Estimate]

    def row(self, quantities: Sequence[str]) -> Row:
        """Its row of the table."""
        row: Row = {**self.fields, "repeats": len(self.runs)}
        notes = []
        for quantity in quantities:
            estimate = self.estimates.get(quantity, Estimate(None, None))
            row |= {quantity: estimate.value, f"{quantity}_error": estimate.error}
            if estimate.reason:
                notes.append(f"{quantity}: {estimate.reason}")
        return row | {"notes": "; ".join(notes)}


@dataclass(frozen=True)
class SweepTable:
    """What a sweep found.

    Attributes:
        points: those with finished runs, in the order of their fields.
        rows: one a point: swept fields, `repeats`, and `NAME`, `NAME_error` of every estimate,
            `notes`; as in table.csv.
        finished: runs in it.
        runs: runs of the sweep.
        problems: one line for each finished run that could not be analysed.
        fields: columns that tell points apart, the swept fields first.
        quantities: columns with a number of the analysis; `NAME_error` is its error.

    >>> point = Point({"gravity": 0.1}, ["seed=1"], {"speed": Estimate(0.03, 0.001)})
    >>> table = SweepTable([point], [point.row(["speed"])], finished=1, runs=1, problems=[])
    >>> table["speed"]
    array([0.03])
    >>> print(table)
    1 points from 1 of 1 runs; columns: gravity, repeats, speed, speed_error, notes
    """

    points: list[Point]
    rows: list[Row]
    finished: int
    runs: int
    problems: list[str]
    fields: tuple[str, ...] = ()
    quantities: tuple[str, ...] = ()

    def __getitem__(self, column: str) -> NDArray[Any]:
        """A column, (points,): numbers, NaN where the runs tell none; else objects.

        Raises:
            KeyError: for an unknown column, naming those there are.
        """
        if self.rows and column not in self.rows[0]:
            raise KeyError(f"{column}: there is {', '.join(self.rows[0])}")
        values = [row[column] for row in self.rows]
        if all(value is None or isinstance(value, int | float) for value in values):
            return np.array([math.nan if value is None else value for value in values])
        return np.array(values, dtype=object)

    def __str__(self) -> str:
        """How much there is, and the names of the columns."""
        columns = ", ".join(self.rows[0]) if self.rows else "none"
        counted = f"{len(self.points)} points from {self.finished} of {self.runs} runs"
        return f"{counted}; columns: {columns}"

    def dataframe(self) -> "pandas.DataFrame":
        """The table as a pandas DataFrame, where pandas is installed.

        Raises:
            ImportError: where it is not.
        """
        import pandas

        return pandas.DataFrame(self.rows)


def tabulate(
    directory: str | Path,
    jobs: int,
    renew: bool = True,
    report: Callable[[int, int], None] | None = None,
) -> SweepTable:
    """Analyse the finished runs of a sweep and write its table.csv.

    Args:
        directory: of the sweep.
        jobs: processes that analyse.
        renew: analyse again what was analysed since it finished.
        report: called with the runs analysed and the runs to analyse.

    Raises:
        RunDirectoryError: when it is no sweep.
        OSError: when the table cannot be written.
    """
    directory = Path(directory)
    sweep = read_sweep(directory)
    runs = sweep.runs
    finished, problems = [], {}
    for name, run in runs.items():
        try:
            if _finished(directory / name, run):
                finished.append(name)
        except RunDirectoryError as error:  # one damaged run does not stop the others
            problems[directory / name] = str(error)
    stale = [name for name in finished if renew or not is_analysed(directory / name)]
    problems |= _analyse([directory / name for name in stale], jobs, report)
    summaries = {
        name: _read_estimates(directory / name / SUMMARY)
        for name in finished
        if directory / name not in problems
    }
    columns = _columns(sweep.over, [run.fields for run in runs.values()])
    points = _points(columns, {name: runs[name].fields for name in summaries}, summaries)
    quantities = tuple(dict.fromkeys(name for found in summaries.values() for name in found))
    rows = [point.row(quantities) for point in points]
    _write(directory / "table.csv", rows)
    return SweepTable(
        points,
        rows,
        len(summaries),
        len(runs),
        list(problems.values()),
        tuple(columns),
        quantities,
    )


def _read_estimates(path: Path) -> dict[str, Estimate]:
    return {name: Estimate.of_json(entry) for name, entry in estimates(read_json(path)).items()}


def _finished(path: Path, run: SweptRun) -> bool:
    """Whether the run has all the steps that the sweep wants of it."""
    return is_begun(path) and read_progress(path).step >= run.total_steps


def _analyse(
    paths: Sequence[Path], jobs: int, report: Callable[[int, int], None] | None
) -> dict[Path, str]:
    """Write the summaries; what went wrong, by path."""
    problems: dict[Path, str] = {}
    for done, (path, error) in enumerate(_analysed(paths, min(jobs, len(paths))), start=1):
        if isinstance(error, RunDirectoryError | OSError):
            problems[path] = str(error)
        elif error is not None:
            raise error
        if report:
            report(done, len(paths))
    return problems


def _analysed(paths: Sequence[Path], jobs: int) -> Iterator[tuple[Path, BaseException | None]]:
    """Each path once its run is analysed, and the error of that."""
    if jobs <= 1:
        for path in paths:
            yield path, _error_of(path)
        return
    # spawned, because MPI may be initialised here
    with ProcessPoolExecutor(jobs, get_context("spawn")) as pool:
        with _ctrl_c_held(), main_program_hidden():
            tasks: dict[Future[Any], Path] = {pool.submit(analyze, path): path for path in paths}
        try:
            for task in as_completed(tasks):
                yield tasks[task], task.exception()
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def _error_of(path: Path) -> Exception | None:
    try:
        analyze(path)
    except Exception as error:
        return error
    return None


@contextmanager
def main_program_hidden() -> Iterator[None]:
    """Processes started in here do not run the user's script again to find its functions."""
    main = sys.modules["__main__"]
    hidden: dict[str, Any] = {"__spec__": main.__spec__}
    if hasattr(main, "__file__"):
        hidden["__file__"] = vars(main).pop("__file__")
    main.__spec__ = None
    try:
        yield
    finally:
        vars(main).update(hidden)


@contextmanager
def _ctrl_c_held() -> Iterator[None]:
    """Processes started in here never see Ctrl-C: this one handles it for them, afterwards."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _columns(over: Sequence[str], fields: Sequence[Mapping[str, Any]]) -> list[str]:
    """The swept fields, and whatever else differs, as after the sweep was extended."""
    names = dict.fromkeys([*over, *(name for one in fields for name in one if name != "seed")])
    differing = (name for name in names if len({json.dumps(one.get(name)) for one in fields}) > 1)
    return list(dict.fromkeys([*over, *differing]))


def _points(
    columns: Sequence[str],
    fields: Mapping[str, Mapping[str, Any]],
    summaries: Mapping[str, Mapping[str, Estimate]],
) -> list[Point]:
    runs: dict[tuple[Any, ...], list[str]] = {}
    for name in summaries:
        runs.setdefault(tuple(fields[name].get(column) for column in columns), []).append(name)
    return [
        Point(
            dict(zip(columns, values, strict=True)),
            runs[values],
            _means([summaries[name] for name in runs[values]]),
        )
        for values in sorted(runs, key=_order)
    ]


def _means(repeats: Sequence[Mapping[str, Estimate]]) -> dict[str, Estimate]:
    """Of every quantity, over the repeats that tell it."""
    quantities = dict.fromkeys(name for found in repeats for name in found)
    return {
        quantity: mean_of_repeats([found[quantity] for found in repeats if quantity in found])
        for quantity in quantities
    }


def _order(point: tuple[Any, ...]) -> list[tuple[bool, float, str]]:
    """Numbers by size, before words."""
    return [
        (False, float(value), "") if isinstance(value, int | float) else (True, 0.0, str(value))
        for value in point
    ]


def _write(path: Path, rows: Sequence[Row]) -> None:
    text = io.StringIO()
    if rows:
        writer = csv.DictWriter(text, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)
    replace_text(path, text.getvalue())

"""A trajectory of anybody's, by all three estimators: what `narrows diffusivity` calls."""

import csv
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import MDAnalysis
import numpy as np
from matplotlib.figure import Figure

from analysis.arrays import Array
from analysis.diffusivity.bayes import BayesianDiffusivity
from analysis.diffusivity.color import ColorDiffusivity
from analysis.diffusivity.coordinates import AlongAxis
from analysis.diffusivity.displacement import MiddleDiffusivity
from analysis.diffusivity.errors import DiffusivityError
from analysis.diffusivity.first_passage import FirstPassageDiffusivity

BINS = 20  # of the likelihood
ESTIMATORS = ("color", "bayes", "first-passage")
QUANTILE = 0.05  # of positions beyond which particles react, where no surfaces are given


@dataclass(frozen=True)
class Estimated:
    """A profile.

    Attributes:
        estimator: its name.
        positions, diffusivity, error: of equal length.
        remark: what a reader should know of it, one line.
    """

    estimator: str
    positions: Array
    diffusivity: Array
    error: Array
    remark: str


def open_trajectory(
    trajectory: Path, topology: Path | None, select: str, dt: float | None = None
) -> Any:
    """The selected atoms of files that MDAnalysis reads.

    Args:
        dt: time between two frames, where the file does not tell it (then it would be 1).

    Raises:
        DiffusivityError: when a file is missing or cannot be read, or nothing is selected.
    """
    if dt is not None and not 0 < dt < np.inf:
        raise DiffusivityError(f"dt = {dt:g}: must be positive")
    files = [file for file in (topology, trajectory) if file]
    for file in files:
        if not file.is_file():
            raise DiffusivityError(f"{file}: no such file")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            universe = MDAnalysis.Universe(*map(str, files))
            if dt is not None:
                universe = _timed(files, dt)
    except Exception as error:  # each of its readers has errors of its own
        reason = " ".join(str(error).split())[:200]
        raise DiffusivityError(f"{trajectory}: MDAnalysis cannot read it: {reason}") from None
    try:
        atoms = universe.select_atoms(select)
    except Exception as error:
        reason = " ".join(str(error).split())[:200]
        raise DiffusivityError(f"select = {select!r}: {reason}") from None
    if len(atoms) == 0:
        raise DiffusivityError(f"select = {select!r}: no atom of {len(universe.atoms)}")
    return atoms


def _timed(files: list[Path], dt: float) -> Any:
    """With that time between two frames: of LAMMPS's, MDAnalysis takes `dt` for that of a step."""
    names = [str(file) for file in files]
    frames = MDAnalysis.Universe(*names, dt=1.0).trajectory
    spacing = frames[1].time - frames[0].time if len(frames) > 1 else 1.0
    return MDAnalysis.Universe(*names, dt=dt / spacing if spacing > 0 else dt)


def reach_of(atoms: Any, axis: str, start: int = 0) -> tuple[float, float, float, float]:
    """Least and greatest position along an axis, and two surfaces a little within.

    Raises:
        DiffusivityError: when the particles do not move along it.
    """
    coordinate = AlongAxis(atoms, axis)
    trajectory = coordinate.trajectory
    if len(trajectory) - start < 2:
        raise DiffusivityError(f"{len(trajectory) - start} frames; at least 2 are needed")
    frames = np.unique(np.linspace(start, len(trajectory) - 1, 200).astype(int))
    seen = []
    for frame in frames:
        trajectory[int(frame)]
        seen.append(coordinate.values())
    values = np.concatenate(seen)
    if not np.isfinite(values).all():
        raise DiffusivityError(f"axis = {axis!r}: positions that are not finite")
    least, most = float(values.min()), float(values.max())
    if not most - least > 1e-6 * max(1.0, abs(most)):
        raise DiffusivityError(f"axis = {axis!r}: all particles stay at {least:g}")
    low, high = np.quantile(values, [QUANTILE, 1 - QUANTILE])
    return least, most, float(low), float(high)


def estimate_all(
    atoms: Any,
    axis: str,
    low: float | None = None,
    high: float | None = None,
    estimators: tuple[str, ...] = ESTIMATORS,
    start: int = 0,
    bins: int = BINS,
) -> tuple[list[Estimated], list[str]]:
    """D along an axis by each estimator; and one line for each that the data do not suffice for.

    Args:
        low, high: the two surfaces of colours and first passage; by default beyond either lies a
            twentieth of the particles.
        start: first frame.
        bins: of the likelihood, fewer for few particles.

    Raises:
        DiffusivityError: for unusable parameters, or when no estimator has enough data.
    """
    for name in estimators:
        if name not in ESTIMATORS:
            raise DiffusivityError(f"estimator = {name!r}: must be one of {', '.join(ESTIMATORS)}")
    least, most, inner_low, inner_high = reach_of(atoms, axis, start)
    low = inner_low if low is None else low
    high = inner_high if high is None else high
    if not least < low < high < most:
        raise DiffusivityError(
            f"low = {low:g}, high = {high:g}: must be increasing, and within the positions, "
            f"{least:g} to {most:g}"
        )
    coordinate = AlongAxis(atoms, axis)
    found, missing = list[Estimated](), list[str]()
    for name in estimators:
        try:
            found.append(_estimate(name, coordinate, (least, most), (low, high), start, bins))
        except DiffusivityError as error:
            missing.append(f"{name}: {error}")
    if not found:
        raise DiffusivityError("\n".join(missing))
    return found, missing


def _estimate(
    name: str,
    coordinate: AlongAxis,
    ends: tuple[float, float],
    surfaces: tuple[float, float],
    start: int,
    bins: int,
) -> Estimated:
    if name == "bayes":
        frames = len(coordinate.trajectory) - start
        lags = [lag for lag in (1, 2, 4, 8, 16, 32) if lag <= max(1, frames // 10)]
        analysis = BayesianDiffusivity(coordinate, *ends, bins=bins, lags=lags, samples=0)
        results = analysis.run(start).results
        remark = f"lag {results.lag:g}, of {', '.join(f'{lag:g}' for lag in results.lags)}"
    elif name == "color":
        results = ColorDiffusivity(coordinate, *surfaces).run(start).results
        lower, upper = results.rate
        remark = f"reactions per time at the surfaces: {lower:.4g} and {upper:.4g}"
    else:
        results = FirstPassageDiffusivity(coordinate, *surfaces).run(start).results
        remark = f"at least {int(results.trips.min())} round trips to a level"
    known = np.isfinite(results.diffusivity) & np.isfinite(results.error)
    return Estimated(
        name,
        results.positions[known],
        results.diffusivity[known],
        results.error[known],
        remark,
    )


def in_the_middle(atoms: Any, axis: str) -> str:
    """D by displacements that begin in the middle, one line; or why there is none."""
    least, most, *_ = reach_of(atoms, axis)
    try:
        found = MiddleDiffusivity(AlongAxis(atoms, axis), least, most).run().results
    except DiffusivityError as error:
        return f"none: {error}"
    first, last = found.window
    return f"D = {found.diffusivity:.4g} +- {found.error:.2g}, lags {first:g} to {last:g}"


def write(found: list[Estimated], axis: str, out: Path) -> list[Path]:
    """diffusivity.csv and diffusivity.png in a folder; their paths.

    Raises:
        OSError: when they cannot be written.
    """
    out.mkdir(parents=True, exist_ok=True)
    table, picture = out / "diffusivity.csv", out / "diffusivity.png"
    with table.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(("estimator", axis, "diffusivity", "error"))
        for each in found:
            rows = zip(each.positions, each.diffusivity, each.error, strict=True)
            writer.writerows((each.estimator, *row) for row in rows)
    drawing(found, axis).savefig(picture, dpi=150)
    return [table, picture]


def drawing(found: list[Estimated], axis: str) -> Figure:
    """The profiles with their errors."""
    figure = Figure(figsize=(7, 4.5), layout="constrained")
    axes = figure.subplots()
    for each in found:
        bar = axes.errorbar(
            each.positions, each.diffusivity, each.error, label=each.estimator, elinewidth=0.7
        )
        bar[0].set_markersize(3)
    middle = np.concatenate([each.diffusivity for each in found])
    axes.set(
        xlabel=f"${axis}$",
        ylabel="diffusivity $D$ [length$^2$/time]",
        ylim=(0, 1.5 * float(np.quantile(middle, 0.95))),
    )
    axes.legend()
    return figure

"""Runs and sweeps that go on until their quantities are known precisely enough.

A run is a finished one of its scene's duration at each look; it is made longer by resuming it, so
its directory holds what an uninterrupted run of that duration would, and nothing else. Where it is
killed, the same call goes on.
"""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from analysis import Estimate, SweepTable, tabulate
from analysis.analyze import estimates, summary_of
from analysis.measures import may_find, quantities
from analysis.precision import Precision, growth
from lammps_inputs import Scene, SceneError
from run_files import RunDirectoryError
from srd_driver import RunError, Simulation, sweep_definition
from srd_driver.parallel import agree, communicator
from srd_driver.resume import stored_fields, tells_scene
from srd_driver.sweep import Advance, Failure, run_all
from srd_driver.sweep_definition import Sweep

LONGEST = 100  # times the scene's duration, where no longest is given


@dataclass(frozen=True)
class Look:
    """What a run tells at one of its looks.

    Attributes:
        duration: time after the equilibration [t0].
        estimates: the quantities asked for.
        next_duration: of the next look; None where it is the last [t0].
    """

    duration: float
    estimates: Mapping[str, Estimate]
    next_duration: float | None


def precisions_of(texts: Iterable[str], scene: Scene) -> list[Precision]:
    """The precisions that a scene's runs can be held to, as `settling_speed=2%`.

    Raises:
        SceneError: for another form, or a quantity that no measure of the scene finds.
    """
    asked, problems = [], []
    measures = scene.system.measures
    for text in texts:
        try:
            precision = Precision.of_text(text)
        except ValueError as error:
            problems.append(f"until = {error}")
            continue
        asked.append(precision)
        if not may_find(measures, precision.quantity):
            known = ", ".join(quantities(measures))
            problems.append(
                f"until = {text!r}: {scene.name} does not tell {precision.quantity}; must be one "
                f"of {known}"
            )
    if problems:
        raise SceneError(problems)
    return asked


def run_until(
    scene: Scene,
    until: Sequence[str],
    directory: str | Path,
    engine: str | None = None,
    longest: float | None = None,
    resume: bool = False,
    checkpoint_interval: float = 20.0,
    finish: Callable[[Simulation], Any] = Simulation.finish,
    report: Callable[[Look], Any] | None = None,
) -> dict[str, Estimate]:
    """Run a scene until its quantities are known to these precisions.

        run_until(make_scene("channel"), ["settling_speed=2%"], "runs/precise")

    Args:
        scene: its `duration` is the first look [t0].
        until: quantities of summary.json and their standard errors, absolute or relative.
        directory, engine, resume, checkpoint_interval: as for `Simulation`.
        longest: duration at which it ends in any case [t0]; default: 100 times the first.
        finish: runs a simulation to its end.
        report: called at each look.

    Returns:
        the quantities.

    Raises:
        SceneError: for a wrong precision, or a scene that the engine cannot run.
        RunError: when it stops, or `longest` is reached first; `resume` goes on then.
        RunDirectoryError: when the run cannot be analysed.
    """
    precisions = precisions_of(until, scene)
    longest = _longest(longest, scene.duration)
    directory = Path(directory)
    while True:
        with Simulation(scene, engine, directory, resume, checkpoint_interval) as simulation:
            finish(simulation)
            if not simulation.finished:
                raise KeyboardInterrupt("give the same command with --resume to go on")
        look = agree(communicator(), partial(_look, directory, precisions, scene.duration, longest))
        if report:
            report(look)
        if look.next_duration is None:
            _require(precisions, look.estimates, longest)
            return dict(look.estimates)
        scene, resume = scene.lasting(look.next_duration), True


def _longest(longest: float | None, duration: float) -> float:
    if longest is None:
        return LONGEST * duration
    if not longest >= duration:
        raise SceneError.of_field(
            "longest", longest, f"must be at least the duration, {duration:g} t0"
        )
    return longest


def _look(
    directory: Path, precisions: Sequence[Precision], duration: float, longest: float
) -> Look:
    found = {
        name: Estimate.of_json(entry) for name, entry in estimates(summary_of(directory)).items()
    }
    try:
        factor = growth(precisions, found)
    except ValueError as error:
        raise RunDirectoryError(f"{directory}: {error}") from None
    asked = {precision.quantity: found[precision.quantity] for precision in precisions}
    return Look(duration, asked, _longer(duration, factor, longest))


def _longer(duration: float, factor: float, longest: float) -> float | None:
    """A duration of three digits; None for no longer one."""
    if factor == 1 or duration >= longest:
        return None
    unit: float = 10.0 ** (math.floor(math.log10(duration * factor)) - 2)
    return min(math.ceil(duration * factor / unit) * unit, longest)


def _require(
    precisions: Sequence[Precision], found: Mapping[str, Estimate], longest: float
) -> None:
    missed = [each for each in precisions if not each.is_met(found[each.quantity])]
    if missed:
        told = "; ".join(each.told(found[each.quantity]) for each in missed)
        raise RunError(
            f"after {longest:g} t0, the longest time, {told}; go on by --resume and a longer "
            "--longest"
        )


@dataclass(frozen=True)
class SweptUntil:
    """What came of a sweep: its table, the runs that stopped, the points that are not precise."""

    table: SweepTable
    failures: list[Failure]
    missed: list[str]


def sweep_until(
    asked: Sweep,
    until: Sequence[str],
    jobs: int,
    longest: float | None = None,
    report: Callable[[Advance], None] | None = None,
    report_analysis: Callable[[int, int], None] | None = None,
) -> SweptUntil:
    """Run a sweep until the mean of the repeats at every point is known to these precisions.

    All points are run for their scene's duration; then those that are not precise are made longer
    by what their own error asks for, all repeats alike, and so on: time goes where it is needed.

    Args:
        asked: as `sweep_definition.plan` made it; what its directory has already counts.
        until, longest: as for `run_until`.
        jobs: runs at a time.
        report: called while runs are under way.
        report_analysis: called with the runs analysed and those to analyse.

    Raises:
        SceneError: for a wrong precision.
        RunError: before anything runs, when the directory holds something else.
    """
    precisions = precisions_of(until, asked.runs[0].scene)
    most = {run.folder.name: _longest(longest, run.scene.duration) for run in asked.runs}
    asked = sweep_definition.with_durations(asked, _stored_durations(asked))
    while True:
        sweep_definition.store(asked)
        by_work = sorted(asked.runs, key=lambda run: -run.scene.system.work)
        failures = run_all(by_work, jobs, report)
        table = tabulate(asked.directory, jobs, renew=False, report=report_analysis)
        durations = {run.folder.name: run.scene.duration for run in asked.runs}
        failed = {failure.run.folder.name for failure in failures}
        longer: dict[str, float] = {}
        missed = []
        for point in table.points:
            runs = [name for name in point.runs if name in durations]
            if not runs or failed.intersection(runs):
                continue
            try:
                factor = growth(precisions, point.estimates)
            except ValueError as error:
                raise RunError(f"{asked.directory / runs[0]}: {error}") from None
            of_point = {name: _longer(durations[name], factor, most[name]) for name in runs}
            longer |= {name: duration for name, duration in of_point.items() if duration}
            if factor > 1 and not any(of_point.values()):
                missed.append(_missed(point.fields, precisions, point.estimates))
        if not longer:
            return SweptUntil(table, failures, missed)
        asked = sweep_definition.with_durations(asked, longer)


def _stored_durations(asked: Sweep) -> dict[str, float]:
    """Of the runs that are longer already than they are planned."""
    durations = {}
    for run in asked.runs:
        if tells_scene(run.folder):
            stored = float(stored_fields(run.folder)["duration"])
            if stored > run.scene.duration:
                durations[run.folder.name] = stored
    return durations


def _missed(
    fields: Mapping[str, Any], precisions: Sequence[Precision], found: Mapping[str, Estimate]
) -> str:
    point = ",".join(f"{name}={value}" for name, value in fields.items())
    told = [
        each.told(found[each.quantity])
        for each in precisions
        if not each.is_met(found[each.quantity])
    ]
    return f"{point or 'every point'}: {'; '.join(told)}"

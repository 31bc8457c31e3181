"""What a sweep consists of: its points, their seeds, and `sweep.json`, which keeps them.

A point is one combination of the swept fields; its repeats differ by the seed alone.
"""

import contextlib
import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from lammps_inputs import SceneError, engine_named, make_scene
from lammps_inputs.engines import DEFAULT, default_engine
from run_files import RunDirectoryError
from run_files.sweep_file import NAME, SweepFile, SweptRun, is_sweep, read_sweep, write_sweep
from srd_driver.engines import require_engine
from srd_driver.errors import RunError
from srd_driver.sweep import Run, is_finished

MOST_RUNS = 100_000  # what one sweep.json holds, and a file system in one folder


@dataclass(frozen=True)
class Sweep:
    """The runs of a sweep; `over` names the swept fields."""

    directory: Path
    scene: str
    engine: str
    over: tuple[str, ...]
    runs: tuple[Run, ...]


def plan(
    directory: Path,
    scene: str,
    fields: Mapping[str, Any],
    over: Mapping[str, Sequence[Any]],
    repeats: int,
    engine: str | None = None,
) -> Sweep:
    """The product of the lists of `over`, each point with the seeds seed, seed + 1, ...

    Args:
        fields: of the scene, for all points.
        over: the values of each swept field.
        repeats: runs of each point, R.
        engine: of all runs; default: that of the first point.

    Raises:
        SceneError: naming each bad point, its field, value and what is allowed.
        RunError: when the engine is not installed.
    """
    if "seed" in over and repeats > 1:
        raise SceneError.of_field("repeats", repeats, "must be 1 where the seed is swept")
    count = math.prod(len(values) for values in over.values()) * repeats
    if count > MOST_RUNS:
        raise SceneError([f"{count:.3g} runs: a sweep has at most {MOST_RUNS}"])
    runs: dict[str, Run] = {}
    problems: dict[str, list[str]] = {}
    for values in itertools.product(*over.values()):
        point = dict(zip(over, values, strict=True))
        label = _label(point)
        try:
            first = make_scene(scene, **{**fields, **point})
            for repeat in range(repeats):
                run_scene = make_scene(
                    scene, **(first.model_dump() | {"seed": first.seed + repeat})
                )
                engine = engine or default_engine(run_scene.system)
                require_engine(run_scene, engine)
                names = [*over, "seed"] if "seed" not in over else over
                name = _label({field: getattr(run_scene, field) for field in names})
                if name in runs:
                    raise SceneError(["given twice"])
                runs[name] = Run(directory / name, run_scene, engine)
        except SceneError as error:
            for problem in error.problems:
                problems.setdefault(problem, []).append(label)
    if problems:
        raise SceneError(f"{_points(labels)}: {text}" for text, labels in problems.items())
    return Sweep(directory, scene, engine or DEFAULT, tuple(over), tuple(runs.values()))


def with_durations(sweep: Sweep, durations: Mapping[str, float]) -> Sweep:
    """The sweep with other durations of the runs of these names [t0].

    Raises:
        SceneError: for a duration that the scene refuses.
    """
    runs = (
        replace(run, scene=run.scene.lasting(durations[run.folder.name]))
        if run.folder.name in durations
        else run
        for run in sweep.runs
    )
    return replace(sweep, runs=tuple(runs))


def store(sweep: Sweep) -> Sweep:
    """Write the sweep to its directory; one that is there already is extended.

    Returns:
        the sweep of the directory, all its points.

    Raises:
        RunError: when the directory holds something else, or a run directory of this sweep's
            holds another scene; nothing is written then.
    """
    directory = sweep.directory
    for run in sweep.runs:
        with contextlib.suppress(RunDirectoryError):  # told when it is its turn
            is_finished(run)
    if is_sweep(directory):
        before = read(directory)
        if (before.scene, before.engine) != (sweep.scene, sweep.engine):
            raise RunError(
                f"{directory} holds a sweep of {before.scene} by the engine {before.engine}, "
                f"not of {sweep.scene} by {sweep.engine}: choose another folder"
            )
        over = tuple(dict.fromkeys(before.over + sweep.over))
        runs = {run.folder: run for run in before.runs + sweep.runs}
        sweep = Sweep(directory, sweep.scene, sweep.engine, over, tuple(runs.values()))
    elif directory.is_dir() and any(directory.iterdir()):
        raise RunError(f"{directory} is not empty and holds no sweep: choose another folder")
    directory.mkdir(parents=True, exist_ok=True)
    runs_of_file = {
        run.folder.name: SweptRun(
            fields=run.scene.model_dump(mode="json"),
            total_steps=run.scene.system.clock.total_steps,
        )
        for run in sweep.runs
    }
    write_sweep(
        directory,
        SweepFile(scene=sweep.scene, engine=sweep.engine, over=sweep.over, runs=runs_of_file),
    )
    return sweep


def read(directory: Path) -> Sweep:
    """The sweep of a directory.

    Raises:
        RunDirectoryError: when it holds none, or a damaged one.
        RunError: when its scene or engine is none of this version.
    """
    content = read_sweep(directory)
    try:
        engine_named(content.engine)
        runs = tuple(
            Run(directory / name, make_scene(content.scene, **run.fields), content.engine)
            for name, run in content.runs.items()
        )
    except (SceneError, TypeError) as error:
        raise RunError(f"{directory / NAME} is not that of a sweep: {error}") from None
    return Sweep(directory, content.scene, content.engine, content.over, runs)


def _label(point: Mapping[str, Any]) -> str:
    """`gravity=0.1,seed=2`: the name of a point, or of a run directory."""
    return ",".join(f"{field}={_text(value)}" for field, value in point.items())


def _text(value: Any) -> str:
    if value is None:
        return "none"
    return str(value).removesuffix(".0") if isinstance(value, float) else str(value)


def _points(labels: list[str]) -> str:
    first = f"point {labels[0]}" if labels[0] else "every point"
    return first if len(labels) == 1 else f"{first} and {len(labels) - 1} more"

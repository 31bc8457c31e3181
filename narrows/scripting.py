"""What scripts and notebooks call: scenes, sweeps and their tables (docs/python.md)."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from analysis import SweepTable, tabulate
from lammps_inputs import Scene, all_scenes
from lammps_inputs.scenes import make_scene as scene_named
from narrows.progress import progress_of_runs
from narrows.until import sweep_until
from srd_driver import RunError, sweep_definition
from srd_driver.sweep import available_cores, run_all


def make_scene(name: str, /, **fields: Any) -> Scene:
    return scene_named(name, **fields)


make_scene.__doc__ = "\n".join(
    [
        "The scene of that name, its other fields at their defaults.",
        "",
        "Raises:",
        "    SceneError: for an unknown name, or naming each wrong field, its value and what is",
        "        allowed.",
        *(f"\n{name}: {scene.__doc__}" for name, scene in all_scenes().items()),
    ]
)


def sweep(
    scene: str,
    over: Mapping[str, Sequence[Any]],
    directory: str | Path,
    repeats: int = 1,
    engine: str | None = None,
    jobs: int | None = None,
    until: Sequence[str] = (),
    **fields: Any,
) -> SweepTable:
    """Run a scene at all combinations of field values, and analyse it: as `narrows sweep`.

        found = sweep("channel", {"gravity": [0.1, 0.2]}, "runs/g", repeats=4, duration=200)
        plt.errorbar(found["gravity"], found["settling_speed"], found["settling_speed_error"])

    Called again it goes on, or extends the sweep by what is new.

    Args:
        scene: its name.
        over: the values of each swept field.
        directory: of the sweep, new or of this one.
        repeats: runs of each point, with the seeds seed, seed + 1, ...
        engine: of all runs; default: the first that can run the scene.
        jobs: runs at a time; default: the cores.
        until: how precisely every point is to be known, as `settling_speed=2%`
            (`narrows.until.sweep_until`).
        fields: of the scene, for all points.

    Raises:
        SceneError: naming each bad point, its field, value and what is allowed.
        RunError: when the directory holds something else, or runs failed: one line each.
    """
    asked = sweep_definition.plan(Path(directory), scene, fields, over, repeats, engine)
    jobs = jobs or available_cores()
    missed: list[str] = []
    with progress_of_runs() as (report_runs, report_analysis):
        if until:
            done = sweep_until(asked, until, jobs, None, report_runs, report_analysis)
            failures, found, missed = done.failures, done.table, done.missed
        else:
            asked = sweep_definition.store(asked)
            failures = run_all(asked.runs, jobs, report_runs)
            found = tabulate(asked.directory, jobs, renew=False, report=report_analysis)
    problems = [f"{each.run.folder.name}: {each.message}" for each in failures]
    problems += found.problems + missed
    if problems:
        raise RunError("\n".join(problems))
    return found


def table(directory: str | Path) -> SweepTable:
    """The table of a sweep, of the runs finished so far; what is not analysed yet, is.

        table("runs/g")["settling_speed"]    # an array, a number a point
        table("runs/g").dataframe()          # where pandas is installed

    Raises:
        RunDirectoryError: when the directory holds no sweep.
    """
    return tabulate(directory, available_cores(), renew=False)

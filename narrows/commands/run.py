"""`narrows run`: a scene to a run directory."""

from pathlib import Path
from typing import Annotated, Any

import typer

from lammps_inputs import Scene, SceneError
from lammps_inputs.deck import warnings
from lammps_inputs.engines import default_engine
from narrows.messages import say, user_errors, warn
from narrows.progress import finish_with_progress
from narrows.scene_options import (
    ENGINES,
    Longest,
    SceneFile,
    SceneName,
    Settings,
    Until,
    scene_of,
)
from run_files.manifest import read_manifest
from srd_driver import Simulation
from srd_driver.parallel import agree, communicator
from srd_driver.resume import is_half_made, stored_fields, tells_scene
from srd_driver.signals import stopped_by_signals


def run(
    scene: SceneName,
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="a new or empty folder")],
    file: SceneFile = None,
    settings: Settings = None,
    engine: Annotated[
        str | None,
        typer.Option(metavar=ENGINES, help="default: the first that can run the scene"),
    ] = None,
    resume: Annotated[bool, typer.Option("--resume", help="go on with the run in DIR")] = False,
    checkpoint_interval: Annotated[
        float, typer.Option(min=0.0, help="time between two checkpoints, in t0")
    ] = 20.0,
    until: Until = None,
    longest: Longest = None,
) -> None:
    """Run a scene into a run directory; alone or under mpirun."""
    with user_errors():
        stored, engine_before = agree(
            communicator(), lambda: _stored(out) if resume else ({}, None)
        )
        chosen = scene_of(scene, file, settings, stored)
        engine = engine or engine_before or default_engine(chosen.system)
        warn(warnings(chosen, engine))
        if until:
            _run_until(chosen, engine, out, resume, checkpoint_interval, until, longest)
            return
        if longest is not None:
            raise SceneError.of_field("longest", longest, "only with --until")
        with (
            Simulation(chosen, engine, out, resume, checkpoint_interval) as simulation,
            stopped_by_signals(simulation),
        ):
            if simulation.finished:
                say(f"{out}: finished before, at time {simulation.time:g}")
                return
            if simulation.step:
                say(f"{out}: going on from time {simulation.time:g}")
            elif resume:
                say(f"{out}: nothing to go on from, begins with a duration of {chosen.duration:g}")
            finish_with_progress(simulation)
            if not simulation.finished:
                raise KeyboardInterrupt("go on from the newest checkpoint by --resume")
            say(f"{out}: at time {simulation.time:g}; next: narrows analyze {out}")


def _run_until(
    scene: Scene,
    engine: str,
    out: Path,
    resume: bool,
    checkpoint_interval: float,
    until: list[str],
    longest: float | None,
) -> None:
    from narrows.until import Look, precisions_of, run_until  # here, so that `--help` stays fast

    asked = precisions_of(until, scene)

    def finish(simulation: Simulation) -> None:
        with stopped_by_signals(simulation):
            finish_with_progress(simulation)

    def report(look: Look) -> None:
        told = "; ".join(each.told(look.estimates[each.quantity]) for each in asked)
        further = f"; on to {look.next_duration:g} t0" if look.next_duration else ""
        say(f"{out}: after {look.duration:g} t0 {told}{further}")

    run_until(scene, until, out, engine, longest, resume, checkpoint_interval, finish, report)


def _stored(directory: Path) -> tuple[dict[str, Any], str | None]:
    """Fields and engine of the run to resume, if there is one."""
    if not directory.is_dir() or not any(directory.iterdir()):
        return {}, None
    if is_half_made(directory) and not tells_scene(directory):
        return {}, None
    return stored_fields(directory), read_manifest(directory).engine

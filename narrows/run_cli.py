"""`narrows deck` and `narrows run`: a scene to a LAMMPS deck, or to a run directory."""

import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import Annotated, Any, Literal

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

import lammps_plugin
from lammps_inputs import SCENES, Scene, SceneError, make_scene, parse_assignment, read_scene
from lammps_inputs.deck import DEFAULT_ENGINE, Engine, write_deck
from lammps_inputs.limits import warnings
from narrows.messages import say, user_errors, warn
from srd_driver import RunError, Simulation
from srd_driver.parallel import agree, communicator
from srd_driver.run_directory import is_half_made, stored_engine, stored_fields

SceneName = Annotated[str, typer.Argument(metavar="SCENE", help=" or ".join(SCENES))]
SceneFile = Annotated[
    Path | None, typer.Option("--scene", metavar="FILE.toml", help="fields of the scene")
]
Settings = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="FIELD=VALUE", help="one field; wins over the file"),
]
Out = Annotated[Path, typer.Option("--out", metavar="DIR", help="a new or empty folder")]


def deck(
    scene: SceneName,
    out: Out,
    file: SceneFile = None,
    settings: Settings = None,
    engine: Annotated[Literal["srd", "mpc"], typer.Option(help="solvent of the deck")] = "mpc",
) -> None:
    """Write a folder that runs with `lmp -in in.lammps`, for fix srd or fix mpc."""
    with user_errors():
        chosen = _scene(scene, {}, file, settings)
        warn(warnings(chosen, engine))
        out.mkdir(parents=True, exist_ok=True)
        if any(out.iterdir()):
            raise RunError(f"{out} is not empty: choose another folder")
        write_deck(chosen, out, engine)
        say(f"{out}: run it there with  lmp -in in.lammps  or  mpirun -np 2 lmp -in in.lammps")
        if engine == "mpc" and not lammps_plugin.folder():
            say("lmp needs fix mpc, which was not built here: see narrows run, or use --engine srd")


def run(
    scene: SceneName,
    out: Out,
    file: SceneFile = None,
    settings: Settings = None,
    engine: Annotated[
        Engine | None, typer.Option(help="default: mpc, or that of the resumed run")
    ] = None,
    resume: Annotated[bool, typer.Option("--resume", help="go on with the run in DIR")] = False,
    checkpoint_interval: Annotated[
        float, typer.Option(min=0.0, help="time between two checkpoints [t0]")
    ] = 20.0,
) -> None:
    """Run a scene into a run directory; alone or under mpirun."""
    with user_errors():
        stored, engine_before = agree(
            communicator(), lambda: _stored(out) if resume else ({}, None)
        )
        chosen = _scene(scene, stored, file, settings)
        engine = engine or engine_before or DEFAULT_ENGINE
        warn(warnings(chosen, engine))
        with (
            Simulation(chosen, engine, out, resume, checkpoint_interval) as simulation,
            _stopped_by_signals(simulation),
        ):
            if simulation.finished:
                say(f"{out}: finished before, at time {simulation.time:g}")
                return
            if simulation.step:
                say(f"{out}: going on from time {simulation.time:g}")
            if simulation.rank == 0 and sys.stderr.isatty():
                _finish_with_progress_bar(simulation)
            else:
                simulation.finish()
            if not simulation.finished:
                raise KeyboardInterrupt
            say(f"{out}: at time {simulation.time:g}; next: narrows analyze {out}")


@contextmanager
def _stopped_by_signals(simulation: Simulation) -> Iterator[None]:
    """Ctrl-C, or a queueing system's SIGTERM: a checkpoint, then the end; a second one: at once."""

    def stop(number: int, _: FrameType | None) -> None:
        signal.signal(number, before[number])
        simulation.stop()

    numbers: tuple[int, ...] = (signal.SIGINT, signal.SIGTERM)
    before = {number: signal.signal(number, stop) for number in numbers}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _stored(directory: Path) -> tuple[dict[str, Any], Engine | None]:
    """Fields and engine of the run to resume, if there is one."""
    if not directory.is_dir() or not any(directory.iterdir()) or is_half_made(directory):
        return {}, None
    return stored_fields(directory), stored_engine(directory)


def _scene(
    name: str, stored: dict[str, Any], file: Path | None, settings: list[str] | None
) -> Scene:
    return make_scene(name, **scene_fields(name, stored, file, settings))


def scene_fields(
    name: str, stored: dict[str, Any], file: Path | None, settings: list[str] | None
) -> dict[str, Any]:
    """The stored fields, those of the file and the settings, the later ones winning."""
    fields = stored | (read_scene(file) if file else {})
    fields |= dict(parse_assignment(text) for text in settings or [])
    if fields.get("scene", name) != name:
        raise SceneError([f"scene = {fields['scene']!r}: the command line says {name!r}"])
    return {field: fields[field] for field in fields if field != "scene"}


def _finish_with_progress_bar(simulation: Simulation) -> None:
    """Run to the end, showing rate, remaining time and the settling speed since the start."""
    scene = simulation.scene
    begin = simulation.time
    position = simulation.mean_colloid_position() if scene.colloids else 0.0
    with Progress(
        TextColumn(scene.name),
        BarColumn(),
        TextColumn("{task.completed:.0f} of {task.total:.0f} t0"),
        TextColumn("{task.description}"),
        TimeRemainingColumn(),
        console=Console(stderr=True),
    ) as progress:
        end = scene.collisions * scene.collision_time
        task = progress.add_task("", total=end)

        def report(now: Simulation) -> None:
            rate = (now.time - begin) / max(progress.tasks[0].elapsed or 0.0, 1e-3)
            description = f"{rate:.3g} t0/s"
            if scene.colloids:
                speed = (now.mean_colloid_position() - position) / (now.time - begin)
                description += f", settling at {speed:+.4f} a0/t0"
            progress.update(task, completed=now.time, description=description)

        simulation.finish(report)

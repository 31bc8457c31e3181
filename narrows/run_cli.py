"""`narrows deck` and `narrows run`: a scene to a LAMMPS deck, or to a run directory."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from lammps_inputs import Scene
    from srd_driver import Simulation


class EngineName(StrEnum):
    """Engines that run a scene."""

    srd = "srd"
    reference = "reference"


SceneName = Annotated[str, typer.Argument(metavar="SCENE", help="channel, poiseuille or bulk")]
SceneFile = Annotated[
    Path | None, typer.Option("--scene", metavar="FILE.toml", help="fields of the scene")
]
Settings = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="FIELD=VALUE", help="one field; wins over the file"),
]
Out = Annotated[Path, typer.Option("--out", metavar="DIR", help="the run directory")]


def deck(scene: SceneName, out: Out, file: SceneFile = None, settings: Settings = None) -> None:
    """Write a folder that runs with `lmp -in in.lammps`, for fix srd."""
    from lammps_inputs.deck import write_deck

    with _user_errors():
        chosen = _scene(scene, file, settings, {})
        if out.exists() and any(out.iterdir()):
            raise FileExistsError(f"{out} is not empty: choose another folder")
        out.mkdir(parents=True, exist_ok=True)
        write_deck(chosen, out)
    print(f"{out}: run it with  lmp -in in.lammps  or  mpirun -np 2 lmp -in in.lammps")


def run(
    scene: SceneName,
    out: Out,
    file: SceneFile = None,
    settings: Settings = None,
    engine: Annotated[
        EngineName | None, typer.Option(help="srd, unless the resumed run has another")
    ] = None,
    resume: Annotated[bool, typer.Option("--resume", help="go on with the run in DIR")] = False,
    checkpoint_interval: Annotated[
        float, typer.Option(min=0.0, help="time between two checkpoints [t0]")
    ] = 20.0,
) -> None:
    """Run a scene into a run directory; alone or under mpirun."""
    from srd_driver import Simulation
    from srd_driver.parallel import communicator
    from srd_driver.run_directory import stored_engine, stored_fields

    quiet = False
    with _user_errors():
        quiet = communicator().rank > 0
        stored: dict[str, Any] = {}
        if resume and out.is_dir() and any(out.iterdir()):
            stored = stored_fields(out)
            engine = engine or EngineName(stored_engine(out))
        chosen = _scene(scene, file, settings, stored)
        name = (engine or EngineName.srd).value
        with Simulation(chosen, name, out, resume, checkpoint_interval) as simulation:
            if simulation.finished:
                _say(quiet, f"{out}: finished before, at time {simulation.time:g}")
                return
            if simulation.step:
                _say(quiet, f"{out}: going on from time {simulation.time:g}")
            _finish(simulation, quiet or not sys.stderr.isatty())
            _say(quiet, f"{out}: time {simulation.time:g}; look at it with  narrows analyze {out}")


def _scene(
    name: str, file: Path | None, settings: list[str] | None, stored: dict[str, Any]
) -> "Scene":
    """The scene from its stored fields, the file and the settings, the later ones winning."""
    from lammps_inputs import SceneError, make_scene, parse_assignment, read_scene

    fields = dict(stored)
    if file:
        fields |= read_scene(file)
    fields |= dict(parse_assignment(text) for text in settings or [])
    if fields.pop("scene", name) != name:
        raise SceneError.of_field("scene", name, f"{file or 'the run directory'} has another scene")
    return make_scene(name, **fields)


def _finish(simulation: "Simulation", quiet: bool) -> None:
    """Run to the end with a progress bar: rate, remaining time, settling speed so far."""
    if quiet:
        simulation.finish()
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    scene = simulation.scene
    begin = simulation.time
    total = scene.collisions * scene.collision_time
    position = simulation.mean_colloid_position() if scene.colloids else 0.0
    with Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.completed:.0f}/{task.total:.0f} t0"),
        TextColumn("{task.fields[rate]}"),
        TimeRemainingColumn(),
        TextColumn("{task.fields[speed]}"),
        console=Console(stderr=True),
    ) as progress:
        task = progress.add_task(scene.name, total=total, completed=begin, rate="", speed="")

        def report(now: "Simulation") -> None:
            elapsed = progress.tasks[0].elapsed or 0.0
            fields = {"rate": f"{(now.time - begin) / elapsed:.3g} t0/s" if elapsed else ""}
            if scene.colloids:
                speed = (now.mean_colloid_position() - position) / (now.time - begin)
                fields["speed"] = f"v_s {speed:+.4f} at rest"
            progress.update(task, completed=now.time, **fields)

        simulation.finish(report)


def _say(quiet: bool, text: str) -> None:
    if not quiet:
        print(text)


@contextmanager
def _user_errors() -> Iterator[None]:
    """Turn what a user can mend into one message on stderr; 2 for bad input, 1 for a stop."""
    from lammps_inputs import SceneError
    from srd_driver import RunError

    try:
        yield
    except SceneError as error:
        _complain("\n".join(error.problems))
        raise typer.Exit(2) from None
    except (RunError, OSError) as error:
        _complain(str(error))
        raise typer.Exit(1) from None
    except KeyboardInterrupt:
        _complain("interrupted; go on from the newest checkpoint by --resume")
        raise typer.Exit(130) from None


def _complain(text: str) -> None:
    from srd_driver.parallel import communicator

    if communicator().rank == 0:
        print(f"narrows: {text}", file=sys.stderr)

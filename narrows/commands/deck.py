"""`narrows deck`: a scene to a folder that plain LAMMPS runs."""

from pathlib import Path
from typing import Annotated

import typer

import lammps_plugin
from lammps_inputs.deck import check_engine, warnings, write_deck
from lammps_inputs.engines import default_engine, lammps_engine_named
from narrows.messages import say, user_errors, warn
from narrows.scene_options import DECKS, SceneFile, SceneName, Settings, scene_of
from srd_driver import RunError
from srd_driver.resume import write_scene


def deck(
    scene: SceneName,
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="a new or empty folder")],
    file: SceneFile = None,
    settings: Settings = None,
    engine: Annotated[str | None, typer.Option(metavar=DECKS, help="whose deck")] = None,
) -> None:
    """Write a folder that runs with `lmp -in in.lammps`."""
    with user_errors():
        chosen = scene_of(scene, file, settings)
        engine = engine or default_engine(chosen.system)
        plugin = lammps_engine_named(engine).needs_plugin(chosen.system)
        check_engine(chosen, engine)
        warn(warnings(chosen, engine))
        out.mkdir(parents=True, exist_ok=True)
        if any(out.iterdir()):
            raise RunError(f"{out} is not empty: choose another folder")
        write_deck(chosen, out, engine)
        write_scene(chosen, engine, out)
        say(f"{out}: run it there with  lmp -in in.lammps  or  mpirun -np 2 lmp -in in.lammps")
        if plugin and not lammps_plugin.folder():
            say("lmp needs our plugin, which was not built here: see narrows run")

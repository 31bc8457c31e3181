"""`narrows units`: a system of the laboratory beside the scene that stands for it."""

from pathlib import Path
from typing import Annotated

import typer

from lammps_inputs import SceneError, all_scenes
from narrows.markdown import table
from narrows.messages import say, user_errors, warn
from narrows.scene_options import SceneFile, SceneName, Settings, scene_fields
from run_files.writing import replace_text


def units(
    scene: SceneName,
    file: SceneFile = None,
    settings: Settings = None,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="FILE.toml", help="write the scene there")
    ] = None,
) -> None:
    """Show what a simulation keeps of the laboratory, and what it changes."""
    with user_errors():
        if scene not in all_scenes():
            known = ", ".join(all_scenes())
            raise SceneError.of_field("scene", scene, f"must be one of {known}")
        stands, found = all_scenes()[scene].of_laboratory(**scene_fields(scene, file, settings))
        rows = [
            (row.name, row.symbol, row.unit, f"{row.real:.4g}", f"{row.simulated:.4g}", row.change)
            for row in found.rows
        ]
        say(table(("quantity", "symbol", "unit", "laboratory", "simulation", "change"), rows))
        scales = ", ".join(f"{name} = {value:.5g}" for name, value in found.units.items())
        say(f"\nunits of the simulation in SI: {scales}")
        warn((*found.warnings, *stands.warnings()))
        if out:
            replace_text(out, stands.toml())
            say(f"{out}: run it with  narrows run {scene} --scene {out}")

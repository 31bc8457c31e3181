"""`narrows scenes`: which scenes there are, and the fields of one."""

from typing import Annotated

import typer

from lammps_inputs import SceneError, all_engines, all_scenes
from lammps_inputs.field_table import field_rows
from lammps_inputs.system import System
from narrows.messages import say, user_errors
from narrows.scene_options import complete_scene


def scenes(
    scene: Annotated[
        str | None,
        typer.Argument(metavar="[SCENE]", autocompletion=complete_scene, help="list its fields"),
    ] = None,
) -> None:
    """List the scenes, or the fields of one: unit, default, what is allowed, meaning."""
    from rich.console import Console  # here, so that `narrows --help` stays fast
    from rich.table import Table

    known = all_scenes()
    with user_errors():
        if scene is not None and scene not in known:
            raise SceneError.of_field("scene", scene, f"must be one of {', '.join(known)}")
    console = Console(markup=False, emoji=False)
    if scene is None:
        table = Table("scene", "what it is", "engines")
        for name, each in known.items():
            about = (each.__doc__ or "").partition("\n\n")[0]
            table.add_row(name, " ".join(about.split()), ", ".join(_engines(each.make().system)))
        console.print(table)
        say("the fields of one: narrows scenes SCENE")
        return
    system = known[scene].make().system
    about, _, _ = (known[scene].__doc__ or "").partition("\n\nFields:")
    say(about)
    table = Table("field", "unit", "default", "allowed", "meaning")
    table.columns[0].no_wrap = True
    for column in table.columns[1:]:
        column.overflow = "fold"  # a long word is broken, not cut off
    for row in field_rows(known[scene]):
        table.add_row(row.name, row.unit, row.default, row.allowed, row.meaning)
    console.print(table)
    say(f"engines: {', '.join(_engines(system))}; measures: {', '.join(system.measures)}")
    say(f"next: narrows run {scene} --set FIELD=VALUE --out DIR")


def _engines(system: System) -> list[str]:
    """Those that can run the scene with its defaults, the default one first."""
    return [engine.name for engine in all_engines().values() if not [*engine.problems(system)]]

"""The options by which commands take a scene and an engine."""

from pathlib import Path
from typing import Annotated, Any

import typer

from lammps_inputs import Scene, SceneError, all_engines, all_scenes, make_scene, parse_assignment
from lammps_inputs.engines.engine import LammpsEngine
from lammps_inputs.field_table import field_rows
from lammps_inputs.scene import read_scene


def complete_scene(incomplete: str) -> list[str]:
    """Scenes for the shell to choose from."""
    return [name for name in all_scenes() if name.startswith(incomplete)]


def complete_field(context: typer.Context, incomplete: str) -> list[tuple[str, str]]:
    """`FIELD=` of the scene that the command line names, with meanings."""
    known = all_scenes()
    words = [context.params.get("scene"), *context.args]  # it is not always parsed by then
    rows = next((field_rows(known[word]) for word in words if word in known), [])
    return [(f"{row.name}=", row.meaning) for row in rows if row.name.startswith(incomplete)]


SceneName = Annotated[
    str,
    typer.Argument(metavar="SCENE", autocompletion=complete_scene, help=" or ".join(all_scenes())),
]
SceneFile = Annotated[
    Path | None, typer.Option("--scene", metavar="FILE.toml", help="fields of the scene")
]
Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="FIELD=VALUE",
        autocompletion=complete_field,
        help="one field, in its unit; wins over the file; narrows scenes SCENE lists them",
    ),
]
Until = Annotated[
    list[str] | None,
    typer.Option(
        "--until",
        metavar="QUANTITY=ERROR",
        help="go on until its standard error is as small: settling_speed=2%, or in its own unit",
    ),
]
Longest = Annotated[
    float | None,
    typer.Option(
        min=0.0,
        metavar="TIME",
        help="duration at which --until ends in any case, in t0; default: 100 times the duration",
    ),
]
ENGINES = "|".join(all_engines())
DECKS = "|".join(name for name, each in all_engines().items() if isinstance(each, LammpsEngine))


def scene_of(
    name: str,
    file: Path | None,
    settings: list[str] | None,
    stored: dict[str, Any] | None = None,
) -> Scene:
    """The scene of that name, from its file and settings, over what a run directory has stored.

    Raises:
        SceneError: naming each wrong field.
    """
    return make_scene(name, **scene_fields(name, file, settings, stored))


def scene_fields(
    name: str,
    file: Path | None,
    settings: list[str] | None,
    stored: dict[str, Any] | None = None,
) -> dict[str, Any]:
    """The stored fields, those of the file and the settings, the later ones winning.

    Raises:
        SceneError: when the file cannot be read or is of another scene, or a setting has no form.
    """
    fields = (stored or {}) | (read_scene(file) if file else {})
    fields |= dict(parse_assignment(text) for text in settings or [])
    if fields.get("scene", name) != name:
        raise SceneError.of_field("scene", fields["scene"], f"the command line says {name!r}")
    return {field: fields[field] for field in fields if field != "scene"}

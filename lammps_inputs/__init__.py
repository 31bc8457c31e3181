"""Scenes, potentials and LAMMPS decks: text out, LAMMPS itself is never imported.

A scene is a frozen model with a unit and a meaning on every field; a deck is a folder that plain
`lmp -in in.lammps` runs.
"""

import tomllib
from pathlib import Path
from typing import Any

from lammps_inputs.bulk import Bulk
from lammps_inputs.channel import Channel
from lammps_inputs.initial_state import InitialState, initial_state
from lammps_inputs.poiseuille import Poiseuille
from lammps_inputs.scene import SceneError, parse_assignment

Scene = Channel | Poiseuille | Bulk
SCENES: dict[str, type[Channel] | type[Poiseuille] | type[Bulk]] = {
    scene.name: scene for scene in (Channel, Poiseuille, Bulk)
}

__all__ = [
    "SCENES",
    "Bulk",
    "Channel",
    "InitialState",
    "Poiseuille",
    "Scene",
    "SceneError",
    "initial_state",
    "make_scene",
    "parse_assignment",
    "read_scene",
]


def make_scene(name: str, **fields: Any) -> Scene:
    """The scene of that name.

    Raises:
        SceneError: for an unknown name, or naming each wrong field, its value and what is allowed.
    """
    if name not in SCENES:
        raise SceneError.of_field("scene", name, f"must be one of {', '.join(SCENES)}")
    return SCENES[name].make(**fields)


def read_scene(file: Path) -> dict[str, Any]:
    """The fields of a scene file, its name among them as `scene` when the file gives it.

    Raises:
        SceneError: when the file is missing or not TOML.
    """
    try:
        return tomllib.loads(file.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise SceneError([f"{file}: {error}"]) from None

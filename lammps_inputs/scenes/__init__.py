"""Scenes, one file each: a file here is a scene by name, without being listed anywhere.

A folder named by the environment variable NARROWS_SCENES holds further scene files.
"""

import importlib
import os
import pkgutil
from functools import cache
from inspect import isabstract
from typing import Any

from lammps_inputs.scene import Scene, SceneError

FOLDER_VARIABLE = "NARROWS_SCENES"

if os.environ.get(FOLDER_VARIABLE):
    __path__.append(os.environ[FOLDER_VARIABLE])


@cache
def all_scenes() -> dict[str, type[Scene]]:
    """All scenes by name."""
    known: dict[str, type[Scene]] = {}
    for file in pkgutil.iter_modules(__path__):
        module = importlib.import_module(f"{__name__}.{file.name}")
        for value in vars(module).values():
            if isinstance(value, type) and issubclass(value, Scene) and not isabstract(value):
                known[value.name] = value
    return dict(sorted(known.items()))


def make_scene(name: str, /, **fields: Any) -> Scene:
    """The scene of that name.

    Raises:
        SceneError: for an unknown name, or naming each wrong field, its value and what is allowed.
    """
    if name not in all_scenes():
        raise SceneError.of_field("scene", name, f"must be one of {', '.join(all_scenes())}")
    return all_scenes()[name].make(**fields)

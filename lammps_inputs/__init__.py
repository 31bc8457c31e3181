"""Scenes, the systems they stand for, and LAMMPS decks: text out, LAMMPS is never imported.

A scene is a frozen model with a unit and a meaning on every field; its `system` is made of parts,
which engines turn into a deck: a folder that plain `lmp -in in.lammps` runs.
"""

from lammps_inputs.engines import all_engines, engine_named
from lammps_inputs.initial_state import InitialState, initial_state
from lammps_inputs.scene import Scene, SceneError, parse_assignment, read_scene
from lammps_inputs.scenes import all_scenes, make_scene

__all__ = [
    "InitialState",
    "Scene",
    "SceneError",
    "all_engines",
    "all_scenes",
    "engine_named",
    "initial_state",
    "make_scene",
    "parse_assignment",
    "read_scene",
]

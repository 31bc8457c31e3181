"""Scenes, the systems they stand for, and LAMMPS decks: text out, LAMMPS is never imported.

A scene is a frozen model with a unit and a meaning on every field; its `system` is made of parts,
which engines turn into a deck: a folder that plain `lmp -in in.lammps` runs.
"""

from lammps_inputs.engines import engine_named, engines
from lammps_inputs.initial_state import InitialState, initial_state
from lammps_inputs.scene import Scene, SceneError, parse_assignment, read_scene
from lammps_inputs.scenes import make_scene, scenes

__all__ = [
    "InitialState",
    "Scene",
    "SceneError",
    "engine_named",
    "engines",
    "initial_state",
    "make_scene",
    "parse_assignment",
    "read_scene",
    "scenes",
]

"""LAMMPS decks: a folder that plain `lmp -in in.lammps` runs, and `-var name value` changes.

A deck contains only what its scene needs. The run directory it fills is described in
docs/run-directory.md; the driver runs the very same lines.
"""

import json
from pathlib import Path
from typing import Any, Literal

from lammps_inputs import Bulk, Channel, Scene, SceneError, mpc_deck, srd_deck
from lammps_inputs.deck_lines import Start
from lammps_inputs.viscosity import viscosity

Engine = Literal["srd", "mpc", "reference"]
DEFAULT_ENGINE: Engine = "mpc"


def check_engine(scene: Scene, engine: Engine) -> None:
    """Refuse what an engine cannot do.

    Raises:
        SceneError: naming the field, its value and what the engine allows.
    """
    problems = list((srd_deck if engine == "srd" else mpc_deck).problems(scene))
    if problems:
        raise SceneError(problems)


def manifest(scene: Scene, engine: Engine) -> dict[str, Any]:
    """All that analysis needs to know of the scene (docs/run-directory.md)."""
    equilibration = round(scene.equilibration / scene.collision_time) * scene.steps_per_collision
    return {
        "engine": engine,
        "scene": scene.name,
        "fields": scene.model_dump(),
        "dimension": scene.dimensions,
        "box": list(scene.box),
        "periodic": list(scene.periodic),
        "units": {"length": "a0", "energy": "kBT", "mass": "m_f", "time": "a0 sqrt(m_f/kBT)"},
        "time_step": scene.time_step,
        "steps_per_collision": scene.steps_per_collision,
        "sample_steps": scene.sample_steps,
        "fluid_looks": scene.fluid_looks,
        "equilibration_steps": equilibration,
        "total_steps": scene.total_steps,
        "fluid_particles": scene.fluid_particles,
        "colloids": scene.colloids,
        "colloid_mass": scene.colloid_mass if isinstance(scene, Channel) else None,
        "viscosity_theory": _viscosity_theory(scene),
        "seeds": {"seed": scene.seed, **(srd_deck.seeds(scene) if engine == "srd" else {})},
    }


def _viscosity_theory(scene: Scene) -> float | None:
    """Kinetic theory's viscosity: none for a random solvent, or a 2D turn by 180 degrees."""
    if scene.hydrodynamics != "on" or (scene.dimensions == 2 and scene.angle == 180):
        return None
    rotation = scene.rotation if isinstance(scene, Bulk) else "coordinate_axes"
    return viscosity(scene.density, scene.collision_time, scene.angle, scene.dimensions, rotation)


def write_deck(scene: Scene, directory: Path, engine: Engine) -> None:
    """Write scene, manifest and, for LAMMPS, input script and what it reads into a folder.

    Raises:
        SceneError: when the engine cannot run the scene.
    """
    check_engine(scene, engine)
    (directory / "scene.toml").write_text(scene.toml(), encoding="utf-8")
    (directory / "manifest.json").write_text(
        json.dumps(manifest(scene, engine), indent=2) + "\n", encoding="utf-8"
    )
    if engine != "reference":
        (directory / "in.lammps").write_text(script(scene, engine), encoding="utf-8")
        (mpc_deck if engine == "mpc" else srd_deck).write(scene, directory)


def script(scene: Scene, engine: Engine, start: Start | None = None) -> str:
    """The input script; its last command is the `run`."""
    lines = (mpc_deck if engine == "mpc" else srd_deck).lines(scene, start or Start())
    return "\n".join(lines) + "\n"

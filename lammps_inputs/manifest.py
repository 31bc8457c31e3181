"""What a run directory says of its scene and system (docs/run-directory.md)."""

from dataclasses import asdict, fields, is_dataclass
from typing import Any

from lammps_inputs.engines import engine_named
from lammps_inputs.scene import Scene
from lammps_inputs.system import System
from lammps_inputs.viscosity import viscosity_theory

FORMAT = 2  # of the manifest

UNITS = {"length": "a0", "energy": "kBT", "mass": "m_f", "time": "a0 sqrt(m_f/kBT)"}


def manifest(scene: Scene, engine: str) -> dict[str, Any]:
    """All that analysis needs to know of a run, as JSON has it."""
    return {
        "format": FORMAT,
        "engine": engine,
        "scene": scene.name,
        "fields": scene.model_dump(),
        "units": UNITS,
        "si_units": scene.si_units,
        "system": _system(scene.system),
        "seeds": {"seed": scene.seed, **engine_named(engine).seeds(scene.seed, step=0)},
    }


def _system(system: System) -> dict[str, Any]:
    content = asdict(system)
    del content["placement"]  # the trajectory tells it
    content["interactions"] = [
        {"first": i.first, "second": i.second, "potential": _named(i.potential)}
        for i in system.interactions
    ]
    content["walls"] = [
        {
            "axis": wall.axis,
            "side": wall.side,
            "potentials": [(name, _named(potential)) for name, potential in wall.potentials],
            "velocity": wall.velocity,
        }
        for wall in system.walls
    ]
    content["motion"] = _named(system.motion)
    if system.solvent:
        theory = viscosity_theory(system.solvent, system.box.dimensions)
        content["solvent"]["viscosity_theory"] = theory
    return content


def _named(part: Any) -> dict[str, Any]:
    """A part with the name of its class."""
    assert is_dataclass(part)
    values = {field.name: getattr(part, field.name) for field in fields(part)}
    return {"class": type(part).__name__, **values}

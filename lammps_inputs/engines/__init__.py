"""Engines, one file each: what an engine writes for each part of a system, or refuses.

A file here that has an `ENGINE` is an engine, without being listed anywhere.
"""

import importlib
import pkgutil
from functools import cache

from lammps_inputs.engines.engine import Engine, LammpsEngine
from lammps_inputs.scene import SceneError
from lammps_inputs.system import System

DEFAULT = "mpc"
WITHOUT_SOLVENT = "md"


@cache
def all_engines() -> dict[str, Engine]:
    """All engines by name, the default one first."""
    modules = (
        importlib.import_module(f"{__name__}.{file.name}")
        for file in pkgutil.iter_modules(__path__)
    )
    known: list[Engine] = [module.ENGINE for module in modules if hasattr(module, "ENGINE")]
    return {each.name: each for each in sorted(known, key=lambda e: (e.name != DEFAULT, e.name))}


def default_engine(system: System) -> str:
    """The first engine that can do a system; where none can, the one whose reasons are shown."""
    return next((e.name for e in all_engines().values() if not [*e.problems(system)]), DEFAULT)


def engine_named(name: str) -> Engine:
    """The engine of that name.

    Raises:
        SceneError: for an unknown name.
    """
    if name not in all_engines():
        raise SceneError.of_field("engine", name, f"must be one of {', '.join(all_engines())}")
    return all_engines()[name]


def lammps_engine_named(name: str) -> LammpsEngine:
    """The engine of that name, which writes decks.

    Raises:
        SceneError: for an unknown name, or an engine without decks.
    """
    engine = engine_named(name)
    if not isinstance(engine, LammpsEngine):
        known = [each.name for each in all_engines().values() if isinstance(each, LammpsEngine)]
        raise SceneError.of_field("engine", name, f"has no deck; {', '.join(known)} have one")
    return engine

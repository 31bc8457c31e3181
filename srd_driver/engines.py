"""Which session runs an engine: LAMMPS for every engine that writes decks, else one of its own."""

import importlib
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import lammps_plugin
from lammps_inputs import Scene, SceneError, engine_named
from lammps_inputs.deck import check_engine, has_deck
from lammps_inputs.limits import time_problems
from run_files.progress import Progress
from srd_driver.errors import RunError
from srd_driver.session import Session

SESSIONS = {
    "reference": "srd_driver.reference_session:ReferenceSession",
    "events": "srd_driver.events_session:EventsSession",
}
LIBRARIES = {"events": "numba"}  # that come with the extra of the engine's name


def require_engine(scene: Scene, engine: str, processes: int = 1) -> None:
    """Refuse a scene that the engine cannot run, or an engine that cannot run here.

    Raises:
        SceneError: naming the field or part, its value and what the engine allows.
        RunError: without the plugin that it needs, or for more processes than it takes.
    """
    if processes > 1 and not engine_named(engine).processes:
        raise RunError(
            f"the {engine} engine runs on one process; use the default engine with mpirun"
        )
    check_engine(scene, engine)
    library = LIBRARIES.get(engine)
    if library and not find_spec(library):
        raise RunError(f"engine {engine} needs {library}: pip install 'narrows[{engine}]'")
    if problems := list(time_problems(scene.system.work, processes)):
        raise SceneError(problems)
    if engine_named(engine).needs_plugin(scene.system) and not lammps_plugin.folder():
        instead = "; or use --engine srd" if scene.system.solvent else ""
        raise RunError(
            f"engine {engine} needs the LAMMPS plugin, which was not built when narrows was "
            "installed: install a C++17 compiler, then narrows again with "
            f"NARROWS_REQUIRE_PLUGIN=1{instead}"
        )


def start_session(
    scene: Scene,
    engine: str,
    directory: Path,
    progress: Progress,
    checkpoint_steps: int,
    comm: Any,
) -> Session:
    """The engine at work in its run directory, at the run's newest checkpoint.

    Raises:
        RunError: when it cannot start.
    """
    if has_deck(engine):
        from srd_driver.lammps_session import LammpsSession

        return LammpsSession(scene, engine, directory, progress, checkpoint_steps, comm)
    session: Session = _session_class(engine)(scene, directory, progress)
    return session


def checkpoint_suffix(engine: str) -> str:
    """How the names of an engine's checkpoints end."""
    return str(_session_class(engine).suffix)


def _session_class(engine: str) -> Any:
    known = "srd_driver.lammps_session:LammpsSession" if has_deck(engine) else SESSIONS[engine]
    module, _, name = known.partition(":")
    return getattr(importlib.import_module(module), name)

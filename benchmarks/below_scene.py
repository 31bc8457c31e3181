"""Fields that no scene has: numbers of the method, changed where they are kept.

`placement` and `N_max` are of coupling I: where fluid is put that met a sphere (the word of fix
mpc's `reflect`), and how many spheres a particle may meet in an interval (a constant, of numpy's
engine only). `closest` and `farthest` are the gaps of lubrication [R]. Runs with such fields are
carried out in this process; their directories tell the scene without them.
"""

from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager, ExitStack, contextmanager
from typing import Any
from unittest.mock import patch

from lammps_inputs import Scene, SceneError, make_scene
from lammps_inputs.engines.engine import Start
from lammps_inputs.engines.mpc import Mpc
from lammps_inputs.scenes import claylike
from lammps_inputs.system import System
from run_files import RunDirectoryError
from srd_driver import RunError, Simulation
from srd_driver.reference import reflection
from srd_driver.sweep import Failure, Run, is_finished, run_all

Fields = dict[str, Any]


def _placed(word: str) -> AbstractContextManager[Any]:
    written = Mpc.solvent

    def solvent(self: Mpc, system: System, start: Start) -> Iterator[str]:
        for line in written(self, system, start):
            yield line.replace(" entry", f" {word}")

    return patch.object(Mpc, "solvent", solvent)


BELOW: dict[str, Callable[[Any], AbstractContextManager[Any]]] = {
    "placement": _placed,
    "N_max": lambda most: patch.object(reflection, "MOST_CONTACTS", most),
    "closest": lambda gap: patch.object(claylike, "CLOSEST", gap),
    "farthest": lambda gap: patch.object(claylike, "FARTHEST", gap),
}


def below(fields: Fields) -> Fields:
    """Those that no scene has."""
    return {name: value for name, value in fields.items() if name in BELOW}


@contextmanager
def changed(fields: Fields) -> Iterator[None]:
    """What is done inside sees those of the fields that no scene has."""
    with ExitStack() as stack:
        for name, value in below(fields).items():
            stack.enter_context(BELOW[name](value))
        yield


def make(name: str, fields: Fields) -> Scene:
    """The scene of the other fields, its system as all of them make it.

    Raises:
        SceneError: as `make_scene` does.
    """
    with changed(fields):
        scene = make_scene(name, **{n: v for n, v in fields.items() if n not in BELOW})
        _ = scene.system  # kept, as it is made here
    return scene


def execute(runs: Mapping[Run, Fields], jobs: int) -> list[Failure]:
    """Execute what is not finished: by a sweep, one after the other where fields are below."""
    failures = run_all([run for run, fields in runs.items() if not below(fields)], jobs)
    for run, fields in runs.items():
        if not below(fields) or is_finished(run):
            continue
        try:
            with changed(fields), Simulation(run.scene, run.engine, run.folder, True) as simulation:
                simulation.finish()
        except (RunError, SceneError, RunDirectoryError) as error:
            failures.append(Failure(run, " ".join(str(error).split())))
    return failures

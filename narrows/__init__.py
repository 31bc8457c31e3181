"""Particles driven through narrow spaces, from a script or a notebook (docs/python.md).

    from narrows import Simulation, make_scene

    with Simulation(make_scene("channel", colloids=5, length=60), directory="runs/five") as run:
        run.finish(progress=True)

| name | what it does |
|---|---|
| `make_scene` | a scene by its name and fields |
| `Simulation` | runs it; steered and looked into while it runs |
| `run_until` | a run that ends when its quantities are precise |
| `analyze` | the numbers of a run directory, with errors |
| `RunDirectory` | its arrays, and the MDAnalysis Universe |
| `sweep`, `table` | many runs on all cores, and their numbers by point |
| `draw_flow` | stream lines of a flow field, on axes of yours |
| `read_fluid`, `read_flow` | a fluid, and a flow field, that fix mpc left of a deck of yours |

Each is loaded when it is first asked for.
"""

import importlib
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from analysis import RunDirectory, analyze
    from analysis.flow_grid import read_flow
    from analysis.measures.flow_field import draw_flow
    from narrows.scripting import make_scene, sweep, table
    from narrows.until import run_until
    from run_files.fluid_file import read_fluid
    from srd_driver import Simulation

__all__ = [
    "RunDirectory",
    "Simulation",
    "analyze",
    "draw_flow",
    "make_scene",
    "read_flow",
    "read_fluid",
    "run_until",
    "sweep",
    "table",
]

_MODULES = {
    "RunDirectory": "analysis",
    "Simulation": "srd_driver",
    "analyze": "analysis",
    "draw_flow": "analysis.measures.flow_field",
    "make_scene": "narrows.scripting",
    "read_flow": "analysis.flow_grid",
    "read_fluid": "run_files.fluid_file",
    "run_until": "narrows.until",
    "sweep": "narrows.scripting",
    "table": "narrows.scripting",
}
_OURS = ("analysis", "lammps_inputs", "lammps_plugin", "lattice", "run_files", "srd_driver")


def _require_ours() -> None:
    """That `import analysis` means our package: many scripts are called `analysis.py`.

    Raises:
        ImportError: naming the file that hides ours, and the remedy.
    """
    beside = Path(__file__).resolve().parent.parent
    for name in _OURS:
        spec = find_spec(name)
        place = Path(spec.origin).resolve() if spec and spec.origin else None
        if place and place.parent.parent != beside:
            raise ImportError(
                f"narrows needs its own package {name!r}, which {place} hides: rename that file or "
                "folder, or start Python in another folder"
            )


_require_ours()


def __getattr__(name: str) -> Any:
    if name not in _MODULES:
        raise AttributeError(f"module 'narrows' has no attribute {name!r}")
    return getattr(importlib.import_module(_MODULES[name]), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})

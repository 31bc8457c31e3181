"""Measures, one file each: a run directory in, `Findings` out.

A file here with a function `measure` is a measure by name; a manifest lists those of its run. Its
`QUANTITIES` are the numbers with errors that it may find, by name, `*` for what the run decides.
"""

import importlib
import pkgutil
from collections.abc import Callable, Iterable
from fnmatch import fnmatchcase
from functools import cache
from types import ModuleType

from analysis.findings import Findings
from analysis.run_directory import RunDirectory

Measure = Callable[[RunDirectory], Findings]


@cache
def _modules() -> dict[str, ModuleType]:
    names = [file.name for file in pkgutil.iter_modules(__path__)]
    return {name: importlib.import_module(f"{__name__}.{name}") for name in names}


def measures() -> dict[str, Measure]:
    """All measures by name."""
    return {name: module.measure for name, module in _modules().items()}


def quantities(names: Iterable[str]) -> list[str]:
    """The quantities that these measures may find."""
    modules = _modules()
    of_all = (getattr(modules[name], "QUANTITIES", ()) for name in names)
    return list(dict.fromkeys(quantity for of_one in of_all for quantity in of_one))


def may_find(names: Iterable[str], quantity: str) -> bool:
    """Whether one of these measures may find the quantity."""
    return any(fnmatchcase(quantity, pattern) for pattern in quantities(names))

"""Measures, one file each: a run directory in, `Findings` out.

A file here with a function `measure` is a measure by name; a manifest lists those of its run.
"""

import importlib
import pkgutil
from collections.abc import Callable
from functools import cache

from analysis.findings import Findings
from analysis.run_directory import RunDirectory

Measure = Callable[[RunDirectory], Findings]


@cache
def measures() -> dict[str, Measure]:
    """All measures by name."""
    return {
        file.name: importlib.import_module(f"{__name__}.{file.name}").measure
        for file in pkgutil.iter_modules(__path__)
    }

"""Run directory in, numbers with errors and figures out.

`analyze(directory)` does all of it, `tabulate(directory)` for all runs of a sweep; a measure is a
file of `measures/`, and the other modules hold the physics, arrays in and arrays out.
"""

from analysis.analyze import analyze
from analysis.estimate import Estimate
from analysis.run_directory import RunDirectory
from analysis.sweep_table import SweepTable, tabulate
from run_files import RunDirectoryError

__all__ = [
    "Estimate",
    "RunDirectory",
    "RunDirectoryError",
    "SweepTable",
    "analyze",
    "tabulate",
]

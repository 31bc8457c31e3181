"""Run directory in, numbers with errors and figures out.

`analyze(directory)` does all of it, `tabulate(directory)` for all runs of a sweep; the modules hold
the pieces, arrays in and arrays out.
"""

from analysis.blocking import Estimate
from analysis.run_directory import RunDirectory, RunDirectoryError
from analysis.summary import analyze
from analysis.sweep_table import SweepTable, is_sweep, tabulate

__all__ = [
    "Estimate",
    "RunDirectory",
    "RunDirectoryError",
    "SweepTable",
    "analyze",
    "is_sweep",
    "tabulate",
]

"""Run directory in, numbers with errors and figures out.

`analyze(directory)` does all of it; the modules hold the pieces, arrays in and arrays out.
"""

from analysis.blocking import Estimate
from analysis.run_directory import RunDirectory, RunDirectoryError
from analysis.summary import analyze

__all__ = ["Estimate", "RunDirectory", "RunDirectoryError", "analyze"]

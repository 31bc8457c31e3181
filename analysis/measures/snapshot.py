"""A picture of the particles at the last output."""

from analysis.findings import Findings
from analysis.run_directory import RunDirectory
from analysis.system_picture import draw


def measure(run: RunDirectory) -> Findings:
    """The figure alone; `narrows picture` draws other times."""
    return Findings(figures={"snapshot.png": draw(run)})

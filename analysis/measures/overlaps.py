"""Whether colloids came nearer to each other than their repulsion lets them."""

from analysis.findings import Findings
from analysis.health import overlap_warnings
from analysis.run_directory import RunDirectory


def measure(run: RunDirectory) -> Findings:
    """A warning for the closest approach of two colloids in all frames."""
    diameter = 2 * run.species().radius
    return Findings(warnings=overlap_warnings(run.particles().positions, run.box, diameter))

"""Temperature and potential energy of particles without a solvent."""

from analysis import blocking
from analysis.findings import Findings
from analysis.run_directory import RunDirectory


def measure(run: RunDirectory) -> Findings:
    """Means over time of the kinetic temperature and of the potential energy a particle [kBT]."""
    table = run.table()
    used = run.sampled(table.steps)
    return Findings({name: blocking.mean(table[name][used]).as_json() for name in table.columns})

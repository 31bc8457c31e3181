"""What the table of a system without a solvent averages: temperature, potential energy, drift."""

from analysis import correlated_mean
from analysis.findings import Findings
from analysis.run_directory import RunDirectory

QUANTITIES = ("temperature", "potential_energy", "mean_velocity_x")


def measure(run: RunDirectory) -> Findings:
    """The mean over time of every column."""
    table = run.table()
    used = run.sampled(table.steps)
    return Findings(
        {
            name: correlated_mean.mean(table[name][used], run.interval).as_json()
            for name in table.columns
        }
    )

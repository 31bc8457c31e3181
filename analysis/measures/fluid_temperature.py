"""Temperature of the fluid, without its streaming profile."""

from analysis import correlated_mean
from analysis.findings import Findings
from analysis.health import temperature_warnings
from analysis.run_directory import RunDirectory

QUANTITIES = ("temperature",)

TOLERANCE = 0.01  # fix srd rescales to 0.993


def measure(run: RunDirectory) -> Findings:
    """Mean over time; a warning when it is off kBT = 1."""
    table = run.table()
    temperature = correlated_mean.mean(
        table["fluid_temperature"][run.sampled(table.steps)], run.interval
    )
    return Findings(
        {"temperature": temperature.as_json()},
        warnings=temperature_warnings("fluid", temperature, TOLERANCE),
    )

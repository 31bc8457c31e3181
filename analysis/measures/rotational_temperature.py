"""Temperature of the rotation of the colloids."""

from analysis import correlated_mean
from analysis.findings import Findings
from analysis.run_directory import RunDirectory

QUANTITIES = ("rotational_temperature",)


def measure(run: RunDirectory) -> Findings:
    """Mean over time. No warning: without friction between colloids nothing drives it to 1."""
    table = run.table()
    series = table["rotational_temperature"][run.sampled(table.steps)]
    return Findings(
        {"rotational_temperature": correlated_mean.mean(series, run.interval).as_json()}
    )

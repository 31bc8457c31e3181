"""What the table of soft particles averages, and the temperature of their configurations."""

import numpy as np

from analysis import correlated_mean
from analysis.configurational_temperature import configurational_temperature
from analysis.current import mobility
from analysis.estimate import Estimate
from analysis.findings import Findings
from analysis.run_directory import RunDirectory

QUANTITIES = (
    "kinetic_temperature",
    "configurational_temperature",
    "potential_energy",
    "pressure",
    "pressure_xy",
    "current",
    "mobility",
    "thermostat_friction",
    "thermostat_multiplier",
)
SUMS = ("force_squares", "laplacians")
LOW = 0.02  # of T: a configurational thermostat that is further off has not settled


def measure(run: RunDirectory) -> Findings:
    """The mean over time of every column, T_conf as a ratio of means, the mobility in a field."""
    table = run.table()
    used = run.sampled(table.steps)
    entries = {
        name: correlated_mean.mean(table[name][used]).as_json()
        for name in table.columns
        if name not in SUMS
    }
    squares, laplacians = (table[name][used] for name in SUMS)
    warnings = []
    negative = int((laplacians <= 0).sum())
    if negative:
        warnings.append(
            f"the Laplacian of the potential energy is not positive in {negative} of "
            f"{len(laplacians)} intervals: the configurational temperature has no meaning there"
        )
    temperature = configurational_temperature(squares, laplacians)
    entries["configurational_temperature"] = temperature.as_json()
    warnings += _thermostat_warnings(run, temperature)
    field = field_of(run)
    if "current" in table.columns and field:
        entries["mobility"] = mobility(table["current"][used], field).as_json()
    return Findings(entries, warnings=tuple(warnings))


def field_of(run: RunDirectory) -> float | None:
    """The force on each particle [kBT/a0], where it is as strong on all."""
    fields = {
        float(np.linalg.norm(run.acceleration(each.name))) * each.mass
        for each in run.manifest.system.species
    }
    return fields.pop() if len(fields) == 1 else None


def _thermostat_warnings(run: RunDirectory, temperature: Estimate) -> list[str]:
    """Whether a thermostat of the configurations holds what it is set to."""
    motion = run.manifest.system.motion
    if motion.get("class") != "Configurational" or not temperature.value:
        return []
    wanted = float(motion["temperature"])
    off = abs(temperature.value - wanted)
    if off <= max(LOW * wanted, 3 * (temperature.error or 0.0)):
        return []
    return [
        f"the configurational temperature is {temperature.value:.4g}, its thermostat is set to "
        f"{wanted:g}: the time step is too long, or the run too short"
    ]

"""Viscosity of a sheared system."""

from analysis.current import viscosity
from analysis.findings import Findings
from analysis.run_directory import RunDirectory

QUANTITIES = ("shear_viscosity",)


def measure(run: RunDirectory) -> Findings:
    """-<P_xy> over the rate of the motion."""
    table = run.table()
    stress = table["pressure_xy"][run.sampled(table.steps)]
    rate = float(run.manifest.system.motion.get("shear_rate", 0.0))
    return Findings({"shear_viscosity": viscosity(stress, rate).as_json()})

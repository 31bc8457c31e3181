"""Whether the velocities of the fluid are Gaussian."""

from analysis import correlated_mean
from analysis.estimate import Estimate
from analysis.findings import Findings
from analysis.normality import FALSE_ALARMS, normal_probability
from analysis.run_directory import RunDirectory

QUANTITIES = ("fluid_velocity_distribution.excess_kurtosis.*",)


def measure(run: RunDirectory) -> Findings:
    """Skewness and kurtosis of all particles, as means over time, and a test along each axis.

    Of N independent normal numbers the excess kurtosis is -6 / (N + 1) on average, which is taken
    off. Axes along which walls move are left out: their flow is no thermal motion.
    """
    table, particles = run.table(), run.solvent.particles
    used = run.sampled(table.steps)
    moving = {
        axis
        for wall in run.manifest.system.walls
        for axis, speed in zip("xyz", wall.velocity, strict=True)
        if speed
    }

    def mean(name: str, bias: float = 0.0) -> dict[str, Estimate]:
        return {
            axis: correlated_mean.mean(table[f"fluid_{name}_{axis}"][used] - bias, run.interval)
            for axis in "xyz"
            if axis not in moving
        }

    skewness, kurtosis = mean("skewness"), mean("kurtosis", -6 / (particles + 1))
    entry = {
        "skewness": {axis: each.as_json() for axis, each in skewness.items()},
        "excess_kurtosis": {axis: each.as_json() for axis, each in kurtosis.items()},
    }
    try:
        p_values = [normal_probability(skewness[axis], kurtosis[axis]) for axis in skewness]
    except ValueError as error:
        return Findings(
            {"fluid_velocity_distribution": {"normal": None, "reason": str(error)} | entry}
        )
    normal = min(p_values) > FALSE_ALARMS / len(p_values)
    told = {"normal": normal, "false_alarms": FALSE_ALARMS, "p_values": p_values}
    return Findings({"fluid_velocity_distribution": told | entry})

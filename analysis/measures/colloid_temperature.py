"""Temperature of the colloids, from their velocities across what drives them."""

from analysis import correlated_mean
from analysis.findings import Findings
from analysis.health import temperature_warnings
from analysis.measures.settling_speed import sampled_frames
from analysis.run_directory import RunDirectory
from analysis.temperature import colloid_temperature

QUANTITIES = ("colloid_temperature",)

TOLERANCE = 0.05


def measure(run: RunDirectory) -> Findings:
    """Mean over time; a warning when it is off kBT = 1."""
    velocities = run.particles().velocities[sampled_frames(run)]
    temperature = correlated_mean.mean(
        colloid_temperature(velocities, run.species().mass, still_axes(run)), run.interval
    )
    return Findings(
        {"colloid_temperature": temperature.as_json()},
        warnings=temperature_warnings("colloids", temperature, TOLERANCE),
    )


def still_axes(run: RunDirectory) -> list[int]:
    """In 3D all directions that no drive and no wall moves along; else y, across the channel."""
    if run.box.dimensions < 3:
        return [1]
    system = run.manifest.system
    ways = [drive.direction for drive in system.drives] + [wall.velocity for wall in system.walls]
    return [axis for axis in range(3) if not any(way[axis] for way in ways)] or [1]

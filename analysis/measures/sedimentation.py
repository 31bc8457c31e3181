"""Settling speed of colloids in a suspension, in three frames."""

import math

import numpy as np
from matplotlib.figure import Figure

from analysis import correlated_mean
from analysis.arrays import Array
from analysis.drawing import TIME, mark_equilibration, one_panel
from analysis.findings import Findings, in_si
from analysis.measures.settling_speed import sampled_frames
from analysis.run_directory import RunDirectory
from analysis.sedimentation import SettlingSpeeds, settling_speeds

QUANTITIES = (
    "settling_speed.zero_momentum",
    "settling_speed.relative_to_fluid",
    "settling_speed.zero_volume_flux",
)


def measure(run: RunDirectory) -> Findings:
    """Means over time of the speed down the pull, which is along z, in each frame."""
    sampled_frames(run)
    table, particles, species = run.table(), run.particles(), run.species()
    down = next(
        drive.direction[2] for drive in run.manifest.system.drives if drive.target == species.name
    )
    speed = down * np.diff(particles.positions[:, :, 2], axis=0).mean(axis=1) / run.interval
    count = min(len(speed), len(table.steps))
    speed, mean = speed[:count], down * table["mean_velocity_z"][:count]
    # what the colloids do not have of the momentum has the fluid, also between two looks
    colloids, fluid = species.count * species.mass, float(run.solvent.particles)
    of_fluid = ((colloids + fluid) * mean - colloids * speed) / fluid
    volume = species.count * 4 / 3 * math.pi * species.radius**3
    phi = volume / math.prod(run.box.sizes)
    speeds = settling_speeds(speed, of_fluid, mean, phi)
    used = run.sampled(table.steps)[:count]
    entry = {
        name: in_si(run, correlated_mean.mean(series[used], run.interval), length=1, time=-1)
        for name, series in vars(speeds).items()
    }
    picture = draw(run.times(table.steps[:count]), speeds, run.equilibration_time)
    return Findings({"settling_speed": entry}, {"settling_speed.png": picture})


def draw(times: Array, speeds: SettlingSpeeds, equilibration: float) -> Figure:
    """Running means of the speed in each frame."""
    figure, axes = one_panel(TIME, "settling speed, running mean [$a_0/t_0$]")
    used = times > equilibration
    for name, series in vars(speeds).items():
        running = np.cumsum(series[used]) / np.arange(1, used.sum() + 1)
        axes.plot(times[used], running, label=name.replace("_", " "))
    mark_equilibration(axes, equilibration)
    axes.legend()
    return figure

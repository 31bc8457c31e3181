"""How fast the colloids follow walls that move, and how much force that takes."""

import numpy as np
from matplotlib.figure import Figure

from analysis import correlated_mean
from analysis.arrays import Array
from analysis.drawing import one_panel
from analysis.estimate import Estimate
from analysis.findings import Findings
from analysis.measures.settling_speed import sampled_frames
from analysis.run_directory import RunDirectory

QUANTITIES = ("shear_flow.rate", "shear_flow.stress", "shear_flow.viscosity")

LAYERS = 10


def measure(run: RunDirectory) -> Findings:
    """Slope of the velocity along x over z, of all colloids and by layers; stress on walls."""
    used, particles = sampled_frames(run), run.particles()
    height = run.box.sizes[2]
    positions, velocities = particles.positions[used], particles.velocities[used]
    z, v = positions[:, :, 2] - 0.5 * height, velocities[:, :, 0]
    slopes = (z * v).mean(axis=1) / (z**2).mean()
    rate = correlated_mean.mean(slopes, run.interval)
    layer = np.clip(((z / height + 0.5) * LAYERS).astype(int), 0, LAYERS - 1)
    profile = [
        correlated_mean.mean(
            [
                row[at == number].mean()
                for row, at in zip(v, layer, strict=True)
                if (at == number).any()
            ]
        )
        if (layer == number).any()
        else Estimate(None, None, "no colloid came there")
        for number in range(LAYERS)
    ]
    imposed = 2 * max(wall.velocity[0] for wall in run.manifest.system.walls) / height
    entry = {"rate": rate.as_json(), "imposed": imposed, "profile": [p.as_json() for p in profile]}
    entry |= {name: each.as_json() for name, each in stress_and_viscosity(run, rate).items()}
    middle = height * (np.arange(LAYERS) + 0.5) / LAYERS
    return Findings(
        {"shear_flow": entry}, {"shear_flow.png": draw(middle, profile, imposed, height)}
    )


def stress_and_viscosity(run: RunDirectory, rate: Estimate) -> dict[str, Estimate]:
    """Stress that the fluid hands to the walls across z; viscosity, its ratio to the rate of shear.

    Relative to that of the fluid alone by theory, too.
    """
    table = run.table()
    used = run.sampled(table.steps)
    drag = 0.5 * (table["lower_wall_force_x"] - table["upper_wall_force_x"])[used]
    area = run.box.sizes[0] * run.box.sizes[1]
    stress = correlated_mean.mean(drag / area, run.interval)
    known = {"stress": stress, "viscosity": stress / rate}
    if run.solvent.viscosity_theory:
        of_fluid = run.solvent.density * run.solvent.viscosity_theory
        known["relative_viscosity"] = known["viscosity"] / of_fluid
    return known


def draw(middle: Array, profile: list[Estimate], imposed: float, height: float) -> Figure:
    """Velocity of the colloids by layers beside that of the walls' flow."""
    figure, axes = one_panel("height $z$ [$a_0$]", "velocity along $x$ [$a_0/t_0$]")
    known = [
        (z, p.value, p.error or 0.0)
        for z, p in zip(middle, profile, strict=True)
        if p.value is not None
    ]
    if known:
        z, value, error = zip(*known, strict=True)
        axes.errorbar(z, value, error, fmt="o", label="colloids")
    axes.plot([0, height], [-imposed * height / 2, imposed * height / 2], label="walls")
    axes.legend()
    return figure

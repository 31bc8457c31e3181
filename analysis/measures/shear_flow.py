"""How fast the colloids follow walls that move."""

import numpy as np
from matplotlib.figure import Figure

from analysis import correlated_mean
from analysis.arrays import Array
from analysis.drawing import one_panel
from analysis.estimate import Estimate
from analysis.findings import Findings
from analysis.measures.settling_speed import sampled_frames
from analysis.run_directory import RunDirectory

QUANTITIES = ("shear_flow.rate",)

LAYERS = 10


def measure(run: RunDirectory) -> Findings:
    """Slope of the velocity along x across z: of all colloids, and of those by layers."""
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
    middle = height * (np.arange(LAYERS) + 0.5) / LAYERS
    return Findings(
        {"shear_flow": entry}, {"shear_flow.png": draw(middle, profile, imposed, height)}
    )


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

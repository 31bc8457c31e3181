"""Flow profiles of each species across the field."""

import numpy as np
from matplotlib.figure import Figure

from analysis.arrays import Array
from analysis.current import flow_profiles
from analysis.findings import Findings
from analysis.measures.settling_speed import sampled_frames
from analysis.run_directory import RunDirectory


def measure(run: RunDirectory) -> Findings:
    """The figure: densities and velocities in layers of one particle diameter."""
    used, particles = sampled_frames(run), run.particles()
    heights, numbers, speeds = flow_profiles(
        particles.positions[used][:, :, 1],
        particles.velocities[used][:, :, 0],
        particles.species,
        run.width,
        max(2, int(run.width)),
    )
    layer = np.prod(run.box.sizes) / len(heights)
    names = np.unique(particles.species).tolist()
    return Findings(figures={"colour_flow.png": draw(names, heights, numbers / layer, speeds)})


def draw(names: list[str], heights: Array, densities: Array, speeds: Array) -> Figure:
    """Number density and mean velocity along x by the position across.

    Args:
        names: of the species.
        heights: of the layers, (bins,).
        densities, speeds: of each species, (species, bins).
    """
    figure = Figure(figsize=(7, 6), layout="constrained")
    above, below = figure.subplots(2, sharex=True)
    for name, density, speed in zip(names, densities, speeds, strict=True):
        above.plot(heights, density, label=name)
        below.plot(heights, speed)
    above.set(ylabel="number density", ylim=(0, None))
    below.set(ylabel="mean velocity $v_x$", xlabel="across the field $y$")
    above.legend()
    return figure

"""A picture of the last frame, its particles in the colours of their species."""

import numpy as np
from matplotlib.collections import PatchCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from numpy.typing import NDArray

from analysis.arrays import Array
from analysis.findings import Findings
from analysis.periodic import wrapped
from analysis.run_directory import RunDirectory


def measure(run: RunDirectory) -> Findings:
    """The figure: the plane x-y, and in 3D y-z beside it."""
    particles = run.particles()
    positions = wrapped(particles.positions[-1], run.box.sizes)
    radii = {species.name: species.radius for species in run.manifest.system.species}
    picture = draw(positions, particles.species, radii, run.box.sizes)
    return Findings(figures={"snapshot.png": picture})


def draw(
    positions: Array,
    species: NDArray[np.str_],
    radii: dict[str, float],
    sizes: tuple[float, ...],
) -> Figure:
    """Circles at the particles, those of each species filled or open.

    Args:
        positions: in the box, (N, d).
        species: names, (N,).
        radii: by name.
        sizes: of the box, (d,).
    """
    planes = [(0, 1)] if len(sizes) == 2 else [(0, 1), (1, 2)]
    figure = Figure(figsize=(5 * len(planes), 5), layout="constrained")
    panels = figure.subplots(1, len(planes), squeeze=False)[0]
    for axes, (across, up) in zip(panels, planes, strict=True):
        for number, (name, radius) in enumerate(radii.items()):
            centres = positions[species == name][:, (across, up)]
            circles = [Circle((x, y), radius) for x, y in centres]
            face = f"C{number}" if number == 0 else "none"
            axes.add_collection(
                PatchCollection(circles, facecolor=face, edgecolor=f"C{number}", linewidth=0.8)
            )
        axes.set(
            xlim=(0, sizes[across]),
            ylim=(0, sizes[up]),
            aspect="equal",
            xlabel=f"${'xyz'[across]}$",
            ylabel=f"${'xyz'[up]}$",
        )
    return figure

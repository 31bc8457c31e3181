"""g(r) of the colloids and its peaks."""

import numpy as np
from matplotlib.figure import Figure

from analysis import correlated_mean
from analysis.drawing import one_panel
from analysis.findings import Findings
from analysis.measures.settling_speed import sampled_frames
from analysis.radial_distribution import RadialDistribution, radial_distribution
from analysis.run_directory import RunDirectory

QUANTITIES = ("radial_distribution.peak_height",)

BINS = 50  # in a diameter
FRAMES = 400  # looked at, evenly spaced


def measure(run: RunDirectory) -> Findings:
    """Highest peak, and the distances of all that stand out."""
    used, diameter = np.flatnonzero(sampled_frames(run)), 2 * run.species().radius
    stride = max(1, len(used) // FRAMES)
    frames = used[::stride]
    positions = run.particles().positions[frames]
    largest = min(4 * diameter, min(run.box.sizes) / 2 - diameter / BINS)
    found = radial_distribution(positions, run.box.sizes, diameter / BINS, largest)
    highest = int(np.argmax(found.g))
    height = correlated_mean.mean(found.frames[:, highest], stride * run.interval)
    entry = {
        "peak_position": float(found.distance[highest]),
        "peak_height": height.as_json(),
        "peaks": found.peaks.tolist(),
        "peaks_over_radius": (found.peaks / (0.5 * diameter)).tolist(),
        "bin_width": diameter / BINS,
    }
    return Findings(
        {"radial_distribution": entry}, {"radial_distribution.png": draw(found, diameter)}
    )


def draw(found: RadialDistribution, diameter: float) -> Figure:
    """g(r), distances in radii as in the paper."""
    figure, axes = one_panel("distance $r$ [$R$]", "pair correlation $g(r)$")
    axes.plot(2 * found.distance / diameter, found.g, drawstyle="steps-mid", linewidth=1)
    axes.axhline(1, color="0.7", linewidth=0.8)
    axes.set_ylim(bottom=0)
    return figure

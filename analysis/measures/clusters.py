"""Clusters of colloids, and how they grow."""

import numpy as np
from matplotlib import colormaps
from matplotlib.figure import Figure
from numpy.typing import NDArray

from analysis import correlated_mean
from analysis.arrays import Array
from analysis.clusters import BOND, ClusterSeries, cluster_series, labels
from analysis.drawing import TIME, mark_equilibration, one_panel
from analysis.findings import Findings
from analysis.measures.settling_speed import sampled_frames
from analysis.run_directory import RunDirectory
from analysis.system_picture import draw as draw_system

QUANTITIES = ("clusters.largest", "clusters.number", "clusters.bonds_per_colloid", "clusters.alone")

FRAMES = 400  # looked at, evenly spaced
ALONE = (0.85, 0.85, 0.85, 1.0)  # colour


def measure(run: RunDirectory) -> Findings:
    """Largest cluster, number of clusters and bonds, as means over time and at the end."""
    particles, box, used = run.particles(), run.box, sampled_frames(run)
    distance = BOND * 2 * run.species().radius
    stride = max(1, len(used) // FRAMES)
    series = cluster_series(particles.positions[::stride], box.sizes, box.periodic, distance)
    late = used[::stride]
    entry: dict[str, object] = {
        name: correlated_mean.mean(getattr(series, name)[late], stride * run.interval).as_json()
        for name in ("largest", "number", "bonds_per_colloid", "alone")
    }
    entry["bond_length"] = distance
    entry["largest_at_end"] = int(series.largest[-1])
    times = run.times(particles.steps[::stride])
    label, _ = labels(particles.positions[-1], box.sizes, box.periodic, distance)
    pictures = {
        "clusters.png": draw(times, series, run.equilibration_time),
        "suspension.png": draw_system(run, colours=colours_of(label)),
    }
    return Findings({"clusters": entry}, pictures)


def draw(times: Array, series: ClusterSeries, equilibration: float) -> Figure:
    """Largest cluster, clusters and bonds against time."""
    figure, axes = one_panel(TIME, "colloids, clusters")
    axes.plot(times, series.largest, label="colloids in the largest cluster")
    axes.plot(times, series.number, label="clusters of two or more")
    axes.plot(times, series.alone, label="colloids alone")
    mark_equilibration(axes, equilibration)
    axes.legend()
    return figure


def colours_of(label: NDArray[np.int64]) -> Array:
    """Colours of colloids by their clusters, the largest first; colloids alone grey: (N, 4)."""
    sizes = np.bincount(label)
    rank = np.empty(len(sizes), dtype=np.int64)
    rank[np.argsort(-sizes, kind="stable")] = np.arange(len(sizes))
    colours = np.asarray(colormaps["tab20"](rank[label] % 20), dtype=float)
    colours[sizes[label] == 1] = ALONE
    return colours

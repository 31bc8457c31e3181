"""Clusters of colloids, and how they grow."""

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from analysis import correlated_mean
from analysis.arrays import Array
from analysis.clusters import BOND, ClusterSeries, cluster_series, labels
from analysis.drawing import TIME, mark_equilibration, one_panel
from analysis.findings import Findings
from analysis.measures.settling_speed import sampled_frames
from analysis.run_directory import RunDirectory

QUANTITIES = ("clusters.largest", "clusters.number", "clusters.bonds_per_colloid", "clusters.alone")

FRAMES = 400  # looked at, evenly spaced


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
        "suspension.png": draw_suspension(particles.positions[-1], label, box.sizes),
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


def draw_suspension(positions: Array, label: NDArray[np.int64], sizes: tuple[float, ...]) -> Figure:
    """The last frame, clusters by colour, colloids alone in grey."""
    figure = Figure(figsize=(6, 6), layout="constrained")
    axes = figure.add_subplot(projection="3d")
    sizes_of = np.bincount(label)
    colours = [f"C{each % 10}" if sizes_of[each] > 1 else "0.7" for each in label.tolist()]
    x, y, z = (positions % list(sizes)).T
    axes.scatter(x, y, z, c=colours, s=40, depthshade=True)
    for name in "xyz":
        getattr(axes, f"set_{name}label")(f"${name}$ [$a_0$]")
    return figure

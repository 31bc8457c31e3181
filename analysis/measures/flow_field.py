"""The flow of the fluid on a grid: stream lines over its speed."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from analysis.arrays import Array
from analysis.findings import Findings
from analysis.flow_grid import FlowField
from analysis.run_directory import RunDirectory
from run_files import RunDirectoryError

EMPTY = 0.2  # of the usual number of particles: bins in a colloid
BRIGHTEST = 0.99  # share of the bins that the colours tell apart


def measure(run: RunDirectory) -> Findings:
    """The picture of the mean flow after the equilibration; in 3D of the middle plane."""
    grid = run.manifest.system.flow
    assert grid is not None, "the scene lists this measure with a flow alone"
    try:
        field = run.field()
        used = run.flow_used(field)
    except RunDirectoryError:  # a run in progress
        if run.finished():
            raise
        return Findings()
    radius = run.manifest.system.species[0].radius if grid.around else 0.0
    return Findings(figures={"flow.png": draw(field.mean(used), radius)})


def draw(field: FlowField, radius: float = 0.0) -> Figure:
    """Stream lines over the speed, in the plane of x and y.

    Args:
        field: of one average.
        radius: of the colloid in the middle; 0 for none [a0].
    """
    x, y = field.axes[:2]
    width = 10.0
    figure = Figure(figsize=(width, _height(x, y, width)), layout="constrained")
    mesh = draw_flow(figure.subplots(), field, radius)
    figure.colorbar(mesh, label="speed of the fluid [$a_0/t_0$]", shrink=0.8)
    return figure


def draw_flow(
    axes: Axes, field: FlowField, radius: float = 0.0, fastest: float | None = None
) -> QuadMesh:
    """Stream lines over the speed, on axes of your own; what is returned, a colour bar may take.

    Args:
        field: of one average; in 3D its middle plane is drawn.
        radius: of the colloid in the middle; 0 for none [a0].
        fastest: speed of the brightest colour; default: that of the fastest hundredth [a0/t0].
    """
    x, y = field.axes[:2]
    velocity, counts = field.velocity[0], field.counts[0]
    if velocity.ndim == 4:
        middle = velocity.shape[2] // 2
        velocity, counts = velocity[:, :, middle], counts[:, :, middle]
    inside = counts < EMPTY * np.median(counts)
    vx, vy = (np.ma.masked_where(inside, velocity[..., axis]).T for axis in (0, 1))
    speed = np.ma.hypot(vx, vy)
    if fastest is None:
        fastest = float(np.quantile(speed.compressed(), BRIGHTEST)) if speed.count() else 1.0
    edges = [_edges(x), _edges(y)]
    mesh = axes.pcolormesh(*edges, speed, vmin=0, vmax=fastest, cmap="viridis", rasterized=True)
    axes.streamplot(x, y, vx, vy, color="white", linewidth=0.6, arrowsize=0.7, density=1.5)
    if radius:
        place = float(np.average(y, weights=inside.sum(axis=0) + 1e-9)) if inside.any() else 0.0
        axes.add_patch(Circle((0, place), radius, facecolor="0.8", edgecolor="black"))
    axes.set(xlabel="$x$ [$a_0$]", ylabel="$y$ [$a_0$]", aspect="equal")
    return mesh


def _edges(middles: Array) -> Array:
    step = middles[1] - middles[0] if len(middles) > 1 else 1.0
    return np.append(middles - step / 2, middles[-1] + step / 2)


def _height(x: Array, y: Array, width: float) -> float:
    return float(np.clip(0.85 * width * np.ptp(y) / max(np.ptp(x), 1e-9) + 1.2, 2.0, 9.0))

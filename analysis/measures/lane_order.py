"""The order parameter of lanes, across the field and as the paper prints it."""

from matplotlib.figure import Figure

from analysis import correlated_mean
from analysis.arrays import Array
from analysis.drawing import TIME, mark_equilibration, one_panel
from analysis.findings import Findings
from analysis.lane_order import (
    colour_structure,
    lane_order,
    lane_order_near,
    lane_order_printed,
)
from analysis.measures.settling_speed import sampled_frames
from analysis.run_directory import RunDirectory

QUANTITIES = ("lane_order", "lane_order_near", "lane_order_printed", "colour_structure")


def measure(run: RunDirectory) -> Findings:
    """Means over time of each and of the colours' structure factor; the history of two."""
    used, particles = sampled_frames(run), run.particles()
    where = (particles.positions, particles.species, run.box.sizes)
    order = lane_order(*where)
    near = lane_order_near(*where)
    printed = lane_order_printed(particles.positions[used], *where[1:])
    structure = colour_structure(particles.positions[used], *where[1:])
    picture = draw(run.times(particles.steps), order, near, run.equilibration_time)
    return Findings(
        {
            "lane_order": correlated_mean.mean(order[used]).as_json(),
            "lane_order_near": correlated_mean.mean(near[used]).as_json(),
            "lane_order_printed": correlated_mean.mean(printed).as_json(),
            "colour_structure": correlated_mean.mean(structure).as_json(),
        },
        {"lane_order.png": picture},
    )


def draw(times: Array, order: Array, near: Array, equilibration: float) -> Figure:
    """phi against time, of all particles and among neighbours.

    Args:
        times: (T,) [t0].
        order: of all, (T,).
        near: among neighbours, (T,).
        equilibration: end of what averages leave out [t0].
    """
    figure, axes = one_panel(TIME, r"lane order $\phi$, across the field")
    axes.plot(times, near, linewidth=1, label="among neighbours")
    axes.plot(times, order, linewidth=1, label="of all")
    axes.set_ylim(0, 1)
    axes.legend()
    mark_equilibration(axes, equilibration)
    return figure

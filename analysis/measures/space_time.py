"""Space-time picture: every colloid's place in the channel against time."""

import numpy as np
from matplotlib.figure import Figure

from analysis.arrays import Array
from analysis.chain import chain_of
from analysis.drawing import ALONG, TIME, one_panel
from analysis.findings import Findings
from analysis.run_directory import RunDirectory


def measure(run: RunDirectory) -> Findings:
    """The picture alone."""
    chain = chain_of(run)
    times = run.times(run.particles().steps)
    picture = draw(times, chain.x, run.length, run.equilibration_time)
    return Findings(figures={"space_time.png": picture})


def draw(times: Array, x: Array, length: float, equilibration: float) -> Figure:
    """Every colloid's place in the channel against time.

    Args:
        times: (T,) [t0].
        x: unwrapped positions, head first, (T, N) [a0].
        length: of the periodic channel [a0].
        equilibration: time averages leave out [t0].
    """
    figure, axes = one_panel(ALONG, TIME)
    count = x.shape[1]
    for colloid in range(count):
        place = np.mod(x[:, colloid], length)
        jumps = np.abs(np.diff(place)) > length / 2  # no line across the periodic boundary
        place[1:][jumps] = np.nan
        colour = (0.1 + 0.75 * colloid / max(1, count - 1), 0.2, 0.5)
        axes.plot(place, times, linewidth=0.8, color=colour)
    if equilibration > 0:
        axes.axhspan(0, equilibration, color="0.92", zorder=0)
    axes.set_xlim(0, length)
    axes.set_title("colloids, head (blue) to tail (red)", fontsize="medium")
    return figure

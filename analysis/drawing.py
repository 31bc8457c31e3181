"""The look of the figures of a run; lengths in a0, times in t0."""

from matplotlib.axes import Axes
from matplotlib.figure import Figure

TIME = "time $t$ [$t_0$]"
ALONG = "along the channel $x$ [$a_0$]"


def one_panel(x_label: str, y_label: str) -> tuple[Figure, Axes]:
    """A figure with one pair of axes; both."""
    figure = Figure(figsize=(7, 4.5), layout="constrained")
    axes = figure.subplots()
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    return figure, axes


def mark_equilibration(axes: Axes, equilibration: float) -> None:
    """Shade the time that averages leave out."""
    if equilibration > 0:
        axes.axvspan(0, equilibration, color="0.92", zorder=0, label="equilibration")

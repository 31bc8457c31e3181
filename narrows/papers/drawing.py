"""The look of the figures: ours in blue and its neighbours, the paper's numbers in red."""

import math
from collections.abc import Sequence
from typing import Any

from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from analysis.estimate import Estimate

PAPER = "#c8102e"
COLOURS = ("#1f5fa8", "#e08a1e", "#2e8b57", "#7b4fa3", "#6b6b6b", "#17a2b8")
MARKERS = ("o", "s", "^", "D", "v", "P")

STYLE: Any = {
    "font.family": "sans-serif",
    "font.size": 10,
    "axes.labelsize": 10.5,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.8,
    "axes.prop_cycle": f"cycler('color', {list(COLOURS)})",
    "errorbar.capsize": 2.0,
    "legend.fontsize": 8.5,
    "legend.frameon": False,
    "lines.linewidth": 1.4,
    "lines.markersize": 5.0,
    "savefig.dpi": 170,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "pdf.fonttype": 42,
}

SPEED = "settling speed $v_s$  [$a_0/t_0$]"
FRACTION = r"volume fraction  $\phi = N_c \pi r_c^2 / (L_x L_y)$"


def one_panel(x_label: str, y_label: str, size: tuple[float, float] = (6.2, 4.1)) -> Any:
    """A figure with one pair of axes; both."""
    figure = Figure(figsize=size, layout="constrained")
    axes = figure.subplots()
    axes.set(xlabel=x_label, ylabel=y_label)
    return figure, axes


def shades(count: int) -> list[tuple[float, ...]]:
    """Colours of an ordered series, from dark to light."""
    return [tuple(colormaps["viridis"](0.9 * i / max(1, count - 1))) for i in range(count)]


def points(
    axes: Axes, x: Sequence[float], y: Sequence[Estimate], number: int = 0, **words: Any
) -> None:
    """Measured points with error bars, in the colour and with the marker of a series."""
    look = {"color": COLOURS[number % 6], "marker": MARKERS[number % 6], "linestyle": "none"}
    values = [math.nan if estimate.value is None else estimate.value for estimate in y]
    errors = [estimate.error or 0.0 for estimate in y]
    axes.errorbar(x, values, errors, elinewidth=1.0, **(look | words))


def paper_line(axes: Axes, x: Any, y: Any, label: str, **words: Any) -> None:
    """A line of the paper."""
    style: dict[str, Any] = {"color": PAPER, "linestyle": "--", "linewidth": 1.4, "zorder": 1}
    axes.plot(x, y, label=label, **(style | words))


def paper_remark(axes: Axes, x: float, y: float, text: str, **words: Any) -> None:
    """What the paper says in words, placed in fractions of the axes."""
    axes.text(x, y, text, color=PAPER, fontsize=8.5, transform=axes.transAxes, **words)

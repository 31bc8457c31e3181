"""Settling speed against volume fraction: what Figs. 4.3 to 4.8 share.

The thesis fits v_s = 0.15 phi + 0.019 to Fig. 4.6; the line is drawn in all of them.
"""

from collections.abc import Iterable, Sequence

import numpy as np
from matplotlib.axes import Axes

from analysis.estimate import Estimate
from analysis.line_fit import weighted_mean
from narrows.papers.drawing import paper_line
from narrows.papers.figure import Column
from narrows.papers.results import PaperNumber
from narrows.papers.tabatabaei_2009.state_points import Speed, fit

SLOPE, INTERCEPT = PaperNumber.printed("0.15"), PaperNumber.printed("0.019")
DILUTE = 0.015  # phi below which the thesis finds v_s of one colloid constant
FITTED_FROM = 0.02  # phi from which the line is fitted: "beyond small volume fractions"


def speed_table(series: Iterable[tuple[str, Sequence[Speed]]]) -> dict[str, Column]:
    """All that was measured, a row for each point, by the name of its series."""
    rows = [(name, entries) for name, many in series for entries in many]
    return {
        "series": [name for name, _ in rows],
        "length_a0": [entries.point.length for _, entries in rows],
        "colloids": [entries.point.colloids for _, entries in rows],
        "volume_fraction": [entries.point.fraction for _, entries in rows],
        "density_per_a0^2": [entries.point.density for _, entries in rows],
        "runs": [len(entries.point.scenes) for _, entries in rows],
        "duration_t0": [entries.point.scenes[0].duration for _, entries in rows],
        "v_s": [entries.co_moving.value for _, entries in rows],
        "v_s_error": [entries.co_moving.error for _, entries in rows],
        "v_rest": [entries.rest.value for _, entries in rows],
        "v_rest_error": [entries.rest.error for _, entries in rows],
        "rms_off_mid_line_a0": [entries.off_mid_line for _, entries in rows],
    }


def fractions(entries: Sequence[Speed]) -> list[float]:
    """Volume fraction of each point."""
    return [entry.point.fraction for entry in entries]


def co_moving(entries: Sequence[Speed]) -> list[Estimate]:
    """Settling speed of each point in the co-moving frame [a0/t0]."""
    return [entry.co_moving for entry in entries]


def slope_in_fraction(entries: Sequence[Speed]) -> Estimate:
    """dv_s/dphi [a0/t0]."""
    return fit(fractions(entries), co_moving(entries))[1]


def mean_above_line(entries: Sequence[Speed]) -> Estimate:
    """v_s less the thesis' line, over the points where the line was fitted [a0/t0]."""
    fitted = [entry for entry in entries if entry.point.fraction > FITTED_FROM]
    lines = [SLOPE.value * phi + INTERCEPT.value for phi in fractions(fitted)]
    return weighted_mean(
        [entry.co_moving - line for entry, line in zip(fitted, lines, strict=True)]
    )


def draw_line_of_4_6(axes: Axes, entries: Sequence[Speed]) -> None:
    """The thesis' line over the volume fractions of these points."""
    ends = np.array([0.0, 1.05 * max(fractions(entries))])
    label = r"thesis, fit of Fig. 4.6: $0.15\,\phi + 0.019$"
    paper_line(axes, ends, SLOPE.value * ends + INTERCEPT.value, label)

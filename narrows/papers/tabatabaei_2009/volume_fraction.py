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
from narrows.papers.tabatabaei_2009.state_points import Speed, difference, fit

SLOPE, INTERCEPT = PaperNumber.printed("0.15"), PaperNumber.printed("0.019")
DILUTE = 0.015  # phi below which the thesis finds v_s of one colloid constant
FITTED_FROM = 0.02  # phi from which the line is fitted: "beyond small volume fractions"


def speed_table(series: Iterable[tuple[str, Sequence[Speed]]]) -> dict[str, Column]:
    """All that was measured, a row for each point, by the name of its series."""
    rows = [(name, found) for name, many in series for found in many]
    return {
        "series": [name for name, _ in rows],
        "length_a0": [found.point.length for _, found in rows],
        "colloids": [found.point.colloids for _, found in rows],
        "volume_fraction": [found.point.fraction for _, found in rows],
        "density_per_a0^2": [found.point.density for _, found in rows],
        "runs": [len(found.point.scenes) for _, found in rows],
        "duration_t0": [found.point.scenes[0].duration for _, found in rows],
        "v_s": [found.co_moving.value for _, found in rows],
        "v_s_error": [found.co_moving.error for _, found in rows],
        "v_rest": [found.rest.value for _, found in rows],
        "v_rest_error": [found.rest.error for _, found in rows],
        "rms_off_mid_line_a0": [found.off_mid_line for _, found in rows],
    }


def fractions(found: Sequence[Speed]) -> list[float]:
    """Volume fraction of each point."""
    return [one.point.fraction for one in found]


def co_moving(found: Sequence[Speed]) -> list[Estimate]:
    """Settling speed of each point in the co-moving frame [a0/t0]."""
    return [one.co_moving for one in found]


def slope_in_fraction(found: Sequence[Speed]) -> Estimate:
    """dv_s/dphi [a0/t0]."""
    return fit(fractions(found), co_moving(found))[1]


def mean_above_line(found: Sequence[Speed]) -> Estimate:
    """v_s less the thesis' line, over the points where the line was fitted [a0/t0]."""
    fitted = [one for one in found if one.point.fraction > FITTED_FROM]
    lines = [SLOPE.value * phi + INTERCEPT.value for phi in fractions(fitted)]
    return weighted_mean(
        [
            difference(one.co_moving, Estimate(line, 0.0))
            for one, line in zip(fitted, lines, strict=True)
        ]
    )


def draw_line_of_4_6(axes: Axes, found: Sequence[Speed]) -> None:
    """The thesis' line over the volume fractions of these points."""
    ends = np.array([0.0, 1.05 * max(fractions(found))])
    label = r"thesis, fit of Fig. 4.6: $0.15\,\phi + 0.019$"
    paper_line(axes, ends, SLOPE.value * ends + INTERCEPT.value, label)

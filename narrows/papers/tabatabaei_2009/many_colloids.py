"""Ever more colloids in channels of fixed length: Figs. 4.6, 4.7 and 5.1."""

from collections.abc import Sequence

import numpy as np

from narrows.papers.drawing import (
    FRACTION,
    SPEED,
    one_panel,
    paper_line,
    points,
)
from narrows.papers.figure import Column, Directories, Outcome, PaperFigure, Quality
from narrows.papers.results import PaperNumber, claimed, compared, measured
from narrows.papers.tabatabaei_2009.few_colloids import few_colloids
from narrows.papers.tabatabaei_2009.state_points import (
    Point,
    Speed,
    channel_point,
    fit,
    scenes_of,
    speed,
)
from narrows.papers.tabatabaei_2009.volume_fraction import (
    DILUTE,
    FITTED_FROM,
    INTERCEPT,
    SLOPE,
    co_moving,
    draw_line_of_4_6,
    fractions,
    slope_in_fraction,
    speed_table,
)

REST_SLOPE, REST_INTERCEPT = PaperNumber.printed("5.71"), PaperNumber.printed("0.019")  # 5.1


def many_colloids(length: int, quality: Quality) -> list[Point]:
    """Channels of one length with ever more colloids: Figs. 4.6, 4.7 and 5.1."""
    full = {
        1000: [(5, 2, 1000.0), (10, 2, 1000.0)]
        + [(number, 1, 500.0) for number in (20, 40, 60, 80, 100)],
        600: [(6, 1, 1000.0)] + [(number, 1, 500.0) for number in (12, 24, 36, 48, 60)],
        260: [(number, 1, 1000.0) for number in (2, 4, 8, 13, 18, 22, 26)],
        100: [(number, 3, 1000.0) for number in range(4, 11)],
    }
    quick = {
        1000: [(20, 1, 150.0), (60, 1, 150.0)],
        600: [(12, 1, 200.0), (36, 1, 200.0)],
        260: [(4, 1, 500.0), (13, 1, 500.0), (26, 1, 500.0)],
        100: [(5, 1, 1000.0), (10, 1, 1000.0)],
    }
    table = (full if quality == "full" else quick)[length]
    shared = [
        point
        for number in (1, 2, 3)
        for point in few_colloids(number, quality)
        if point.length == length
    ]
    return shared + [channel_point(length, number, seeds, time) for number, seeds, time in table]


LENGTHS = (1000, 600, 260)


def _by_length(
    directories: Directories, quality: Quality, lengths: Sequence[int]
) -> dict[int, list[Speed]]:
    return {
        length: sorted(
            (speed(directories, point) for point in many_colloids(length, quality)),
            key=lambda entry: entry.point.colloids,
        )
        for length in lengths
    }


def _by_length_table(by_length: dict[int, list[Speed]]) -> dict[str, Column]:
    return speed_table((f"L_x = {length}", entries) for length, entries in by_length.items())


def _figure_4_6(directories: Directories, quality: Quality) -> Outcome:
    by_length = _by_length(directories, quality, LENGTHS)
    figure, axes = one_panel(FRACTION, SPEED)
    for number, (length, entries) in enumerate(by_length.items()):
        points(axes, fractions(entries), co_moving(entries), number, label=f"$L_x$ = {length}")
    everything = [entry for entries in by_length.values() for entry in entries]
    fitted = [entry for entry in everything if entry.point.fraction > FITTED_FROM]
    intercept, slope = fit(fractions(fitted), co_moving(fitted))
    ends = np.array([FITTED_FROM, 1.03 * max(fractions(fitted))])
    label = rf"our fit: ${slope.number:.3f}\,\phi + {intercept.number:.4f}$"
    axes.plot(ends, slope.number * ends + intercept.number, color="0.25", label=label)
    draw_line_of_4_6(axes, everything)
    axes.set(xlim=(0, None), ylim=(0, None))
    axes.legend(loc="lower right")
    window = f"fitted for phi > {FITTED_FROM:g}, in the first 1100 t0 after the release"
    results = [
        compared("4.6", "slope a of v_s = a phi + b [a0/t0]", slope, SLOPE, window),
        compared("4.6", "intercept b of v_s = a phi + b [a0/t0]", intercept, INTERCEPT, window),
    ]
    small = [entry for entry in by_length[1000] if entry.point.fraction < DILUTE]
    if len(small) > 1:
        results.append(
            claimed(
                "4.6",
                "minus the slope dv_s/dphi for phi < 0.015, L_x = 1000 [a0/t0]",
                slope_in_fraction(small).scaled(-1.0),
                "for small phi v_s shows a reduction",
                "positive",
                "the rise expected of a = 0.15 over this range is 0.002",
            )
        )
    return Outcome(figure, _by_length_table(by_length), results)


def _figure_4_7(directories: Directories, quality: Quality) -> Outcome:
    by_length = _by_length(directories, quality, (*LENGTHS, 100))
    figure, axes = one_panel("number of colloids $N_c$", SPEED)
    slopes = {}
    for number, (length, entries) in enumerate(by_length.items()):
        counts = [entry.point.colloids for entry in entries]
        points(axes, counts, co_moving(entries), number, label=f"$L_x$ = {length}")
        ends = np.array([0.0, max(counts)])
        share = entries[0].point.fraction / entries[0].point.colloids
        label = r"thesis, $0.15\,\phi + 0.019$ at each length" if number == 0 else "_"
        paper_line(axes, ends, SLOPE.value * share * ends + INTERCEPT.value, label, linewidth=1.0)
        slopes[length] = fit(counts, co_moving(entries))[1]
    axes.set(xlim=(0, None), ylim=(0, None))
    axes.legend(loc="lower right")
    short, long = slopes[100], slopes[1000]
    results = [
        claimed(
            "4.7",
            "slope dv_s/dN_c at L_x = 100 less that at 1000 [a0/t0]",
            short - long,
            "v_s rises much faster with N_c at L_x = 100 than at 1000",
            "positive",
        )
    ]
    results.append(
        measured(
            "4.7",
            "ratio of the slopes dv_s/dN_c at L_x = 100 and 1000",
            short / long,
            "10 if v_s depends on phi alone",
        )
    )
    return Outcome(figure, _by_length_table(by_length), results)


def _figure_5_1(directories: Directories, quality: Quality) -> Outcome:
    entries = _by_length(directories, quality, [100])[100]
    densities = [entry.point.density for entry in entries]
    rest = [entry.rest for entry in entries]
    intercept, slope = fit(densities, rest)
    figure, axes = one_panel(
        r"density of colloids  $\rho = N_c / (L_x L_y)$  [$a_0^{-2}$]",
        "mean velocity at rest frame  [$a_0/t_0$]",
    )
    ends = np.array([0.0, 1.05 * max(densities)])
    points(axes, densities, rest, label="100 x 10, frame at rest")
    label = rf"our fit: ${slope.number:.2f}\,\rho + {intercept.number:.4f}$"
    axes.plot(ends, slope.number * ends + intercept.number, label=label)
    paper_line(
        axes,
        ends,
        REST_SLOPE.value * ends + REST_INTERCEPT.value,
        r"thesis: $5.71\,\rho + 0.019$",
    )
    axes.set(xlim=(0, None), ylim=(0, None))
    axes.legend(loc="lower right")
    results = [
        compared("5.1", "slope c of v = c rho + c' at rest [a0^3/t0]", slope, REST_SLOPE),
        compared("5.1", "intercept c' of v = c rho + c' [a0/t0]", intercept, REST_INTERCEPT),
        claimed(
            "5.1",
            "coefficient of rho^2 when a parabola is fitted [a0^5/t0]",
            fit(densities, rest, 2)[2],
            "a linear increase",
            "zero",
        ),
    ]
    return Outcome(figure, speed_table([("L_x = 100", entries)]), results)


FIGURES = (
    PaperFigure(
        "4.6",
        "Settling speed against volume fraction at fixed length: 1000, 600 and 260.",
        _figure_4_6,
        lambda quality: scenes_of(p for n in LENGTHS for p in many_colloids(n, quality)),
    ),
    PaperFigure(
        "4.7",
        "Settling speed against the number of colloids at fixed length, 100 to 1000.",
        _figure_4_7,
        lambda quality: scenes_of(p for n in (*LENGTHS, 100) for p in many_colloids(n, quality)),
    ),
    PaperFigure(
        "5.1",
        "Mean velocity of the colloids in the frame at rest against their density, 100 x 10.",
        _figure_5_1,
        lambda quality: scenes_of(many_colloids(100, quality)),
    ),
)

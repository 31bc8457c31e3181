"""Settling speeds: Figs. 4.3 to 4.8 against volume fraction, length and number, and Fig. 5.1."""

import math
from collections.abc import Iterable, Sequence

import numpy as np
from matplotlib.axes import Axes

from analysis.blocking import Estimate
from analysis.line_fit import weighted_mean
from lammps_inputs.scene import Hydrodynamics
from narrows.reproduce.drawing import (
    FRACTION,
    PAPER,
    SPEED,
    one_panel,
    paper_line,
    paper_remark,
    points,
)
from narrows.reproduce.paper_figure import Column, Folders, Outcome, PaperFigure, Quality
from narrows.reproduce.results import PaperNumber, Result, claimed, compared, measured
from narrows.reproduce.tabatabaei_2009.state_points import (
    Point,
    Speed,
    difference,
    fit,
    point,
    scenes_of,
    speed,
)

DILUTE = 0.015  # phi below which the thesis finds v_s of one colloid constant
SLOPE, INTERCEPT = PaperNumber.printed("0.15"), PaperNumber.printed("0.019")  # of Fig. 4.6
REST_SLOPE, REST_INTERCEPT = PaperNumber.printed("5.71"), PaperNumber.printed("0.019")  # 5.1
FITTED_FROM = 0.02  # phi from which the line is fitted: "beyond small volume fractions"


def few_colloids(number: int, quality: Quality) -> list[Point]:
    """One, two or three colloids in channels of many lengths: Figs. 4.3 to 4.5 and 4.8."""
    seeds: dict[int, dict[int, int]] = {
        1: {40: 16, 60: 12, 80: 10, 100: 10, 150: 6, 200: 5, 300: 4, 500: 3, 1000: 2},
        2: {100: 6, 150: 5, 200: 4, 300: 3, 500: 2, 1000: 2},
        3: {100: 5, 150: 4, 250: 3, 400: 2, 600: 2, 1000: 1},
    }
    quick: dict[int, dict[int, int]] = {
        1: {40: 4, 80: 2, 150: 1, 300: 1},
        2: {100: 2, 200: 1, 300: 1},
        3: {100: 2, 250: 1},
    }
    table = (seeds if quality == "full" else quick)[number]
    return [point(length, number, count) for length, count in table.items()]


def many_colloids(length: int, quality: Quality) -> list[Point]:
    """Channels of one length with ever more colloids: Figs. 4.6, 4.7 and 5.1."""
    full = {
        1000: [(5, 1, 1000.0), (10, 1, 1000.0)]
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
        where
        for number in (1, 2, 3)
        for where in few_colloids(number, quality)
        if where.length == length
    ]
    return shared + [point(length, number, seeds, time) for number, seeds, time in table]


def without_interactions(solvent: Hydrodynamics, quality: Quality) -> list[Point]:
    """Two colloids in a random solvent, Fig. 4.8."""
    durations = {100: 600.0, 200: 400.0, 500: 200.0, 1000: 120.0}
    if quality == "quick":
        durations = {100: 150.0, 300: 75.0}
    return [
        point(length, 2, 1, time, hydrodynamics=solvent, equilibration=25.0)
        for length, time in durations.items()
    ]


def _table(series: Iterable[tuple[str, Sequence[Speed]]]) -> dict[str, Column]:
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


def _fractions(found: Sequence[Speed]) -> list[float]:
    return [one.point.fraction for one in found]


def _co_moving(found: Sequence[Speed]) -> list[Estimate]:
    return [one.co_moving for one in found]


def _slope(found: Sequence[Speed]) -> Estimate:
    """dv_s/dphi [a0/t0]."""
    return fit(_fractions(found), _co_moving(found))[1]


def _draw_line_of_4_6(axes: Axes, fractions: Sequence[float]) -> None:
    ends = np.array([0.0, 1.05 * max(fractions)])
    label = r"thesis, fit of Fig. 4.6: $0.15\,\phi + 0.019$"
    paper_line(axes, ends, SLOPE.value * ends + INTERCEPT.value, label)


def _figure_4_3(folders: Folders, quality: Quality) -> Outcome:
    found = [speed(folders, where) for where in few_colloids(1, quality)]
    dilute = [one for one in found if one.point.fraction < DILUTE]
    plateau = weighted_mean(_co_moving(dilute))
    figure, axes = one_panel(FRACTION, SPEED)
    axes.axvspan(0, DILUTE, color=PAPER, alpha=0.07, linewidth=0)
    paper_remark(axes, 0.02, 0.03, "thesis: constant here", va="bottom")
    points(axes, _fractions(found), _co_moving(found), label="one colloid, $L_x$ from 40 to 1000")
    axes.plot([0, DILUTE], [plateau.value] * 2, label=f"mean below {DILUTE:g}: {plateau.value:.4f}")
    _draw_line_of_4_6(axes, _fractions(found))
    axes.set(xlim=(0, None), ylim=(0, None))
    axes.legend(loc="lower right")
    shortest = found[0]
    same_line = (
        "beside the slope of Fig. 4.6: one colloid and its periodic images should follow the same "
        "line in phi as many do, which rises by 0.002 only up to phi = 0.015"
    )
    results = [
        measured("4.3", "mean v_s of one colloid for phi < 0.015 [a0/t0]", plateau),
        claimed(
            "4.3",
            "slope dv_s/dphi of one colloid for phi < 0.015 [a0/t0]",
            _slope(dilute),
            "v_s is constant below phi of 0.015",
            "zero",
        ),
        claimed(
            "4.3",
            f"v_s at L_x {shortest.point.length:g} less the mean for phi < 0.015 [a0/t0]",
            difference(shortest.co_moving, plateau),
            "v_s increases for smaller length",
            "positive",
        ),
        compared(
            "4.3", "slope dv_s/dphi over all lengths [a0/t0]", _slope(found), SLOPE, same_line
        ),
    ]
    return Outcome(figure, _table([("one colloid", found)]), results)


def _few(folders: Folders, quality: Quality) -> dict[int, list[Speed]]:
    return {
        number: [speed(folders, where) for where in few_colloids(number, quality)]
        for number in (1, 2, 3)
    }


def _named(few: dict[int, list[Speed]]) -> list[tuple[str, Sequence[Speed]]]:
    return [(f"N_c = {number}", found) for number, found in few.items()]


def _figure_4_4(folders: Folders, quality: Quality) -> Outcome:
    few = _few(folders, quality)
    figure, axes = one_panel(FRACTION, SPEED)
    for number, found in few.items():
        points(axes, _fractions(found), _co_moving(found), number - 1, label=f"$N_c$ = {number}")
    everything = [one for found in few.values() for one in found]
    _draw_line_of_4_6(axes, _fractions(everything))
    axes.set(xlim=(0, None), ylim=(0, None))
    axes.legend(loc="lower right")
    results = [
        claimed(
            "4.4",
            f"slope dv_s/dphi, N_c = {number} [a0/t0]",
            _slope(few[number]),
            "v_s of two and of three colloids increases with phi",
            "positive",
        )
        for number in (2, 3)
    ]
    intercept, slope = fit(_fractions(everything), _co_moving(everything))
    note = "one line through N_c = 1, 2 and 3"
    results += [
        compared("4.4", "slope dv_s/dphi of all three [a0/t0]", slope, SLOPE, note),
        compared("4.4", "v_s at phi = 0 of all three [a0/t0]", intercept, INTERCEPT, note),
    ]
    return Outcome(figure, _table(_named(few)), results)


def _figure_4_5(folders: Folders, quality: Quality) -> Outcome:
    few = {number: found for number, found in _few(folders, quality).items() if number > 1}
    figure, axes = one_panel("length of the channel $L_x$  [$a_0$]", SPEED)
    results: list[Result] = []
    for number, found in few.items():
        lengths = [one.point.length for one in found]
        points(axes, lengths, _co_moving(found), number - 1, label=f"$N_c$ = {number}")
        fine = np.geomspace(min(lengths), max(lengths), 200)
        fraction = found[0].point.fraction * lengths[0] / fine
        label = r"thesis, $0.15\,\phi + 0.019$ at $N_c$ = 2 and 3" if number == 2 else ""
        paper_line(axes, fine, SLOPE.value * fraction + INTERCEPT.value, label or "_")
        short, long = found[0], found[-1]
        results.append(
            claimed(
                "4.5",
                f"v_s at L_x {short.point.length:g} less at {long.point.length:g}, "
                f"N_c = {number} [a0/t0]",
                difference(short.co_moving, long.co_moving),
                "finite-size effects raise v_s at small L_x",
                "positive",
            )
        )
    axes.set(xscale="log", ylim=(0, None))
    ticks = [100, 200, 300, 500, 1000] if quality == "full" else [100, 200, 300]
    axes.set_xticks(ticks, [str(tick) for tick in ticks])
    axes.minorticks_off()
    axes.legend(loc="lower left")
    return Outcome(figure, _table(_named(few)), results)


LENGTHS = (1000, 600, 260)


def _by_length(
    folders: Folders, quality: Quality, lengths: Sequence[int]
) -> dict[int, list[Speed]]:
    return {
        length: sorted(
            (speed(folders, where) for where in many_colloids(length, quality)),
            key=lambda one: one.point.colloids,
        )
        for length in lengths
    }


def _by_length_table(by_length: dict[int, list[Speed]]) -> dict[str, Column]:
    return _table((f"L_x = {length}", found) for length, found in by_length.items())


def _figure_4_6(folders: Folders, quality: Quality) -> Outcome:
    by_length = _by_length(folders, quality, LENGTHS)
    figure, axes = one_panel(FRACTION, SPEED)
    for number, (length, found) in enumerate(by_length.items()):
        points(axes, _fractions(found), _co_moving(found), number, label=f"$L_x$ = {length}")
    everything = [one for found in by_length.values() for one in found]
    fitted = [one for one in everything if one.point.fraction > FITTED_FROM]
    intercept, slope = fit(_fractions(fitted), _co_moving(fitted))
    assert slope.value is not None
    assert intercept.value is not None
    ends = np.array([FITTED_FROM, 1.03 * max(_fractions(fitted))])
    label = rf"our fit: ${slope.value:.3f}\,\phi + {intercept.value:.4f}$"
    axes.plot(ends, slope.value * ends + intercept.value, color="0.25", label=label)
    _draw_line_of_4_6(axes, _fractions(everything))
    axes.set(xlim=(0, None), ylim=(0, None))
    axes.legend(loc="lower right")
    window = f"fitted for phi > {FITTED_FROM:g}, in the first 1100 t0 after the release"
    results = [
        compared("4.6", "slope a of v_s = a phi + b [a0/t0]", slope, SLOPE, window),
        compared("4.6", "intercept b of v_s = a phi + b [a0/t0]", intercept, INTERCEPT, window),
    ]
    small = [one for one in by_length[1000] if one.point.fraction < DILUTE]
    if len(small) > 1:
        results.append(
            claimed(
                "4.6",
                "minus the slope dv_s/dphi for phi < 0.015, L_x = 1000 [a0/t0]",
                _slope(small).scaled(-1.0),
                "for small phi v_s shows a reduction",
                "positive",
                "the rise expected of a = 0.15 over this range is 0.002",
            )
        )
    return Outcome(figure, _by_length_table(by_length), results)


def _figure_4_7(folders: Folders, quality: Quality) -> Outcome:
    by_length = _by_length(folders, quality, (*LENGTHS, 100))
    figure, axes = one_panel("number of colloids $N_c$", SPEED)
    slopes = {}
    for number, (length, found) in enumerate(by_length.items()):
        counts = [one.point.colloids for one in found]
        points(axes, counts, _co_moving(found), number, label=f"$L_x$ = {length}")
        ends = np.array([0.0, max(counts)])
        share = found[0].point.fraction / found[0].point.colloids
        label = r"thesis, $0.15\,\phi + 0.019$ at each length" if number == 0 else "_"
        paper_line(axes, ends, SLOPE.value * share * ends + INTERCEPT.value, label, linewidth=1.0)
        slopes[length] = fit(counts, _co_moving(found))[1]
    axes.set(xlim=(0, None), ylim=(0, None))
    axes.legend(loc="lower right")
    short, long = slopes[100], slopes[1000]
    results = [
        claimed(
            "4.7",
            "slope dv_s/dN_c at L_x = 100 less that at 1000 [a0/t0]",
            difference(short, long),
            "v_s rises much faster with N_c at L_x = 100 than at 1000",
            "positive",
        )
    ]
    assert short.value is not None
    assert short.error is not None
    assert long.value is not None
    assert long.error is not None
    ratio = short.value / long.value
    relative = math.hypot(short.error / short.value, long.error / long.value)
    results.append(
        measured(
            "4.7",
            "ratio of the slopes dv_s/dN_c at L_x = 100 and 1000",
            Estimate(ratio, abs(ratio) * relative),
            "10 if v_s depends on phi alone",
        )
    )
    return Outcome(figure, _by_length_table(by_length), results)


SOLVENTS: tuple[tuple[Hydrodynamics, str], ...] = (
    ("shuffle", "velocities interchanged"),
    ("bath", "velocities redrawn"),
)


def _figure_4_8(folders: Folders, quality: Quality) -> Outcome:
    off = {
        solvent: [speed(folders, where) for where in without_interactions(solvent, quality)]
        for solvent, _ in SOLVENTS
    }
    on = [speed(folders, where) for where in few_colloids(2, quality)]
    figure, axes = one_panel(FRACTION, SPEED)
    for number, (solvent, words) in enumerate(SOLVENTS):
        found = off[solvent]
        points(axes, _fractions(found), _co_moving(found), number, label=f"off: {words}")
    points(axes, _fractions(on), _co_moving(on), 2, label="hydrodynamics on")
    _draw_line_of_4_6(axes, _fractions(on))
    axes.axhline(0, color="0.7", linewidth=0.8, zorder=0)
    paper_remark(
        axes, 0.98, 0.26, "thesis: without hydrodynamics\nno correlation with $\\phi$", ha="right"
    )
    axes.set(xlim=(0, None))
    axes.legend(loc="center right", bbox_to_anchor=(1.0, 0.5))
    means = {solvent: weighted_mean(_co_moving(found)) for solvent, found in off.items()}
    results = [
        claimed(
            "4.8",
            f"slope dv_s/dphi, {words} [a0/t0]",
            _slope(off[solvent]),
            "without hydrodynamic interactions v_s does not depend on phi",
            "zero",
        )
        for solvent, words in SOLVENTS
    ]
    results += [
        claimed(
            "4.8",
            "slope dv_s/dphi with hydrodynamics less that without [a0/t0]",
            difference(_slope(on), weighted_mean([_slope(found) for found in off.values()])),
            "the increase is an effect of hydrodynamic interactions",
            "positive",
        ),
        claimed(
            "4.8",
            "mean v_s, velocities interchanged less redrawn [a0/t0]",
            difference(means["shuffle"], means["bath"]),
            "similar results in the two cases",
            "zero",
        ),
    ]
    results += [
        measured(
            "4.8",
            f"mean v_s, {words} [a0/t0]",
            means[solvent],
            "far below v_s with hydrodynamics: a fluid that forgets its velocity at every "
            "collision diffuses past the colloid, which almost fills the slit, and cannot flow",
        )
        for solvent, words in SOLVENTS
    ]
    table = _table([*((f"off: {words}", off[solvent]) for solvent, words in SOLVENTS), ("on", on)])
    return Outcome(figure, table, results)


def _figure_5_1(folders: Folders, quality: Quality) -> Outcome:
    found = _by_length(folders, quality, [100])[100]
    densities = [one.point.density for one in found]
    rest = [one.rest for one in found]
    intercept, slope = fit(densities, rest)
    assert slope.value is not None
    assert intercept.value is not None
    figure, axes = one_panel(
        r"density of colloids  $\rho = N_c / (L_x L_y)$  [$a_0^{-2}$]",
        "mean velocity at rest frame  [$a_0/t_0$]",
    )
    ends = np.array([0.0, 1.05 * max(densities)])
    points(axes, densities, rest, label="100 x 10, frame at rest")
    label = rf"our fit: ${slope.value:.2f}\,\rho + {intercept.value:.4f}$"
    axes.plot(ends, slope.value * ends + intercept.value, label=label)
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
    return Outcome(figure, _table([("L_x = 100", found)]), results)


FIGURES = (
    PaperFigure(
        "4.3",
        "Settling speed of a single colloid against volume fraction: the length of the channel "
        "varies from 40 to 1000.",
        _figure_4_3,
        lambda quality: scenes_of(few_colloids(1, quality)),
    ),
    PaperFigure(
        "4.4",
        "Settling speed of one, two and three colloids against volume fraction.",
        _figure_4_4,
        lambda quality: scenes_of(p for n in (1, 2, 3) for p in few_colloids(n, quality)),
    ),
    PaperFigure(
        "4.5",
        "Settling speed of two and three colloids against the length of the channel.",
        _figure_4_5,
        lambda quality: scenes_of(p for n in (1, 2, 3) for p in few_colloids(n, quality)),
    ),
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
        "4.8",
        "Settling speed of two colloids without hydrodynamic interactions, by both methods.",
        _figure_4_8,
        lambda quality: scenes_of(
            [
                *(p for solvent, _ in SOLVENTS for p in without_interactions(solvent, quality)),
                *few_colloids(2, quality),
            ]
        ),
    ),
)

FIGURE_5_1 = PaperFigure(
    "5.1",
    "Mean velocity of the colloids in the frame at rest against their density, 100 x 10.",
    _figure_5_1,
    lambda quality: scenes_of(many_colloids(100, quality)),
)

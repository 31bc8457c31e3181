"""One, two and three colloids in channels of many lengths: Figs. 4.3 to 4.5 and 4.8."""

from collections.abc import Sequence

import numpy as np

from analysis.line_fit import weighted_mean
from lammps_inputs.system import Hydrodynamics
from narrows.papers.drawing import (
    FRACTION,
    PAPER,
    SPEED,
    one_panel,
    paper_line,
    paper_remark,
    points,
)
from narrows.papers.figure import Directories, Outcome, PaperFigure, Quality
from narrows.papers.results import PaperNumber, Result, claimed, compared, measured
from narrows.papers.tabatabaei_2009.state_points import (
    Point,
    Speed,
    channel_point,
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
    mean_above_line,
    slope_in_fraction,
    speed_table,
)

LESS_LINE = f"v_s less 0.15 phi + 0.019, mean over phi > {FITTED_FROM:g} [a0/t0]"
ON_LINE = PaperNumber(0.0, INTERCEPT.reading)
CROWDS = (5, 10)  # colloids, in a channel of length 100


def few_colloids(number: int, quality: Quality) -> list[Point]:
    """One, two or three colloids in channels of many lengths: Figs. 4.3 to 4.5 and 4.8."""
    seeds: dict[int, dict[int, int]] = {
        1: {40: 24, 60: 20, 80: 18, 100: 18, 150: 12, 200: 9, 300: 8, 500: 5, 1000: 4},
        2: {100: 24, 150: 16, 200: 12, 300: 8, 500: 5, 1000: 4},
        3: {100: 16, 150: 12, 250: 8, 400: 5, 600: 4, 1000: 3},
    }
    quick: dict[int, dict[int, int]] = {
        1: {40: 4, 80: 2, 150: 1, 300: 1},
        2: {100: 2, 200: 1, 300: 1},
        3: {100: 2, 260: 1},
    }
    table = (seeds if quality == "full" else quick)[number]
    return [channel_point(length, number, count) for length, count in table.items()]


def crowds(quality: Quality) -> list[Point]:
    """More colloids, with hydrodynamics: Figs. 4.7 and 5.1 have the same runs."""
    return [channel_point(100, number, 3 if quality == "full" else 1) for number in CROWDS]


def without_interactions(solvent: Hydrodynamics, quality: Quality) -> list[Point]:
    """Two colloids in a random solvent, as in Fig. 4.8; then more of them, as in `crowds`."""
    durations, seeds = {100: 600.0, 200: 400.0, 500: 200.0, 1000: 120.0}, 4
    if quality == "quick":
        durations, seeds = {100: 150.0, 300: 75.0}, 1
    table = [(length, 2, time) for length, time in durations.items()]
    table += [(100, number, durations[100]) for number in CROWDS]
    return [
        channel_point(length, number, seeds, time, hydrodynamics=solvent, equilibration=25.0)
        for length, number, time in table
    ]


def _figure_4_3(directories: Directories, quality: Quality) -> Outcome:
    entries = [speed(directories, point) for point in few_colloids(1, quality)]
    dilute = [entry for entry in entries if entry.point.fraction < DILUTE]
    plateau = weighted_mean(co_moving(dilute))
    figure, axes = one_panel(FRACTION, SPEED)
    axes.axvspan(0, DILUTE, color=PAPER, alpha=0.07, linewidth=0)
    paper_remark(axes, 0.02, 0.03, "thesis: constant here", va="bottom")
    points(axes, fractions(entries), co_moving(entries), label="one colloid, $L_x$ from 40 to 1000")
    axes.plot([0, DILUTE], [plateau.value] * 2, label=f"mean below {DILUTE:g}: {plateau.value:.4f}")
    draw_line_of_4_6(axes, entries)
    axes.set(xlim=(0, None), ylim=(0, None))
    axes.legend(loc="lower right")
    shortest = entries[0]
    same_line = "one colloid and its periodic images should follow the same line as many do"
    results = [
        measured("4.3", "mean v_s of one colloid for phi < 0.015 [a0/t0]", plateau),
        claimed(
            "4.3",
            "slope dv_s/dphi of one colloid for phi < 0.015 [a0/t0]",
            slope_in_fraction(dilute),
            "v_s is constant below phi of 0.015",
            "zero",
            "Fig. 4.6 shows a reduction for small phi, of many colloids",
        ),
        claimed(
            "4.3",
            f"v_s at L_x {shortest.point.length:g} less the mean for phi < 0.015 [a0/t0]",
            shortest.co_moving - plateau,
            "v_s increases for smaller length",
            "positive",
        ),
        compared("4.3", LESS_LINE, mean_above_line(entries), ON_LINE, same_line),
    ]
    return Outcome(figure, speed_table([("one colloid", entries)]), results)


def _few(
    directories: Directories, quality: Quality, numbers: Sequence[int]
) -> dict[int, list[Speed]]:
    return {
        number: [speed(directories, point) for point in few_colloids(number, quality)]
        for number in numbers
    }


def _named(few: dict[int, list[Speed]]) -> list[tuple[str, Sequence[Speed]]]:
    return [(f"N_c = {number}", entries) for number, entries in few.items()]


def _figure_4_4(directories: Directories, quality: Quality) -> Outcome:
    few = _few(directories, quality, (1, 2, 3))
    figure, axes = one_panel(FRACTION, SPEED)
    for number, entries in few.items():
        points(axes, fractions(entries), co_moving(entries), number - 1, label=f"$N_c$ = {number}")
    everything = [entry for entries in few.values() for entry in entries]
    draw_line_of_4_6(axes, everything)
    axes.set(xlim=(0, None), ylim=(0, None))
    axes.legend(loc="lower right")
    results = [
        claimed(
            "4.4",
            f"slope dv_s/dphi, N_c = {number} [a0/t0]",
            slope_in_fraction(few[number]),
            "v_s of two and of three colloids increases with phi",
            "positive",
        )
        for number in (2, 3)
    ]
    results += [
        compared("4.4", LESS_LINE, mean_above_line(everything), ON_LINE),
        measured(
            "4.4",
            "slope dv_s/dphi of all three [a0/t0]",
            slope_in_fraction(everything),
            f"not that of Fig. 4.6: most points lie below phi = {DILUTE}, where v_s is constant",
        ),
    ]
    return Outcome(figure, speed_table(_named(few)), results)


def _figure_4_5(directories: Directories, quality: Quality) -> Outcome:
    few = _few(directories, quality, (2, 3))
    figure, axes = one_panel("length of the channel $L_x$  [$a_0$]", SPEED)
    results: list[Result] = []
    for number, entries in few.items():
        lengths = [entry.point.length for entry in entries]
        points(axes, lengths, co_moving(entries), number - 1, label=f"$N_c$ = {number}")
        fine = np.geomspace(min(lengths), max(lengths), 200)
        fraction = entries[0].point.fraction * lengths[0] / fine
        label = r"thesis, $0.15\,\phi + 0.019$ at $N_c$ = 2 and 3" if number == 2 else ""
        paper_line(axes, fine, SLOPE.value * fraction + INTERCEPT.value, label or "_")
        short, dilute = entries[0], [entry for entry in entries if entry.point.fraction < DILUTE]
        results.append(
            claimed(
                "4.5",
                f"v_s at L_x {short.point.length:g} less the mean for phi < {DILUTE:g}, "
                f"N_c = {number} [a0/t0]",
                short.co_moving - weighted_mean(co_moving(dilute)),
                "finite-size effects raise v_s at small L_x",
                "positive",
            )
        )
    axes.set(xscale="log", ylim=(0, None))
    ticks = [100, 200, 300, 500, 1000] if quality == "full" else [100, 200, 300]
    axes.set_xticks(ticks, [str(tick) for tick in ticks])
    axes.minorticks_off()
    axes.legend(loc="lower left")
    return Outcome(figure, speed_table(_named(few)), results)


SOLVENTS: tuple[tuple[Hydrodynamics, str], ...] = (
    ("shuffle", "velocities interchanged"),
    ("bath", "velocities redrawn"),
)


def _figure_4_8(directories: Directories, quality: Quality) -> Outcome:
    off = {
        solvent: [speed(directories, point) for point in without_interactions(solvent, quality)]
        for solvent, _ in SOLVENTS
    }
    on = [speed(directories, point) for point in [*few_colloids(2, quality), *crowds(quality)]]
    figure, axes = one_panel(FRACTION, SPEED)
    for number, (solvent, words) in enumerate(SOLVENTS):
        entries = off[solvent]
        points(axes, fractions(entries), co_moving(entries), number, label=f"off: {words}")
    points(axes, fractions(on), co_moving(on), 2, label="hydrodynamics on")
    draw_line_of_4_6(axes, on)
    axes.axhline(0, color="0.7", linewidth=0.8, zorder=0)
    paper_remark(
        axes, 0.98, 0.26, "thesis: without hydrodynamics\nno correlation with $\\phi$", ha="right"
    )
    axes.set(xlim=(0, None))
    axes.legend(loc="center right", bbox_to_anchor=(1.0, 0.5))

    def pairs(entries: list[Speed]) -> list[Speed]:
        return [entry for entry in entries if entry.point.colloids == 2]

    def short(entries: list[Speed]) -> list[Speed]:
        return [entry for entry in entries if entry.point.length == 100]

    means = {solvent: weighted_mean(co_moving(pairs(entries))) for solvent, entries in off.items()}
    independent = "without hydrodynamic interactions v_s does not depend on phi"
    crowded = f"slope dv_s/dphi of 2 to {max(CROWDS)} colloids in L_x = 100"
    results = [
        claimed(
            "4.8",
            f"slope dv_s/dphi of two colloids, {words} [a0/t0]",
            slope_in_fraction(pairs(off[solvent])),
            independent,
            "zero",
        )
        for solvent, words in SOLVENTS
    ]
    slope_on = slope_in_fraction(short(on))
    results.append(measured("4.8", f"{crowded}, hydrodynamics on [a0/t0]", slope_on))
    for solvent, words in SOLVENTS:
        slope_off = slope_in_fraction(short(off[solvent]))
        results += [
            measured("4.8", f"{crowded}, {words} [a0/t0]", slope_off),
            claimed(
                "4.8",
                f"{crowded}, hydrodynamics on less {words} [a0/t0]",
                slope_on - slope_off,
                "the increase is an effect of hydrodynamic interactions",
                "positive",
            ),
        ]
    results += [
        claimed(
            "4.8",
            "mean v_s, velocities interchanged less redrawn [a0/t0]",
            means["shuffle"] - means["bath"],
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
    table = speed_table(
        [*((f"off: {words}", off[solvent]) for solvent, words in SOLVENTS), ("on", on)]
    )
    return Outcome(figure, table, results)


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
        lambda quality: scenes_of(p for n in (2, 3) for p in few_colloids(n, quality)),
    ),
    PaperFigure(
        "4.8",
        "Settling speed of two colloids without hydrodynamic interactions, by both methods; and of "
        "five and ten, which the thesis does not show.",
        _figure_4_8,
        lambda quality: scenes_of(
            [
                *(p for solvent, _ in SOLVENTS for p in without_interactions(solvent, quality)),
                *few_colloids(2, quality),
                *crowds(quality),
            ]
        ),
    ),
)

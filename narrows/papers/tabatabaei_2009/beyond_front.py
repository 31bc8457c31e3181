"""Beyond the thesis: the density of a long released chain against two hydrodynamic predictions."""

from functools import cache
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from analysis.estimate import Estimate, mean_of_independent
from lammps_inputs.scenes.channel import Channel
from narrows.papers.drawing import COLOURS, PAPER, shades
from narrows.papers.figure import Column, Directories, Outcome, PaperFigure, Quality
from narrows.papers.results import Result, Sign, claimed, measured
from narrows.papers.tabatabaei_2009 import beyond_flux
from narrows.papers.tabatabaei_2009.chain_ends import (
    GROUP,
    LAWS,
    MEASURES,
    SPACING,
    Comparison,
    Ends,
    compare,
    measured_ends,
)

NUMBER = "beyond-front"


@cache
def chains(quality: Quality) -> tuple[Channel, ...]:
    """Chains that fill half of their channels."""
    if quality == "quick":
        return tuple(_chain(1500, 150, 300.0, seed) for seed in (1, 2))
    return tuple(_chain(3000, 300, 600.0, seed) for seed in range(1, 7))


@cache
def longer_chains(quality: Quality) -> tuple[Channel, ...]:
    """Twice as long."""
    return (_chain(6000, 600, 300.0, 11),) if quality == "full" else ()


def _chain(length: float, colloids: int, duration: float, seed: int) -> Channel:
    return Channel.make(
        length=length,
        colloids=colloids,
        spacing=SPACING,
        equilibration=0,
        duration=duration,
        sampling_interval=3.0,
        seed=seed,
    )


def _draw(comparison: Comparison, scene: Channel) -> Figure:
    figure = Figure(figsize=(10.5, 7.6), layout="constrained")
    (tail, head), (places_, widths) = figure.subplots(2, 2)
    times, end = comparison.runs[0].times, scene.colloids * SPACING
    shown = [round(i * (len(times) - 1) / 3) for i in range(4)]
    density, error = comparison.mean("density")
    edges = comparison.runs[0].edges
    x = (edges[1:] + edges[:-1]) / 2
    for colour, row in zip(shades(4), shown, strict=True):
        for axes in (tail, head):
            axes.errorbar(
                x,
                density[row],
                error[row],
                fmt="o",
                ms=3,
                color=colour,
                elinewidth=0.8,
                label=f"$t$ = {times[row]:.0f}",
            )
            axes.plot(x, comparison.predicted["two laws"].density[row], color=colour)
            axes.plot(x, comparison.predicted["one law"].density[row], ":", color=colour)
    for axes, low, high in ((tail, -20, min(300.0, end / 2)), (head, end - 150, end + 110)):
        axes.set(
            xlim=(low, high),
            ylim=(0, 0.045),
            ylabel=r"density $\rho$  [$a_0^{-2}$]",
            xlabel="along the channel $x$  [$a_0$];  gravity to the right",
        )
    tail.set_title("tail", fontsize=10)
    head.set_title("head", fontsize=10)
    tail.legend(loc="upper left", ncols=2)
    head.plot([], [], color="0.3", label="two laws: colloids and fluid")
    head.plot([], [], ":", color="0.3", label=r"one law: $J(\rho)$ alone")
    head.legend(*_last_two(head), loc="upper right")
    for number, side in enumerate(("tail", "head")):
        for axes, measure, start in (
            (places_, side, end if side == "head" else 0.0),
            (widths, f"{side}_width", 0.0),
        ):
            value, spread = comparison.mean(measure)
            axes.errorbar(
                times,
                value - start,
                spread,
                fmt="os"[number],
                color=COLOURS[number],
                ms=4,
                label=side,
            )
            for law, style in (("two laws", "-"), ("one law", ":")):
                predicted = getattr(comparison.predicted[law], measure) - start
                axes.plot(times, predicted, style, color=COLOURS[number])
    places_.set(xlabel="time $t$  [$t_0$]", ylabel="way of the front  [$a_0$]")
    widths.set(xlabel="time $t$  [$t_0$]", ylabel="width of the front  [$a_0$]")
    widths.text(
        0.02,
        0.72,
        "thesis: dissipates at the head,\nremains sharp at the tail",
        color=PAPER,
        fontsize=8.5,
        transform=widths.transAxes,
        va="top",
    )
    for axes in (places_, widths):
        axes.set(xlim=(0, times[-1] * 1.02), ylim=(0, None))
        axes.legend(loc="upper left")
    return figure


def _last_two(axes: Axes) -> tuple[list[Any], list[str]]:
    handles, labels = axes.get_legend_handles_labels()
    chosen = [i for i, label in enumerate(labels) if "law" in label]
    return [handles[i] for i in chosen], [labels[i] for i in chosen]


def _table(comparison: Comparison) -> dict[str, Column]:
    table: dict[str, Column] = {"time_t0": comparison.runs[0].times.tolist()}
    for measure in MEASURES:
        value, error = comparison.mean(measure)
        table[measure], table[f"{measure}_error"] = value.tolist(), error.tolist()
        for law, ends in comparison.predicted.items():
            table[f"{measure}_{law.replace(' ', '_')}"] = getattr(ends, measure).tolist()
    return table


WHAT = {
    "head": "speed of the head front [a0/t0]",
    "tail": "speed of the tail front [a0/t0]",
    "head_width": "growth of the width of the head front [a0/t0]",
    "tail_width": "growth of the width of the tail front [a0/t0]",
    "head_spacing": f"growth of the mean of the {GROUP} spacings at the head [a0/t0]",
    "tail_spacing": f"growth of the mean of the {GROUP} spacings at the tail [a0/t0]",
}
THESIS: dict[str, tuple[str, Sign]] = {
    "head_width": ("the discontinuity is dissipating at the head of the chain", "positive"),
    "tail_width": ("and remains sharp at the tail", "zero"),
}


def _make(directories: Directories, quality: Quality) -> Outcome:
    scenes = chains(quality)
    comparison = compare(directories, scenes, beyond_flux.homogeneous_law(directories, quality))
    results = [
        *_rates(comparison, _kind(scenes[0])),
        *_sharpness(comparison),
        *_deviations(comparison),
    ]
    for scene in longer_chains(quality):
        longer = measured_ends(directories[scene], scene)
        results += _against_longer(comparison, longer, scene, scenes[0])
    return Outcome(_draw(comparison, scenes[0]), _table(comparison), results)


def _rates(comparison: Comparison, kind: str) -> list[Result]:
    results = list[Result]()
    for measure, what in WHAT.items():
        value = comparison.measured_rate(measure)
        expected = {name: comparison.predicted_rate(name, measure) for name in LAWS}
        note = "; ".join(f"{name}: {_text(entry)}" for name, entry in expected.items())
        if measure in THESIS:
            claim, sign = THESIS[measure]
            results.append(claimed(NUMBER, f"{what}, {kind}", value, claim, sign, note))
        else:
            results.append(measured(NUMBER, f"{what}, {kind}", value, note))
        for name, entry in expected.items():
            gap = value - entry
            results.append(measured(NUMBER, f"{what}, less that predicted by {name}", gap))
    return results


def _sharpness(comparison: Comparison) -> list[Result]:
    rates = [comparison.measured_rate(f"{side}_spacing") for side in ("head", "tail")]
    results = [
        claimed(
            NUMBER,
            "growth of the spacings at the head less at the tail [a0/t0]",
            rates[0] - rates[1],
            "distances at the head of the chain increase faster than those at the tail",
            "positive",
            "the other way round: the front sharpens at the head, where J convex in rho has it",
        )
    ]
    for side in ("head", "tail"):
        last = mean_of_independent(
            [float(getattr(run, f"{side}_width")[-1]) for run in comparison.runs]
        )
        note = "; ".join(
            f"{name}: {float(getattr(ends, f'{side}_width')[-1]):.3g}"
            for name, ends in comparison.predicted.items()
        )
        time = f"t = {comparison.runs[0].times[-1]:.0f}"
        results.append(measured(NUMBER, f"width of the {side} front at {time} [a0]", last, note))
    return results


def _deviations(comparison: Comparison) -> list[Result]:
    """Root mean square of measured less predicted density near the ends, at the last time."""
    density, error = comparison.mean("density")
    x = (comparison.runs[0].edges[1:] + comparison.runs[0].edges[:-1]) / 2
    near = (x < 150) | (x > comparison.predicted["one law"].head[0] - 150)
    noise = f"standard errors over seeds have an rms of {_rms(error[-1][near]):.2g}"
    return [
        measured(
            NUMBER,
            f"rms of density less {name} within 150 a0 of the ends, last time [1/a0^2]",
            Estimate(_rms((density[-1] - ends.density[-1])[near]), None, noise),
        )
        for name, ends in comparison.predicted.items()
    ]


def _rms(values: NDArray[np.float64]) -> float:
    return float(np.sqrt((values**2).mean()))


def _kind(scene: Channel) -> str:
    return f"{scene.colloids} colloids in {scene.length:g} x {scene.width:g}"


def _against_longer(
    comparison: Comparison, run: Ends, longer: Channel, scene: Channel
) -> list[Result]:
    """Places and widths at the last time of the longer chain, with the scatter of single runs."""
    row = len(run.times) - 1
    shift = {"head": (longer.colloids - scene.colloids) * SPACING}
    results = list[Result]()
    for measure in ("head", "tail", "head_width", "tail_width"):
        values = [float(getattr(entry, measure)[row]) for entry in comparison.runs]
        mean, spread = float(np.mean(values)), float(np.std(values, ddof=1))
        gap = float(getattr(run, measure)[row]) - shift.get(measure, 0.0) - mean
        error = spread * (1 + 1 / len(values)) ** 0.5
        results.append(
            claimed(
                NUMBER,
                f"{measure.replace('_', ' ')} at t = {run.times[row]:.0f}, "
                f"{_kind(longer)} less {_kind(scene)} [a0]",
                Estimate(gap, error),
                "fronts do not know of the length of the chain",
                "zero",
                f"error from the scatter of {len(values)} runs, so uncertain itself",
            )
        )
    return results


def _text(entry: Estimate) -> str:
    return f"{entry.value:.3g} +- {entry.error:.1g}"


FIGURES = (
    PaperFigure(
        NUMBER,
        "Beyond the thesis: tail and head of a chain of hundreds of colloids, and two predictions "
        "without a fitted parameter. Error bars: standard error over seeds.",
        _make,
        lambda quality: [*beyond_flux.scenes(quality), *chains(quality), *longer_chains(quality)],
    ),
)

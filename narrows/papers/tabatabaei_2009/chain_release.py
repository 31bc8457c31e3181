"""The released chain of 31 colloids, Figs. 4.11 to 4.14: spacings by groups, and the zigzag."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PatchCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from analysis import RunDirectory, chain
from analysis.arrays import Array
from analysis.estimate import mean_of_independent
from analysis.settling import SettlingSeries, settling_series
from lammps_inputs.scenes.channel import Channel
from narrows.papers.drawing import PAPER, one_panel, paper_remark, shades
from narrows.papers.figure import Column, Directories, Outcome, PaperFigure, Quality
from narrows.papers.results import Result, claimed, measured

LENGTH, COLLOIDS, SPACING = 300, 31, 5.0
SNAPSHOT = 500.0  # time of Fig. 4.14, and end of the growth rates [t0]


def release(gravity: float, quality: Quality) -> list[Channel]:
    """The chain of Fig. 4.11, several seeds."""
    if quality == "quick":
        seeds, duration = 2, 1000.0 if gravity else SNAPSHOT
    else:
        seeds, duration = 6, 1500.0 if gravity else 1000.0
    return [
        Channel.make(
            length=LENGTH,
            colloids=COLLOIDS,
            spacing=SPACING,
            gravity=gravity,
            equilibration=0,
            duration=duration,
            sampling_interval=3.0,
            seed=seed,
        )
        for seed in range(1, seeds + 1)
    ]


@dataclass(frozen=True)
class Released:
    """One run: x and y head first, (T, 31) [a0], the times, (T,) [t0], and the settling speed."""

    times: Array
    x: Array
    y: Array
    settling: SettlingSeries

    @property
    def groups(self) -> Array:
        """D_1 at the head to D_6, (T, 6) [a0]."""
        return chain.group_spacings(chain.neighbour_spacings(self.x))

    @property
    def zigzag(self) -> Array:
        """Local zigzag, (T, 29) [a0]."""
        return chain.local_zigzag(self.y)

    def speed_between(self, start: float, stop: float) -> float:
        """Mean settling speed in the co-moving frame in that time [a0/t0]."""
        used = (self.settling.times > start) & (self.settling.times <= stop)
        return float(self.settling.co_moving[used].mean())


def _read(run: RunDirectory) -> Released:
    colloids = chain.chain_of(run)
    times = run.times(run.particles().steps)
    return Released(times, colloids.x, colloids.y, settling_series(run))


def _released(directories: Directories, gravity: float, quality: Quality) -> list[Released]:
    return [_read(directories[scene]) for scene in release(gravity, quality)]


def _growth_rates(runs: Sequence[Released]) -> Array:
    """Slope of each D_i(t) up to the time of Fig. 4.14, head first, (runs, 6) [a0/t0]."""
    slopes = []
    for run in runs:
        until = run.times <= SNAPSHOT
        slopes.append(np.polyfit(run.times[until], run.groups[until], 1)[0])
    return np.array(slopes)


def _draw_spacings(runs: Sequence[Released]) -> Figure:
    figure: Figure
    figure, axes = one_panel("time $t$  [$t_0$]", "mean spacing $D_i$  [$a_0$]")
    groups = np.array([run.groups for run in runs])
    times, mean = runs[0].times, groups.mean(axis=0)
    error = groups.std(axis=0, ddof=1) / np.sqrt(len(runs))
    colours = shades(mean.shape[1])
    for group in range(mean.shape[1]):
        end = {0: " (head)", mean.shape[1] - 1: " (tail)"}.get(group, "")
        low, high = mean[:, group] - error[:, group], mean[:, group] + error[:, group]
        axes.fill_between(times, low, high, color=colours[group], alpha=0.2, linewidth=0)
        axes.plot(times, mean[:, group], color=colours[group], label=f"$D_{group + 1}${end}")
    axes.axhline(SPACING, color=PAPER, linestyle="--", linewidth=1.0, label="$d_0$ = 5")
    axes.set_xlim(0, times[-1])
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure


def _spacing_table(runs: Sequence[Released]) -> dict[str, list[float]]:
    groups = np.array([run.groups for run in runs])
    table = {"time_t0": runs[0].times.tolist()}
    for group in range(groups.shape[2]):
        values = groups[:, :, group]
        table[f"D_{group + 1}"] = values.mean(axis=0).tolist()
        error = values.std(axis=0, ddof=1) / np.sqrt(len(runs))
        table[f"D_{group + 1}_error"] = error.tolist()
    return table


def _rate_results(figure: str, rates: Array) -> list[Result]:
    return [
        measured(figure, f"growth rate of D_{number}, t <= 500 [a0/t0]", mean_of_independent(rate))
        for number, rate in enumerate(rates.T, start=1)
    ]


def _figure_4_12(directories: Directories, quality: Quality) -> Outcome:
    runs = _released(directories, 0.1, quality)
    rates = _growth_rates(runs)
    figure = _draw_spacings(runs)
    remark = "thesis: $D_1$, at the head, grows fastest; labels from the leftmost colloid"
    paper_remark(figure.axes[0], 0.0, 1.02, remark, va="bottom")
    slope = mean_of_independent(np.polyfit(np.arange(rates.shape[1]), rates.T, 1)[0])
    contradiction = (
        "for gravity along +x the chain closes up at the head and spreads at the tail, as a "
        "current rho (c' + c rho) with c > 0 does. The thesis' own clustering at the head (Fig. "
        "4.14) means small spacings there; its D_1, counted from the leftmost colloid, is at the "
        "tail of a chain that falls to the right"
    )
    fastest_at_head = mean_of_independent(rates[:, 0] - rates[:, -1])
    results = [
        *_rate_results("4.12", rates),
        claimed(
            "4.12",
            "growth rate of the spacing at the leftmost end less at the rightmost [a0/t0]",
            fastest_at_head.scaled(-1.0),
            "D_1, labelled from the leftmost colloid, grows fastest",
            "positive",
            "left is the tail for gravity along +x",
        ),
        claimed(
            "4.12",
            "growth rate lost from one group to the next, counted from the leftmost [a0/t0]",
            slope,
            "the rate at which D_i increases varies monotonically with i",
            "positive",
        ),
        claimed(
            "4.12",
            "growth rate of the spacing at the head less at the tail [a0/t0]",
            fastest_at_head,
            "the increasing rate of D_1 (located at the head of the chain) is maximum",
            "positive",
            contradiction,
        ),
    ]
    return Outcome(figure, _spacing_table(runs), results)


def _figure_4_13(directories: Directories, quality: Quality) -> Outcome:
    runs = _released(directories, 0.0, quality)
    rates = _growth_rates(runs)
    figure = _draw_spacings(runs)
    remark = "thesis: always fluctuating, no systematic behaviour"
    paper_remark(figure.axes[0], 0.0, 1.02, remark, va="bottom")
    results = [
        *_rate_results("4.13", rates),
        claimed(
            "4.13",
            "growth rate of the spacing at one end less at the other [a0/t0]",
            mean_of_independent(rates[:, 0] - rates[:, -1]),
            "without gravity no systematic behaviour",
            "zero",
        ),
    ]
    return Outcome(figure, _spacing_table(runs), results)


def _strip(run: Released, times: Sequence[float]) -> Figure:
    """The chain at several times, every channel to scale; the foremost colloids are dark."""
    figure = Figure(figsize=(9.5, 0.42 + 0.62 * len(times)), layout="constrained")
    rows = figure.subplots(len(times), 1, sharex=True)
    colour = ScalarMappable(Normalize(0, COLLOIDS - 1), "viridis")
    for axes, time in zip(rows, times, strict=True):
        frame = int(np.argmin(np.abs(run.times - time)))
        discs, shades = [], []
        for number, (x, y) in enumerate(zip(run.x[frame] % LENGTH, run.y[frame], strict=True)):
            for image in (x - LENGTH, x, x + LENGTH):
                if -2 < image < LENGTH + 2:
                    discs.append(Circle((image, y), 2.0))
                    shades.append(colour.to_rgba(np.array([number]))[0])
        axes.add_collection(PatchCollection(discs, facecolors=shades, edgecolors="white", lw=0.4))
        axes.set(xlim=(0, LENGTH), ylim=(0, 10), aspect="equal", yticks=[])
        axes.set_ylabel(f"$t$ = {run.times[frame]:.0f}", rotation=0, ha="right", va="center")
        axes.tick_params(bottom=axes is rows[-1])
        for side in ("left", "right"):
            axes.spines[side].set_visible(False)
        axes.spines["top"].set_visible(True)
        if time == SNAPSHOT:
            axes.text(
                *(0.995, 0.5, "thesis, Fig. 4.14:\nzigzag at the head"),
                transform=axes.transAxes,
                ha="right",
                va="center",
                color=PAPER,
                fontsize=7.5,
            )
    rows[-1].set_xlabel("along the channel $x$  [$a_0$];  gravity to the right, head dark")
    return figure


def _figure_4_14(directories: Directories, quality: Quality) -> Outcome:
    runs = _released(directories, 0.1, quality)
    last = runs[0].times[-1]
    shown = [time for time in (0.0, 125.0, 250.0, 500.0, 750.0, 1000.0, 1500.0) if time <= last]
    figure = _strip(runs[0], shown)
    ends: list[float] = []
    early, late = (400.0, 500.0), (last - 200.0, last)
    moved: list[float] = []
    for run in runs:
        near = (run.times >= 400) & (run.times <= 500)
        strength = np.sqrt((run.zigzag[near] ** 2).mean(axis=0))
        third = len(strength) // 3
        ends.append(float(strength[:third].mean() - strength[-third:].mean()))
        place = chain.zigzag_place(run.zigzag)
        before, after = (
            float(np.nanmean(place[(run.times >= start) & (run.times <= stop)]))
            for start, stop in (early, late)
        )
        moved.append(after - before)
    results = [
        claimed(
            "4.14",
            "zigzag of the third at the head less at the tail, t from 400 to 500 [a0]",
            mean_of_independent(ends),
            "the zigzag is seen at the head at t = 500",
            "positive",
        ),
        claimed(
            "4.14",
            f"colloids that the zigzag moves back, from t = {early[0]:.0f}-{early[1]:.0f} to "
            f"{late[0]:.0f}-{late[1]:.0f}",
            mean_of_independent(moved),
            "the zigzag moves to the middle and then to the tail",
            "positive",
        ),
        *(
            measured(
                "4.14",
                f"v_s of the chain, t from {start:.0f} to {stop:.0f} [a0/t0]",
                mean_of_independent([run.speed_between(start, stop) for run in runs]),
                note,
            )
            for start, stop, note in (
                (0.0, 200.0, None),
                (*late, "the zigzag takes colloids from the mid-line, where they fall fastest"),
            )
        ),
    ]
    table: dict[str, Column] = {"colloid_from_the_head": list(range(2, COLLOIDS))}
    for time in shown:
        window = [np.abs(run.times - time) <= 25 for run in runs]
        squares = [(run.zigzag[w] ** 2).mean(axis=0) for run, w in zip(runs, window, strict=True)]
        table[f"zigzag_rms_t_{time:.0f}"] = np.sqrt(np.mean(squares, axis=0)).tolist()
    return Outcome(figure, table, results)


FIGURES = (
    PaperFigure(
        "4.12",
        "Spacings by groups of the released chain, 31 colloids in 300 x 10; band: standard error.",
        _figure_4_12,
        lambda quality: release(0.1, quality),
    ),
    PaperFigure(
        "4.13",
        "The same without gravity.",
        _figure_4_13,
        lambda quality: release(0.0, quality),
    ),
    PaperFigure(
        "4.14",
        "The chain at several times (seed 1): a zigzag that moves from the head backwards.",
        _figure_4_14,
        lambda quality: release(0.1, quality),
    ),
)

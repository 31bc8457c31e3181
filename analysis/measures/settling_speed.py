"""Settling speed of the colloids, at rest and in the co-moving frame."""

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from analysis import correlated_mean
from analysis.drawing import TIME, mark_equilibration, one_panel
from analysis.estimate import Estimate
from analysis.findings import Findings
from analysis.run_directory import RunDirectory
from analysis.settling import SettlingSeries, settling_series
from run_files import RunDirectoryError

QUANTITIES = ("settling_speed", "settling_speed_rest")

SETTLED = 10  # a running mean is shown whole once it is over so small a part of the run
MARGIN = 0.3  # about what is shown


def measure(run: RunDirectory) -> Findings:
    """Means over time in both frames, and their history."""
    sampled_frames(run)
    series = settling_series(run)
    moving, rest = (
        correlated_mean.mean(speed[series.used], run.interval)
        for speed in (series.co_moving, series.rest)
    )
    return Findings(
        {"settling_speed": moving.as_json(), "settling_speed_rest": rest.as_json()},
        {"settling_speed.png": draw(series, run.equilibration_time, moving)},
    )


def sampled_frames(run: RunDirectory) -> NDArray[np.bool_]:
    """Which frames of the trajectory lie after the equilibration, (T,).

    Raises:
        RunDirectoryError: when fewer than two do.
    """
    steps = run.particles().steps
    used = steps >= run.equilibration_steps
    if used.sum() < 2:
        raise RunDirectoryError(
            f"{run.path / 'trajectory.lammpsdump'}: no two frames after the equilibration: it ends "
            f"at step {run.equilibration_steps}, the trajectory at step {steps[-1]}"
        )
    return np.asarray(used)


def draw(series: SettlingSeries, equilibration: float, mean: Estimate) -> Figure:
    """Settling speed against time: each interval of the co-moving frame, running means of both.

    The scale is that of the running means; single intervals, which are mostly noise, go beyond it.

    Args:
        series: both frames.
        equilibration: time averages leave out [t0].
        mean: in the co-moving frame [a0/t0].
    """
    times, used = series.times, series.times > equilibration
    figure, axes = one_panel(TIME, "settling speed $v_s$ [$a_0/t_0$]")
    axes.plot(
        times, series.co_moving, color="0.88", linewidth=0.5, label="co-moving, each interval"
    )
    count = np.arange(1, used.sum() + 1)
    shown = [0.0]  # what the scale has to show
    for speed, name, colour in (
        (series.co_moving, "co-moving", "C0"),
        (series.rest, "at rest", "C1"),
    ):
        running = np.cumsum(speed[used]) / count
        axes.plot(times[used], running, color=colour, label=f"{name}, running mean")
        shown += [*running[len(running) // SETTLED :]]
    if mean.value is not None and mean.error is not None:
        low, high = mean.value - mean.error, mean.value + mean.error
        axes.axhspan(low, high, color="C0", alpha=0.2, label="co-moving, mean and standard error")
        shown += [low, high]
    margin = MARGIN * (max(shown) - min(shown)) or 1.0
    axes.set_ylim(min(shown) - margin, max(shown) + margin)
    mark_equilibration(axes, equilibration)
    axes.legend()
    return figure

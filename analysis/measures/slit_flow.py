"""Flow of the fluid between walls: its profile, mean velocity and Reynolds number."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from analysis import correlated_mean, flow
from analysis.arrays import Array
from analysis.drawing import one_panel
from analysis.estimate import Estimate
from analysis.findings import Findings
from analysis.run_directory import RunDirectory

QUANTITIES = ("fluid_velocity", "reynolds_number")


def measure(run: RunDirectory) -> Findings:
    """Mean velocity and Reynolds number (4.11), and the mean profile."""
    return slit_flow(run, fit=None)


def slit_flow(run: RunDirectory, fit: tuple[float, float] | None) -> Findings:
    """The same, with a fitted parabola of maximum and wall velocity in the figure."""
    fluid = run.profile()
    used = run.sampled(fluid.steps)
    counts, velocity = fluid.counts[used], fluid.velocity_x[used]
    mean_velocity = correlated_mean.mean(flow.mean_velocity(counts, velocity), run.interval)
    theory = run.solvent.viscosity_theory
    if theory is None:
        reynolds = Estimate(None, None, "kinetic theory has no viscosity for this fluid")
    else:
        reynolds = mean_velocity.scaled(flow.reynolds_number(1.0, run.width, theory))
    bins = [
        correlated_mean.mean(series, run.interval)
        for series in flow.momentum_profile(counts, velocity).T
    ]
    return Findings(
        {"fluid_velocity": mean_velocity.as_json(), "reynolds_number": reynolds.as_json()},
        {"profile.png": draw(fluid.y, bins, run.width, fit)},
    )


def draw(
    y: Array, velocity: Sequence[Estimate], width: float, fit: tuple[float, float] | None
) -> Figure:
    """Mean velocity of the fluid across the slit, with the fitted parabola.

    Args:
        y: bin centres, (bins,) [a0].
        velocity: time mean in each bin, with its error, (bins,) [a0/t0].
        width: of the slit [a0].
        fit: v_max and v_wall [a0/t0]; None where no parabola is expected.
    """
    figure, axes = one_panel("across the slit $y$ [$a_0$]", "fluid velocity $v_x$ [$a_0/t_0$]")
    axes.errorbar(
        y,
        [each.number for each in velocity],
        [each.error or 0.0 for each in velocity],
        fmt="o",
        markersize=4,
        capsize=2,
        label="mean over each bin, with its standard error",
    )
    if fit is not None:
        v_max, v_wall = fit
        fine = np.linspace(0, width, 400)
        shape = flow.parabola(fine, width)
        label = f"parabola, $v_{{max}}$ = {v_max:.4g}, $v_{{wall}}$ = {v_wall:.2g}"
        axes.plot(fine, v_wall + (v_max - v_wall) * shape, label=label)
    for wall in (0.0, width):
        axes.axvline(wall, color="0.3", linewidth=2)
    axes.legend()
    return figure

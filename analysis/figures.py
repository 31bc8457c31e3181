"""The figures of a run, one function each; lengths in a0, times in t0."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from analysis.blocking import Estimate
from analysis.diffusion import Diffusion
from analysis.flow import parabola

Array = NDArray[np.float64]

TIME = "time $t$ [$t_0$]"
ALONG = "along the channel $x$ [$a_0$]"


def settling(times: Array, rest: Array, co_moving: Array, equilibration: float) -> Figure:
    """Settling speed against time: each interval of the co-moving frame, running means of both.

    Args:
        times: ends of the sampling intervals, (K,) [t0].
        rest, co_moving: mean colloid velocity along x in the two frames, (K,) [a0/t0].
        equilibration: time left out of the running means [t0].
    """
    figure, axes = _figure(TIME, "settling speed $v_s$ [$a_0/t_0$]")
    axes.plot(times, co_moving, color="0.8", linewidth=0.6, label="co-moving, each interval")
    used = times > equilibration
    count = np.arange(1, used.sum() + 1)
    for speed, name, colour in ((co_moving, "co-moving", "C0"), (rest, "at rest", "C1")):
        running = np.cumsum(speed[used]) / count
        axes.plot(times[used], running, color=colour, label=f"{name}, running mean")
    _mark_equilibration(axes, equilibration)
    axes.legend()
    return figure


def profile(y: Array, velocity: Array, width: float, fit: tuple[float, float] | None) -> Figure:
    """Mean velocity of the fluid across the slit, with the fitted parabola.

    Args:
        y: bin centres, (bins,) [a0].
        velocity: time mean in each bin, (bins,) [a0/t0].
        width: of the slit [a0].
        fit: v_max and v_wall [a0/t0]; None where no parabola is expected.
    """
    figure, axes = _figure("across the slit $y$ [$a_0$]", "fluid velocity $v_x$ [$a_0/t_0$]")
    axes.plot(y, velocity, "o", markersize=4, label="mean over each bin")
    if fit is not None:
        v_max, v_wall = fit
        fine = np.linspace(0, width, 400)
        shape = parabola(fine, width)
        label = f"parabola, $v_{{max}}$ = {v_max:.4g}, $v_{{wall}}$ = {v_wall:.2g}"
        axes.plot(fine, v_wall + (v_max - v_wall) * shape, label=label)
    for wall in (0.0, width):
        axes.axvline(wall, color="0.3", linewidth=2)
    axes.legend()
    return figure


def wave_decay(
    times: Array, amplitude: Array, equilibration: float, viscosity: Estimate, width: float
) -> Figure:
    """Amplitude of the shear wave against time, with the fitted decay.

    Args:
        times: ends of the sampling intervals, (K,) [t0].
        amplitude: (K,) [a0/t0].
        equilibration: time the fit leaves out [t0].
        viscosity: of the fit [a0^2/t0].
        width: L_y, the wave length [a0].
    """
    figure, axes = _figure(TIME, "amplitude of $\\sin(2\\pi y/L_y)$ [$a_0/t_0$]")
    axes.plot(times, amplitude, ".", markersize=3, label="each sampling interval")
    if viscosity.value is not None:
        used = times > equilibration
        decay = np.exp(-viscosity.value * (2 * np.pi / width) ** 2 * times[used])
        scale = amplitude[used] @ decay / (decay @ decay)
        label = f"$\\exp(-\\nu k^2 t)$, $\\nu$ = {viscosity.value:.4g}"
        axes.plot(times[used], scale * decay, label=label)
    axes.axhline(0, color="0.7", linewidth=0.8)
    _mark_equilibration(axes, equilibration)
    axes.legend()
    return figure


def spacings(times: Array, groups: Array, equilibration: float) -> Figure:
    """Mean spacings D_i(t) of the chain, as in Fig. 4.12.

    Args:
        times: (T,) [t0].
        groups: D_i, head first, (T, groups) [a0].
        equilibration: time averages leave out [t0].
    """
    figure, axes = _figure(TIME, "mean spacing $D_i$ [$a_0$]")
    count = groups.shape[1]
    for group in range(count):
        end = {0: " (head)", count - 1: " (tail)"}.get(group, "") if count > 1 else ""
        axes.plot(times, groups[:, group], linewidth=1, label=f"$D_{{{group + 1}}}${end}")
    _mark_equilibration(axes, equilibration)
    axes.legend(ncols=1 + count // 12)
    return figure


def zigzag(times: Array, amplitude: Array, local: Array, equilibration: float) -> Figure:
    """Zigzag of the whole chain against time, and about each colloid.

    Args:
        times: (T,) [t0].
        amplitude: of the whole chain, (T,) [a0].
        local: about each inner colloid, head first, (T, N - 2) [a0].
        equilibration: time averages leave out [t0].
    """
    figure = Figure(figsize=(7, 6), layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True)
    above.plot(times, amplitude, linewidth=0.8)
    above.axhline(0, color="0.7", linewidth=0.8)
    above.set_ylabel("zigzag amplitude [$a_0$]")
    _mark_equilibration(above, equilibration)
    limit = float(np.abs(local).max()) or 1.0
    image = below.imshow(
        local.T,
        extent=(times[0], times[-1], 1.5, local.shape[1] + 1.5),
        origin="lower",
        aspect="auto",
        interpolation="none",
        cmap="RdBu_r",
        vmin=-limit,
        vmax=limit,
    )
    below.yaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    below.set_ylabel("colloid, 1 is the head")
    below.set_xlabel(TIME)
    figure.colorbar(image, ax=below, label="local zigzag [$a_0$]")
    return figure


def pair_correlation(distance: Array, g: Array, diameter: float) -> Figure:
    """g(x) along the channel.

    Args:
        distance: (bins,) [a0].
        g: (bins,).
        diameter: of a colloid [a0].
    """
    figure, axes = _figure("distance along the channel $x$ [$a_0$]", "pair correlation $g(x)$")
    axes.plot(distance, g, drawstyle="steps-mid", linewidth=1)
    axes.axhline(1, color="0.7", linewidth=0.8)
    axes.axvline(diameter, color="0.3", linestyle=":", label="colloid diameter")
    axes.set_ylim(bottom=0)
    axes.legend()
    return figure


def diffusion(result: Diffusion) -> Figure:
    """Mean squared displacement and velocity autocorrelation along x."""
    figure = Figure(figsize=(9, 4), layout="constrained")
    left, right = figure.subplots(1, 2)
    lags = result.times > 0
    left.loglog(result.times[lags], result.msd[lags], "o", markersize=3, label="MSD")
    assert result.exponent.value is not None
    window = (result.times >= result.window[0]) & (result.times <= result.window[1])
    times, msd = result.times[window], result.msd[window]
    power = times**result.exponent.value
    scale = np.exp(np.mean(np.log(msd / power)))
    label = f"exponent {result.exponent.value:.3f} $\\pm$ {result.exponent.error:.3f}"
    left.loglog(times, scale * power, label=label)
    left.set_xlabel("lag [$t_0$]")
    left.set_ylabel("mean squared displacement along $x$ [$a_0^2$]")
    left.legend()
    right.plot(result.times, result.vacf / result.vacf[0], "o-", markersize=3, linewidth=0.8)
    right.axhline(0, color="0.7", linewidth=0.8)
    right.set_xlabel("lag [$t_0$]")
    right.set_ylabel("velocity autocorrelation along $x$ / its start")
    return figure


def space_time(times: Array, x: Array, length: float, equilibration: float) -> Figure:
    """Space-time picture: every colloid's place in the channel against time.

    Args:
        times: (T,) [t0].
        x: unwrapped positions, head first, (T, N) [a0].
        length: of the periodic channel [a0].
        equilibration: time averages leave out [t0].
    """
    figure, axes = _figure(ALONG, TIME)
    count = x.shape[1]
    for colloid in range(count):
        place = np.mod(x[:, colloid], length)
        jumps = np.abs(np.diff(place)) > length / 2  # no line across the periodic boundary
        place[1:][jumps] = np.nan
        colour = (0.1 + 0.75 * colloid / max(1, count - 1), 0.2, 0.5)
        axes.plot(place, times, linewidth=0.8, color=colour)
    if equilibration > 0:
        axes.axhspan(0, equilibration, color="0.92", zorder=0)
    axes.set_xlim(0, length)
    axes.set_title("colloids, head (blue) to tail (red)", fontsize="medium")
    return figure


def _figure(x_label: str, y_label: str) -> tuple[Figure, Axes]:
    figure = Figure(figsize=(7, 4.5), layout="constrained")
    axes = figure.subplots()
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    return figure, axes


def _mark_equilibration(axes: Axes, equilibration: float) -> None:
    if equilibration > 0:
        axes.axvspan(0, equilibration, color="0.92", zorder=0, label="equilibration")

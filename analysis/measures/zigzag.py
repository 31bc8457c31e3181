"""Zigzag of the chain: of the whole, and about each colloid (tabatabaei-2009, 4.5)."""

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from analysis import chain, correlated_mean
from analysis.arrays import Array
from analysis.drawing import TIME, mark_equilibration
from analysis.findings import Findings
from analysis.measures.settling_speed import sampled_frames
from analysis.run_directory import RunDirectory

QUANTITIES = ("zigzag.amplitude_rms",)

FEWEST_ROWS = 3  # inner colloids that make a picture of a chain


def measure(run: RunDirectory) -> Findings:
    """Amplitudes, beside what unrelated displacements would give, and their history."""
    used, y = sampled_frames(run), chain.chain_of(run).y
    amplitude, local = chain.zigzag_amplitude(y, run.width), chain.local_zigzag(y)
    displacement = float(np.sqrt(((y[used] - run.width / 2) ** 2).mean()))
    entry = {
        "amplitude_rms": correlated_mean.mean(amplitude[used] ** 2, run.interval).sqrt().as_json(),
        "displacement_rms": displacement,
        "uncorrelated_rms": displacement / np.sqrt(y.shape[1]),
        "local_rms": np.sqrt((local[used] ** 2).mean(axis=0)).tolist(),
    }
    picture = draw(run.times(run.particles().steps), amplitude, local, run.equilibration_time)
    few = local.shape[1] < FEWEST_ROWS
    line = f"zigzag about each colloid: a picture takes {FEWEST_ROWS + 2} colloids"
    return Findings({"zigzag": entry}, {"zigzag.png": picture}, left_out=(line,) if few else ())


def draw(times: Array, amplitude: Array, local: Array, equilibration: float) -> Figure:
    """Zigzag of the whole chain against time, and about each colloid where there are several.

    Args:
        times: (T,) [t0].
        amplitude: of the whole chain, (T,) [a0].
        local: about each inner colloid, head first, (T, N - 2) [a0].
        equilibration: time averages leave out [t0].
    """
    rows = 2 if local.shape[1] >= FEWEST_ROWS else 1
    figure = Figure(figsize=(7, 3 * rows), layout="constrained")
    above, *others = figure.subplots(rows, 1, sharex=True, squeeze=False)[:, 0]
    above.plot(times, amplitude, linewidth=0.8)
    above.axhline(0, color="0.7", linewidth=0.8)
    above.set_ylabel("zigzag amplitude [$a_0$]")
    mark_equilibration(above, equilibration)
    if not others:
        above.set_xlabel(TIME)
        return figure
    (below,) = others
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

"""Pair correlation of the colloids along the channel."""

import numpy as np
from matplotlib.figure import Figure

from analysis.arrays import Array
from analysis.correlated_mean import two_digits
from analysis.drawing import one_panel
from analysis.findings import Findings
from analysis.measures.settling_speed import sampled_frames
from analysis.pair_correlation import pair_correlation
from analysis.run_directory import RunDirectory

BIN_WIDTH = 0.1  # [a0]; the 48-24 repulsion is about that steep
NOISIEST = 0.3  # standard error of g in a bin, of which an ideal gas has 1


def measure(run: RunDirectory) -> Findings:
    """Place and height of the highest peak of g(x); the picture where it is more than noise."""
    x = run.particles().positions[sampled_frames(run)][:, :, 0]
    distance, g = pair_correlation(x, run.length, BIN_WIDTH)
    peak = int(np.argmax(g))
    noise = between_halves(x, run.length)
    entry = {
        "peak_position": float(distance[peak]),
        "peak_height": float(g[peak]),
        "bin_width": float(distance[1] - distance[0]),
        "noise": noise,
    }
    if noise > NOISIEST:
        longer = run.simulated_time() * (noise / NOISIEST) ** 2
        line = f"g(x): noise of {noise:.2g}; run longer, at least {two_digits(longer)} t0"
        return Findings({"pair_correlation": entry}, left_out=(line,))
    picture = draw(distance, g, 2 * run.species().radius)
    return Findings({"pair_correlation": entry}, {"pair_correlation.png": picture})


def between_halves(x: Array, length: float) -> float:
    """Standard error of g(x) in a bin, from the difference between the halves of a run.

    Args:
        x: positions along the channel, (T, N), T at least 2 [a0].
        length: of the periodic channel [a0].
    """
    half = len(x) // 2
    _, first = pair_correlation(x[:half], length, BIN_WIDTH)
    _, second = pair_correlation(x[half:], length, BIN_WIDTH)
    return float(np.sqrt(((first - second) ** 2).mean()) / 2)


def draw(distance: Array, g: Array, diameter: float) -> Figure:
    """g(x) along the channel.

    Args:
        distance: (bins,) [a0].
        g: (bins,).
        diameter: of a colloid [a0].
    """
    figure, axes = one_panel("distance along the channel $x$ [$a_0$]", "pair correlation $g(x)$")
    axes.plot(distance, g, drawstyle="steps-mid", linewidth=1)
    axes.axhline(1, color="0.7", linewidth=0.8)
    axes.axvline(diameter, color="0.3", linestyle=":", label="colloid diameter")
    axes.set_ylim(bottom=0)
    axes.legend()
    return figure

"""Do 95 % intervals hold the truth in 95 % of runs? Estimators of the error of a mean, compared.

    python benchmarks/interval_coverage.py --out runs/coverage --docs docs

Synthetic series whose mean is 0, and pieces of one long run of three scenes, which are run into
the folder if they are missing there. Writes docs/coverage.md and docs/figures/coverage.png.
"""

import argparse
import math
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy import fft, stats
from scipy.signal import lfilter

from analysis.correlated_mean import mean
from analysis.estimate import Estimate
from analysis.flow import fit_parabola, mean_velocity
from analysis.line_fit import fit_polynomial
from analysis.run_directory import RunDirectory
from analysis.settling import settling_series
from analysis.shear_wave import wave_amplitude
from lammps_inputs import make_scene
from narrows.markdown import replace_block, table
from srd_driver.sweep import Run, run_all

Array = NDArray[np.float64]
Estimator = Callable[[Array], Estimate]
Source = Callable[[int, np.random.Generator], Array]

SAMPLES = 1000
CONFIDENCES = (0.5, 0.6827, 0.8, 0.9, 0.95, 0.99)
ASKED = (0.90, 0.98)  # for intervals of 95 %
POINTS = 6  # of a line
LONG = {
    "channel": {"duration": 20_000, "sampling_interval": 0.75},
    "poiseuille": {"duration": 100_000, "equilibration": 500, "sampling_interval": 2.0},
    "bulk": {"length": 32, "width": 32, "duration": 60_000, "sampling_interval": 2.0},
}
PIECES = 200


def autoregressive(time: float, samples: int, random: np.random.Generator) -> Array:
    """AR(1) of variance 1 with correlations exp(-t/time)."""
    factor = math.exp(-1 / time)
    noise = random.normal(size=samples) * math.sqrt(1 - factor**2)
    noise[0] /= math.sqrt(1 - factor**2)
    return np.asarray(lfilter([1], [1, -factor], noise))


def one_time(part: float) -> Source:
    """AR(1) whose correlation time is this part of the run."""
    return lambda samples, random: autoregressive(part * samples, samples, random)


def two_times(share: float, part: float) -> Source:
    """A fast AR(1) of one sample and a slow one with this share of the variance."""

    def source(samples: int, random: np.random.Generator) -> Array:
        fast = math.sqrt(1 - share) * autoregressive(1.0, samples, random)
        return fast + math.sqrt(share) * autoregressive(part * samples, samples, random)

    return source


SYNTHETIC: dict[str, Source] = {
    "white noise": lambda samples, random: random.normal(size=samples),
    "AR(1), tau = 0.005 T": one_time(0.005),
    "AR(1), tau = 0.02 T": one_time(0.02),
    "AR(1), tau = 0.05 T": one_time(0.05),
    "AR(1), tau = 0.1 T": one_time(0.1),
    "AR(1), tau = 0.2 T": one_time(0.2),
    "AR(1), tau = 0.3 T": one_time(0.3),
    **{
        f"{share:.0%} of the variance slow, tau = {part} T": two_times(share, part)
        for part in (0.02, 0.05, 0.1, 0.3)
        for share in (0.01, 0.1, 0.5)
    },
}


# ---------------------------------------------------------------------- estimators to compare


def by_blocking(series: Array) -> Estimate:
    """Blocks of the length of Lee et al., Phys. Rev. E 83, 066706 (2011), as narrows 0.1 did."""
    blocks, length, levels = series, 1, []
    while len(blocks) >= 6:
        levels.append((length, blocks.var(ddof=1) / len(blocks)))
        blocks = blocks[: len(blocks) // 2 * 2].reshape(-1, 2).mean(axis=1)
        length *= 2
    for length, variance in levels:
        if length**3 > 2 * len(series) * max(1.0, variance / levels[0][1]) ** 2:
            break
    return Estimate(float(series.mean()), math.sqrt(variance))


def by_twenty_batches(series: Array) -> Estimate:
    """Means of 20 batches and Student's t."""
    means = series[: len(series) // 20 * 20].reshape(20, -1).mean(axis=1)
    return Estimate(float(series.mean()), float(stats.sem(means)), freedom=19)


def by_eight_modes(series: Array) -> Estimate:
    """The eight slowest cosine modes, equally weighted, and Student's t with 8.

    E. Lazarus, D. J. Lewis, J. H. Stock and M. W. Watson, J. Bus. Econ. Stat. 36, 541 (2018).
    """
    modes = fft.dct(series, norm="ortho")[1:9]
    return Estimate(float(series.mean()), math.sqrt((modes**2).mean() / len(series)), freedom=8)


def by_window(series: Array) -> Estimate:
    """Sum of the autocorrelation up to 5 of its own tau (Sokal; emcee's `integrated_time`)."""
    count, centred = len(series), series - series.mean()
    spectrum = np.abs(np.fft.rfft(centred, 2 * count)) ** 2
    correlation = np.fft.irfft(spectrum)[:count]
    sums = 2 * np.cumsum(correlation / correlation[0]) - 1
    window = np.arange(count) >= 5 * sums
    inefficiency = max(float(sums[int(np.argmax(window)) if window.any() else -1]), 1e-3)
    variance = float(series.var(ddof=1)) / count
    return Estimate(float(series.mean()), math.sqrt(variance * inefficiency))


def by_autoregression(series: Array) -> Estimate:
    """Spectrum at 0 of the AR(p) with the least AIC (coda's `spectrum0.ar`)."""
    count, centred = len(series), series - series.mean()
    spectrum = np.abs(np.fft.rfft(centred, 2 * count)) ** 2
    covariance = np.fft.irfft(spectrum)[:count] / count
    noise, factors = float(covariance[0]), np.empty(0)
    best, at_zero = math.inf, noise
    for order in range(int(10 * math.log10(count)) + 1):
        if order:  # Levinson and Durbin
            reflection = (covariance[order] - factors @ covariance[order - 1 : 0 : -1]) / noise
            factors = np.append(factors - reflection * factors[::-1], reflection)
            noise *= 1 - reflection**2
        criterion = count * math.log(noise) + 2 * order
        if criterion < best:
            best, at_zero = criterion, noise / (1 - factors.sum()) ** 2
    return Estimate(float(series.mean()), math.sqrt(at_zero / count))


ESTIMATORS: dict[str, Estimator] = {
    "spectrum at 0": mean,
    "blocking": by_blocking,
    "20 batches": by_twenty_batches,
    "8 modes": by_eight_modes,
    "window": by_window,
    "AR(p)": by_autoregression,
}

COLUMNS = ["series", *ESTIMATORS, "width", "alarms"]


# ---------------------------------------------------------------------- what is counted


def p_values(estimates: Sequence[Estimate], truth: float = 0.0) -> Array:
    """Chance of a deviation as great as each; uniform between 0 and 1 if the errors are right."""
    return np.array([2 * stats.norm.sf(abs(e.deviation(truth))) for e in estimates])


def coverage(p: Array, confidence: float = 0.95) -> float:
    """Part of the intervals that hold the truth."""
    return float((p > 1 - confidence).mean())


def width(estimates: Sequence[Estimate]) -> float:
    """Median half of the 95 % interval over that of a normal distribution with the true error."""
    true_error = float(np.std([e.number for e in estimates]))
    return float(np.median([e.half_width() for e in estimates])) / (1.96 * true_error)


def differences(trials: int, random: np.random.Generator) -> Iterator[Estimate]:
    """Of the means of two runs of 40 correlation times."""
    source = one_time(1 / 40)
    for _ in range(trials):
        yield mean(source(SAMPLES, random)) - mean(source(SAMPLES, random))


def slopes(trials: int, random: np.random.Generator) -> Iterator[Estimate]:
    """Of a line through six such means."""
    source = one_time(1 / 40)
    for _ in range(trials):
        points = [mean(source(SAMPLES, random)) for _ in range(POINTS)]
        yield fit_polynomial(np.arange(POINTS), points).slope


def observables(folder: Path) -> Iterator[tuple[str, Array, float | None]]:
    """Name, series over a long run, and its mean where that is known."""
    settling = settling_series(RunDirectory(folder / "channel"))
    yield "channel: settling speed", settling.co_moving[settling.used], None
    yield "channel: settling speed at rest", settling.rest[settling.used], None
    run = RunDirectory(folder / "channel")
    y = run.particles().positions[run.particles().steps > run.equilibration_steps, :, 1]
    yield "channel: square distance from the mid-line", ((y - run.width / 2) ** 2).mean(1), None
    run = RunDirectory(folder / "poiseuille")
    fluid = run.profile()
    used = run.sampled(fluid.steps)
    counts, velocity = fluid.counts[used], fluid.velocity_x[used]
    yield "poiseuille: fluid velocity", mean_velocity(counts, velocity), None
    yield "poiseuille: wall slip", fit_parabola(fluid.y, run.width, counts, velocity)[1], None
    run = RunDirectory(folder / "bulk")
    fluid = run.profile()
    amplitude = wave_amplitude(fluid.y, run.width, fluid.counts, fluid.velocity_x)
    yield "bulk: thermal shear wave", amplitude[run.sampled(fluid.steps)], 0.0


def row(name: str, results: dict[str, list[Estimate]], truth: float = 0.0) -> list[str]:
    """Coverage of each estimator, and the width and the alarms of ours."""
    ours = results["spectrum at 0"]
    told = sum(estimate.reason is not None for estimate in ours) / len(ours)
    cells = [f"{coverage(p_values(found, truth)):.1%}" for found in results.values()]
    cells += [""] * (len(ESTIMATORS) - len(results))
    return [name, *cells, f"{width(ours):.2f}", f"{told:.0%}"]


def figure(curves: dict[str, Array], file: Path) -> None:
    """Nominal against observed coverage."""
    sheet = Figure(figsize=(11, 4.6), layout="constrained")
    left, right = sheet.subplots(1, 2, sharex=True, sharey=True)
    names = list(curves)
    for axes, some in (
        (left, [n for n in names if n in SYNTHETIC]),
        (right, [n for n in names if n not in SYNTHETIC]),
    ):
        axes.plot([0, 1], [0, 1], color="0.7", linewidth=0.8)
        axes.plot([0.95, 0.95], ASKED, color="k", linewidth=5, alpha=0.3)
        for number, name in enumerate(some):
            observed = [coverage(curves[name], c) for c in CONFIDENCES]
            style: dict[str, Any] = {"color": f"C{number % 10}", "linewidth": 0.8, "markersize": 3}
            axes.plot(CONFIDENCES, observed, "os^"[number // 10] + "-", label=name, **style)
        axes.set(xlabel="nominal coverage", xlim=(0.45, 1), ylim=(0.3, 1))
        axes.legend(fontsize=6)
    left.set_ylabel("observed coverage")
    sheet.savefig(file, dpi=150)


def main() -> None:
    """Runs what is missing, counts, writes the page."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--out", type=Path, required=True, help="folder of the runs")
    parser.add_argument("--docs", type=Path, required=True, help="folder of the pages")
    parser.add_argument("--trials", type=int, default=400, help="series of each kind")
    parser.add_argument("--seed", type=int, default=1, help="of the series")
    options = parser.parse_args()
    runs = [
        Run(options.out / name, make_scene(name, **fields, seed=options.seed), "mpc")
        for name, fields in LONG.items()
    ]
    run_all(runs, jobs=1)
    rows: list[list[str]] = []
    curves: dict[str, Array] = {}
    random = np.random.default_rng(options.seed)
    for name, source in SYNTHETIC.items():
        series = [source(SAMPLES, random) for _ in range(options.trials)]
        results = {key: [by(run) for run in series] for key, by in ESTIMATORS.items()}
        curves[name] = p_values(results["spectrum at 0"])
        rows.append(row(name, results))
    for name, found in {
        "difference of two means, tau = T/40": [*differences(options.trials, random)],
        "slope through six means, tau = T/40": [*slopes(options.trials, random)],
    }.items():
        curves[name] = p_values(found)
        rows.append(row(name, {"spectrum at 0": found}))
    for name, whole, known in observables(options.out):
        truth = float(whole.mean()) if known is None else known
        length = len(whole) // PIECES
        pieces = whole[: PIECES * length].reshape(PIECES, length)
        results = {key: [by(piece) for piece in pieces] for key, by in ESTIMATORS.items()}
        curves[name] = p_values(results["spectrum at 0"], truth)
        rows.append(row(f"{name} ({length} samples)", results, truth))
    replace_block(options.docs / "coverage.md", "table", table(COLUMNS, rows))
    figure(curves, options.docs / "figures" / "coverage.png")
    print(table(COLUMNS, rows))


if __name__ == "__main__":
    main()

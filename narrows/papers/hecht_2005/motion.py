"""Figs. 8 and 14: velocities under shear, and diffusion that slows as clusters form."""

import math

import numpy as np
from scipy import stats

from analysis import analyze
from analysis.estimate import Estimate
from analysis.measures.settling_speed import sampled_frames
from analysis.normality import normality
from lammps_inputs import Scene
from lammps_inputs.scenes.claylike import Claylike
from narrows.papers.drawing import one_panel
from narrows.papers.figure import Directories, Outcome, PaperFigure, Quality
from narrows.papers.hecht_2005.structure import production
from narrows.papers.results import PaperNumber, claimed, compared, measured

AXES = "xyz"
FORGOTTEN = 40.0  # between velocities taken as independent [t0]
PERIOD = 10.0  # of a displacement [t0]
PARTS = 4  # of the run, whose displacements are compared


def sheared(quality: Quality) -> Claylike:
    """Between a bottom and a lid that move, with gravity; the paper gives no numbers."""
    full = quality == "full"
    return Claylike.make(
        surface_potential=0.05,
        kappa=7.3e7,
        boundaries="bottom",
        peclet=0.11,
        shear_rate=0.004,
        duration=2000.0 if full else 80.0,
        equilibration=300.0 if full else 20.0,
        sampling_interval=4.0,
    )


def _sheared(directories: Directories, quality: Quality) -> Outcome:
    run = directories[sheared(quality)]
    entry = analyze(run.path)["shear_flow"]["rate"]
    rate = Estimate(entry["value"], entry["error"])
    used, particles = sampled_frames(run), run.particles()
    velocities = particles.velocities[used].copy()
    height = particles.positions[used, :, 2] - 0.5 * run.box.sizes[2]
    velocities[:, :, 0] -= rate.number * height
    results = [measured("8", "shear rate of the colloids [1/t0]", rate)]
    try:
        found = normality(velocities, max(1, math.ceil(FORGOTTEN / run.interval)))
    except ValueError as error:
        unknown = Estimate(None, None, str(error))
        results.append(measured("8", "excess kurtosis of the velocities", unknown))
    else:
        for axis, value in zip(AXES, found.excess_kurtosis, strict=True):
            kurtosis = Estimate(float(value), found.kurtosis_error)
            quantity = f"excess kurtosis of v_{axis}"
            results.append(compared("8", quantity, kurtosis, PaperNumber(0.0)))
    figure, axes = one_panel("velocity [$a_0/t_0$]", "probability density [$t_0/a_0$]")
    width = 1 / math.sqrt(run.species().mass)
    edges = np.linspace(-4.5 * width, 4.5 * width, 46)
    middle = 0.5 * (edges[1:] + edges[:-1])
    table: dict[str, list[float]] = {"v": middle.tolist()}
    for number, axis in enumerate(AXES):
        density, _ = np.histogram(velocities[:, :, number], edges, density=True)
        axes.semilogy(middle, density, "o", markersize=3, label=f"$v_{axis}$")
        table[axis] = density.tolist()
    axes.semilogy(middle, stats.norm.pdf(middle, scale=width), color="0.3", label="Gaussian")
    axes.legend()
    return Outcome(figure, table, results)


def clustering(quality: Quality) -> Claylike:
    """Fig. 14: 1155 colloids."""
    return production(0.05, 3e8, 0.35, quality)


def _slowing(directories: Directories, quality: Quality) -> Outcome:
    run = directories[clustering(quality)]
    particles = run.particles()
    positions, times = particles.positions, run.times(particles.steps)
    lag = max(1, round(PERIOD / run.interval))
    figure, axes = one_panel("time [$t_0$]", "mean squared displacement [$a_0^2$]")
    square = ((positions - positions[0]) ** 2).mean(axis=1)
    table: dict[str, list[float]] = {"t": times.tolist()}
    for number, axis in enumerate(AXES):
        axes.plot(times, square[:, number], label=f"${axis}$")
        table[axis] = square[:, number].tolist()
    axes.legend()
    moved = ((positions[lag:] - positions[:-lag]) ** 2).mean(axis=1) / (2 * lag * run.interval)
    parts = [part.mean(axis=0) for part in np.array_split(moved, PARTS)]
    speeds = [
        Estimate(float(part.mean()), float(part.std(ddof=1) / math.sqrt(len(part))))
        for part in parts
    ]
    results = [
        measured("14", f"D over {PERIOD:g} t0 in quarter {number} of the run [a0^2/t0]", speed)
        for number, speed in enumerate(speeds, start=1)
    ]
    results.append(
        claimed(
            "14",
            "D in the first quarter less that in the last [a0^2/t0]",
            speeds[0] - speeds[-1],
            "clusters form, and the mobility of the colloids decays",
            "positive",
        )
    )
    return Outcome(figure, table, results)


def _sheared_scenes(quality: Quality) -> list[Scene]:
    return [sheared(quality)]


def _clustering_scenes(quality: Quality) -> list[Scene]:
    return [clustering(quality)]


SHEAR = (
    PaperFigure(
        "8",
        "Velocities of the colloids about the flow between walls that move, with gravity.",
        _sheared,
        _sheared_scenes,
    ),
)
SLOWING = (
    PaperFigure(
        "14",
        "Mean squared displacement of 35 % of colloids at 50 mV, 3e8 / m, from the start on.",
        _slowing,
        _clustering_scenes,
    ),
)

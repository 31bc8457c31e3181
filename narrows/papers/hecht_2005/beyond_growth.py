"""Beyond the paper: clusters in time, with hydrodynamics and without.

7 % of colloids at 50 mV and 3e8 / m, the attraction of Fig. 14, from a lattice on, in the fluid and
in a bath that forgets momentum. Where clusters of any size stick at the same rate, their mean size
is 1 + t / tau, and by Smoluchowski 1 / tau = 8 pi D a n: two colloids of a diffusion coefficient D
that meet at a distance a, n of them in a volume.
"""

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from analysis import RunDirectory
from analysis.arrays import Array
from analysis.clusters import BOND, cluster_series
from analysis.estimate import Estimate, mean_of_independent
from analysis.line_fit import fit_runs
from analysis.measures.settling_speed import sampled_frames
from analysis.suspension_diffusion import suspension_diffusion
from lammps_inputs import Scene
from lammps_inputs.scenes.claylike import Claylike
from narrows.papers.drawing import COLOURS
from narrows.papers.figure import Column, Directories, Outcome, PaperFigure, Quality
from narrows.papers.hecht_2005 import settling
from narrows.papers.results import Result, measured

NUMBER = "beyond-growth"
SOLVENTS = {"on": "with hydrodynamics", "bath": "without"}
LONGEST = 25.0  # lag of the mean squared displacement, as in Fig. 3 [t0]
EARLY = 2.0  # mean size up to which growth is that of pairs
LATE = 0.25  # of the run, from which on growth is a power of time


def growing(solvent: str, seed: int, quality: Quality) -> Claylike:
    """231 colloids from a lattice on."""
    return Claylike.make(
        surface_potential=0.05,
        kappa=3e8,
        volume_fraction=0.07,
        hydrodynamics=solvent,
        duration=800.0 if quality == "full" else 120.0,
        equilibration=0.0,
        sampling_interval=2.0,
        seed=seed,
    )


def runs_in(solvent: str, quality: Quality) -> list[Claylike]:
    """Seeds."""
    return [growing(solvent, seed, quality) for seed in range(1, 7 if quality == "full" else 5)]


def lone(solvent: str, quality: Quality) -> Claylike:
    """Hardly any neighbours, which tells D: the run of Fig. 3, and the same in a bath."""
    return Claylike.make(**(settling.dilute(quality).model_dump() | {"hydrodynamics": solvent}))


def scenes(quality: Quality) -> list[Scene]:
    """All runs."""
    growing: list[Scene] = [scene for each in SOLVENTS for scene in runs_in(each, quality)]
    return [*growing, *(lone(each, quality) for each in SOLVENTS)]


def series(run: RunDirectory) -> tuple[Array, Array, Array]:
    """Times (T,) [t0], colloids over clusters, lone ones counted, and the largest one's share."""
    particles, box = run.particles(), run.box
    distance = BOND * 2 * run.species().radius
    found = cluster_series(particles.positions, box.sizes, box.periodic, distance)
    count = particles.positions.shape[1]
    return run.times(particles.steps), count / (found.number + found.alone), found.largest / count


def lone_diffusion(run: RunDirectory) -> Estimate:
    """D by the mean squared displacement (36) [a0^2/t0]."""
    positions = run.particles().positions[sampled_frames(run)]
    return suspension_diffusion(positions, run.interval, LONGEST).from_msd


def early_rate(times: Array, sizes: Sequence[Array]) -> Estimate:
    """1 / tau of mean sizes that are 1 + t / tau until they are `EARLY`, each run by itself [1/t0].

    Args:
        times: (T,) [t0].
        sizes: of each run, (T,).
    """
    rates = []
    for size in sizes:
        used = np.cumsum(size > EARLY) == 0
        t, grown = times[used] - times[0], size[used] - size[0]
        rates.append(float(t @ grown / (t @ t)))
    return mean_of_independent(rates)


def late_exponent(times: Array, sizes: Sequence[Array]) -> Estimate:
    """z of mean sizes t^z from `LATE` of the run on, each run by itself."""
    late = times >= times[0] + LATE * (times[-1] - times[0])
    return fit_runs(np.log(times[late]), np.log(np.array(sizes)[:, late]))[1]


def _make(directories: Directories, quality: Quality) -> Outcome:
    figure = Figure(figsize=(9.0, 4.0), layout="constrained")
    left, right = figure.subplots(1, 2)
    table: dict[str, Column] = {}
    results: list[Result] = []
    of_solvent = {}
    for number, (solvent, words) in enumerate(SOLVENTS.items()):
        found = [series(directories[scene]) for scene in runs_in(solvent, quality)]
        times, sizes, shares = found[0][0], [each[1] for each in found], [each[2] for each in found]
        table["t"] = times.tolist()
        for axes, name, values in ((left, "mean_size", sizes), (right, "largest", shares)):
            mean, error = np.mean(values, axis=0), np.std(values, axis=0, ddof=1)
            error /= math.sqrt(len(values))
            axes.plot(times, mean, color=COLOURS[number], label=words)
            axes.fill_between(times, mean - error, mean + error, color=COLOURS[number], alpha=0.2)
            table[f"{name}_{solvent}"] = mean.tolist()
            table[f"{name}_{solvent}_error"] = error.tolist()
        rate, exponent = early_rate(times, sizes), late_exponent(times, sizes)
        ended = mean_of_independent([float(size[-1]) for size in sizes])
        diffusion = lone_diffusion(directories[lone(solvent, quality)])
        scene = growing(solvent, 1, quality)
        density = scene.colloids / scene.cells**3
        meeting = 2 * BOND * scene.model.reduced_radius
        smoluchowski = diffusion.scaled(8 * math.pi * meeting * density)
        of_solvent[solvent] = rate, exponent, diffusion, ended
        results += [
            measured(NUMBER, f"D of a colloid by itself, {words} [a0^2/t0]", diffusion),
            measured(NUMBER, f"growth of the mean cluster up to {EARLY:g}, {words} [1/t0]", rate),
            measured(NUMBER, f"the same over Smoluchowski's, {words}", rate / smoluchowski),
            measured(
                NUMBER,
                f"exponent of the mean cluster, t from {LATE * times[-1]:.0f} to {times[-1]:.0f}, "
                f"{words}",
                exponent,
            ),
            measured(NUMBER, f"mean cluster at {times[-1]:.0f} t0, {words}", ended),
        ]
    (rate, exponent, diffusion, ended), other = of_solvent["on"], of_solvent["bath"]
    results += [
        measured(NUMBER, "growth up to 2, with hydrodynamics over without", rate / other[0]),
        measured(NUMBER, "D, with hydrodynamics over without", diffusion / other[2]),
        measured(NUMBER, "exponent, with hydrodynamics less without", exponent - other[1]),
        measured(NUMBER, "mean cluster at the end, with over without", ended / other[3]),
    ]
    left.set(xlabel="time [$t_0$]", ylabel="colloids over clusters", xscale="log", yscale="log")
    right.set(xlabel="time [$t_0$]", ylabel="share of the largest cluster")
    left.legend()
    return Outcome(figure, table, results)


FIGURES = (
    PaperFigure(
        NUMBER,
        "Clusters of 7 % of colloids at 50 mV, 3e8 / m in time; bands: standard error over seeds.",
        _make,
        scenes,
    ),
)

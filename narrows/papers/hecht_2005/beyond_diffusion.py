"""Beyond the paper: its open question of section X D.

How D depends on the potential and the volume fraction, and which of the motions that X D lists is
left of it where: of colloids that leave their cluster, of clusters as a whole, or of their members
about it. The runs are those of the boundary, looked at in their second half.
"""

from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from analysis import RunDirectory, correlated_mean
from analysis.cluster_motion import cluster_motion
from analysis.clusters import BOND
from analysis.estimate import Estimate
from narrows.papers.drawing import COLOURS, MARKERS, points
from narrows.papers.figure import Column, Directories, Outcome, PaperFigure, Quality
from narrows.papers.hecht_2005.beyond_boundary import (
    KAPPAS,
    SURFACE_POTENTIALS,
    attraction,
    from_lattice,
    scenes_at,
)
from narrows.papers.hecht_2005.motion import PERIOD
from narrows.papers.results import Result, claimed, measured

NUMBER = "beyond-diffusion"
PARTS = {
    "alone": "alone",
    "left": "left their neighbours",
    "together": "clusters as a whole",
    "about": "members about their cluster",
}


@dataclass(frozen=True)
class Mobility:
    """Of a run's second half.

    Attributes:
        diffusion: mean squared displacement over `PERIOD` in one direction, over twice it
            [a0^2/t0].
        drift: the same in the last quarter less in the third.
        parts: of it, shares that add up to 1, in the order of `PARTS`.
        broken: bonds that are gone after `PERIOD`, over all.
    """

    diffusion: Estimate
    drift: Estimate
    parts: tuple[Estimate, ...]
    broken: Estimate


def mobility(run: RunDirectory) -> Mobility:
    """How colloids move over `PERIOD` in the second half of a run."""
    positions = run.particles().positions
    positions = positions[len(positions) // 2 :]
    positions = positions - positions.mean(axis=1, keepdims=True)
    lag = max(1, round(PERIOD / run.interval))
    time = lag * run.interval
    moved = ((positions[lag:] - positions[:-lag]) ** 2).mean(axis=(1, 2)) / (2 * time)
    third, last = np.array_split(moved, 2)
    motion = cluster_motion(positions, run.box.sizes, BOND * 2 * run.species().radius, lag)
    return Mobility(
        correlated_mean.mean(moved, run.interval),
        correlated_mean.mean(last, run.interval) - correlated_mean.mean(third, run.interval),
        tuple(correlated_mean.ratio(getattr(motion, name), motion.all, time) for name in PARTS),
        correlated_mean.mean(motion.broken, time),
    )


def _make(directories: Directories, quality: Quality) -> Outcome:
    found = {
        (fraction, kappa, psi): mobility(directories[scene])
        for fraction in SURFACE_POTENTIALS
        for kappa in KAPPAS
        for psi, scene in scenes_at(fraction, kappa, quality).items()
    }
    attracting = {key: attraction(key[2] / 1e3, key[1]) for key in found}
    results: list[Result] = []
    for fraction in SURFACE_POTENTIALS:
        keys = sorted((k for k in found if k[0] == fraction), key=lambda k: attracting[k].depth)
        for key, words in ((keys[0], "shallowest"), (keys[-1], "deepest")):
            each = found[key]
            where = f"{words} minimum, {fraction:.0%}, {key[2]} mV, {key[1]:.2g} / m"
            told = f"D over {PERIOD:g} t0, {where} [a0^2/t0]"
            results.append(measured(NUMBER, told, each.diffusion))
            results += [
                measured(NUMBER, f"share of the motion: {PARTS[name]}, {where}", part)
                for name, part in zip(PARTS, each.parts, strict=True)
            ]
            told = f"bonds broken within {PERIOD:g} t0, share, {where}"
            results.append(measured(NUMBER, told, each.broken))
        results.append(
            claimed(
                NUMBER,
                f"D at the shallowest less at the deepest minimum, {fraction:.0%} [a0^2/t0]",
                found[keys[0]].diffusion - found[keys[-1]].diffusion,
                "the particles in the cluster are relatively fixed",
                "positive",
            )
        )
    drifting = [
        key for key, each in found.items() if abs(each.drift.number) > each.drift.half_width()
    ]
    told = f"of {len(found)} states, those whose D still changes"
    results.append(measured(NUMBER, told, Estimate(float(len(drifting)), 0.0)))
    table: dict[str, Column] = {
        "volume_fraction": [key[0] for key in found],
        "kappa": [f"{key[1]:.2g}" for key in found],
        "surface_potential_mV": [key[2] for key in found],
        "depth": [round(each.depth, 3) for each in attracting.values()],
        "virial": [round(each.virial, 3) for each in attracting.values()],
    }
    columns = {
        "diffusion": [each.diffusion for each in found.values()],
        "drift": [each.drift for each in found.values()],
        **{
            name: [each.parts[number] for each in found.values()]
            for number, name in enumerate(PARTS)
        },
        "broken": [each.broken for each in found.values()],
    }
    for name, values in columns.items():
        table[name] = [each.value for each in values]
        table[f"{name}_error"] = [each.error for each in values]
    depths = {key: each.depth for key, each in attracting.items()}
    return Outcome(_draw(found, depths), table, results)


def _draw(
    found: dict[tuple[float, float, int], Mobility], depths: dict[tuple[float, float, int], float]
) -> Figure:
    figure = Figure(figsize=(11.5, 3.9), layout="constrained")
    left, middle, right = figure.subplots(1, 3)
    for number, fraction in enumerate(SURFACE_POTENTIALS):
        keys = sorted((key for key in found if key[0] == fraction), key=lambda key: depths[key])
        x = [depths[key] for key in keys]
        label = f"{fraction:.0%}"
        points(left, x, [found[key].diffusion for key in keys], number, label=label)
        points(right, x, [found[key].broken for key in keys], number, label=label)
    keys = sorted((key for key in found if key[0] == 0.14), key=lambda key: depths[key])
    for number, words in enumerate(PARTS.values()):
        middle.plot(
            [depths[key] for key in keys],
            [found[key].parts[number].number for key in keys],
            color=COLOURS[number],
            marker=MARKERS[number],
            linewidth=0.8,
            label=words,
        )
    label = "depth of the minimum [$k_B T$]"
    left.set(xlabel=label, ylabel=f"$D$ over {PERIOD:g} $t_0$ [$a_0^2/t_0$]", ylim=(0, None))
    middle.set(xlabel=label, ylabel="share of the motion, 14 %", ylim=(0, 1))
    right.set(xlabel=label, ylabel=f"bonds broken within {PERIOD:g} $t_0$", ylim=(0, None))
    left.legend()
    middle.legend()
    return figure


FIGURES = (
    PaperFigure(
        NUMBER,
        "D by the depth of the minimum at three volume fractions, what moves at 14 %, and bonds "
        "that break.",
        _make,
        from_lattice,
    ),
)

"""Normal speeds with which colours reacted: Maxwellian where the reaction is slow enough."""

import math

import numpy as np

from analysis.arrays import Array
from analysis.colors import blocks_of, estimate, reactions_of
from analysis.drawing import one_panel
from analysis.findings import Findings
from analysis.run_directory import RunDirectory

QUANTITIES = ("reacted_speed.*",)


def measure(run: RunDirectory) -> Findings:
    """Mean speed for every reaction probability, beside that of all visits to the surfaces.

    In equilibrium visits have the density v exp(-v^2 / 2 s^2) / s^2, of mean s sqrt(pi / 2); s^2 is
    kBT / m at a wall, twice that for two particles.
    """
    reactions = reactions_of(run)
    width = 1.0 if reactions.axis is not None else math.sqrt(2)
    bins = run.bins("speeds")
    blocks, speeds = blocks_of(run, len(bins.steps)), bins.positions

    def mean(counts: Array) -> Array:
        return np.asarray(counts @ speeds / max(counts.sum(), 1e-300))

    figure, axes = one_panel("normal speed of what reacted $v$", "probability density")
    entries = {}
    step = float(np.diff(speeds).mean())
    for k, p in enumerate(reactions.probabilities, start=1):
        by_block = np.array([bins[f"chances_{k}"][block].sum(axis=0) for block in blocks])
        found = estimate(mean, by_block).as_json()
        entries[f"p={p:g}"] = found | {"theory": width * math.sqrt(math.pi / 2)}
        total = by_block.sum(axis=0)
        axes.plot(speeds, total / (total.sum() * step), label=f"reaction probability {p:g}")
    maxwell = speeds / width**2 * np.exp(-(speeds**2) / (2 * width**2))
    axes.plot(speeds, maxwell, "k--", label="all visits in equilibrium")
    axes.set(xlim=(0, 5 * width), ylim=(0, None))
    axes.legend()
    return Findings({"reacted_speed": entries}, {"reacted_speeds.png": figure})

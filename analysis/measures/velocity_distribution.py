"""Whether the velocities of the colloids are Gaussian."""

import math

import numpy as np
from matplotlib.figure import Figure
from scipy import stats

from analysis.arrays import Array
from analysis.drawing import one_panel
from analysis.findings import Findings
from analysis.measures.settling_speed import sampled_frames
from analysis.normality import FALSE_ALARMS, normality
from analysis.run_directory import RunDirectory

QUANTITIES = ("velocity_distribution.excess_kurtosis.*",)

FORGOTTEN = 10  # relaxation times of Stokes's friction


def measure(run: RunDirectory) -> Findings:
    """A test of normality in each direction, on velocities far enough apart to be independent."""
    species, solvent = run.species(), run.solvent
    velocities = run.particles().velocities[sampled_frames(run)]
    relaxation = species.mass
    if solvent.viscosity_theory:
        drag = 6 * math.pi * solvent.density * solvent.viscosity_theory * species.radius
        relaxation = species.mass / drag
    apart = max(1, math.ceil(FORGOTTEN * relaxation / run.interval))
    try:
        found = normality(velocities, apart)
    except ValueError as error:
        return Findings({"velocity_distribution": {"normal": None, "reason": str(error)}})
    entry = {
        "normal": found.normal,
        "false_alarms": FALSE_ALARMS,
        "samples": found.samples,
        "p_values": found.p_values.tolist(),
        "excess_kurtosis": {
            axis: {"value": float(value), "error": found.kurtosis_error}
            for axis, value in zip("xyz", found.excess_kurtosis, strict=False)
        },
    }
    return Findings(
        {"velocity_distribution": entry},
        {"velocity_distribution.png": draw(velocities[::apart], species.mass)},
    )


def draw(velocities: Array, mass: float) -> Figure:
    """Histograms of the components beside the Gaussian of kBT = 1, as in Fig. 8."""
    figure, axes = one_panel("velocity [$a_0/t_0$]", "probability density [$t_0/a_0$]")
    width = 1 / math.sqrt(mass)
    edges = np.linspace(-4.5 * width, 4.5 * width, 46)
    middle = 0.5 * (edges[1:] + edges[:-1])
    for axis, name in enumerate("xyz"[: velocities.shape[2]]):
        density, _ = np.histogram(velocities[:, :, axis], edges, density=True)
        axes.semilogy(middle, density, "o", markersize=3, label=f"$v_{name}$")
    axes.semilogy(middle, stats.norm.pdf(middle, scale=width), color="0.3", label="Gaussian")
    axes.legend()
    return figure

"""Fig. 1: DLVO potentials, whose secondary minima decide between suspension and clusters."""

import numpy as np

from analysis.estimate import Estimate
from lammps_inputs.potentials.dlvo import Dlvo
from lammps_inputs.scenes.claylike import Claylike
from narrows.papers.drawing import one_panel, shades
from narrows.papers.figure import Directories, Outcome, PaperFigure, Quality
from narrows.papers.results import claimed

CASES = ((50, 7.3e7), (20, 1.0e8), (20, 1.4e8), (20, 2.0e8), (50, 2.0e8), (50, 3.0e8))


def potential(millivolts: float, kappa: float) -> tuple[Dlvo, float]:
    """Between two colloids of the production runs, and their radius [a0]."""
    scene = Claylike.make(surface_potential=millivolts / 1e3, kappa=kappa)
    assert scene.between is not None
    return scene.between, scene.model.reduced_radius


def _make(directories: Directories, quality: Quality) -> Outcome:
    figure, axes = one_panel("distance $r$ [$R$]", "energy $V$ [$k_B T$]")
    distance = np.linspace(2.0, 2.7, 1400)
    table: dict[str, list[float]] = {"r/R": distance.tolist()}
    results = []
    for colour, (millivolts, kappa) in zip(shades(len(CASES)), CASES, strict=True):
        between, radius = potential(millivolts, kappa)
        energy = between.energy(distance * radius)
        name = f"{millivolts} mV, {kappa:.2g} / m"
        axes.plot(distance, energy, color=colour, label=name)
        table[name] = energy.tolist()
        outside = distance * radius > between.joint
        barrier = int(np.argmax(np.where(outside, energy, -np.inf)))
        if 0 < barrier < len(distance) - 1:
            depth = float(-energy[barrier:].min())
            claim = "there is a secondary minimum"
            quantity = f"its depth at {name} [kBT]"
            results.append(claimed("1", quantity, Estimate(depth, 0.0), claim, "positive"))
    axes.set_ylim(-12, 12)
    axes.axhline(0, color="0.7", linewidth=0.8)
    axes.legend()
    return Outcome(figure, table, results)


FIGURES = (
    PaperFigure(
        "1",
        "DLVO potentials of alumina spheres of 0.25 um in water, with the parabola at contact.",
        _make,
        origin="No run: equations (1) to (3).",
    ),
)

"""Poiseuille flow of the pure fluid, Figs. 3.6 and 3.7: its parabola and the viscosity."""

from dataclasses import dataclass
from functools import partial

import numpy as np

from analysis import analyze, flow
from analysis.estimate import Estimate
from lammps_inputs import Scene
from lammps_inputs.scenes.poiseuille import Poiseuille
from narrows.papers.drawing import one_panel, paper_line
from narrows.papers.figure import Directories, Outcome, PaperFigure, Quality
from narrows.papers.results import PaperNumber, compared, measured


@dataclass(frozen=True)
class Slit:
    """One of the two figures: its number, scene and what the thesis prints for it."""

    number: str
    length: int
    width: int
    density: float
    full_duration: float
    quick_duration: float
    viscosity: PaperNumber
    theory: PaperNumber

    def scene(self, quality: Quality) -> Poiseuille:
        """tau_c = 0.1, alpha = 90 degrees, g = 0.001; from rest, in 400 t0 to the steady flow."""
        duration = self.full_duration if quality == "full" else self.quick_duration
        return Poiseuille.make(
            length=self.length,
            width=self.width,
            density=self.density,
            duration=duration,
            sampling_interval=50.0,
        )

    def scenes(self, quality: Quality) -> list[Scene]:
        """The one scene."""
        return [self.scene(quality)]


SLITS = (
    Slit(
        *("3.6", 25, 25, 10.0, 100_000.0, 12_000.0),
        *(PaperNumber.printed("0.729"), PaperNumber.printed("0.755")),
    ),
    Slit(
        *("3.7", 20, 10, 5.0, 1_000_000.0, 40_000.0),
        *(PaperNumber.printed("0.6179"), PaperNumber.printed("0.6802")),
    ),
)


def _estimate(entry: dict[str, float | None]) -> Estimate:
    return Estimate(entry["value"], entry["error"])


def _make(slit: Slit, directories: Directories, quality: Quality) -> Outcome:
    run = directories[slit.scene(quality)]
    summary = analyze(run.path)
    fluid = run.profile()
    used = run.sampled(fluid.steps)
    momentum = flow.momentum_profile(fluid.counts[used], fluid.velocity_x[used])
    velocity = momentum.mean(axis=0)
    v_max = summary["maximum_velocity"]["value"]
    v_wall = summary["wall_slip"]["value"] / 100 * v_max
    width, gravity = float(slit.width), float(run.acceleration("fluid")[0])

    figure, axes = one_panel("across the slit $y$  [$a_0$]", "fluid velocity $v_x$  [$a_0/t_0$]")
    axes.plot(fluid.y, velocity, "o", markersize=4, label="mean in each bin")
    fine = np.linspace(0, width, 400)
    shape = flow.parabola(fine, width)
    label = f"parabola with slip: $v_{{max}}$ = {v_max:.4f}, at the wall {v_wall:.4f}"
    axes.plot(fine, v_wall + (v_max - v_wall) * shape, color="0.25", label=label)
    for paper, style, words in (
        (slit.viscosity, "--", "measured"),
        (slit.theory, ":", "theory"),
    ):
        speed = gravity * width**2 / (8 * paper.value)
        label = rf"thesis, {words}: $\nu$ = {paper.value:g}"
        paper_line(axes, fine, speed * shape, label, linestyle=style)
    axes.set(xlim=(0, width), ylim=(0, None))
    axes.legend(loc="lower center")

    slip = summary["wall_slip"]
    number = slit.number
    results = [
        compared(
            number,
            "viscosity from the maximum, (3.15) [a0^2/t0]",
            _estimate(summary["viscosity"]),
            slit.viscosity,
            f"includes the slip at the walls, {slip['value']:.1f} % of the maximum; this is why it "
            "lies below theory; the thesis gives neither an error nor how long it averaged",
        ),
        compared(
            number,
            "viscosity by kinetic theory, (3.16) [a0^2/t0]",
            Estimate(summary["viscosity"]["theory"], 0.0),
            slit.theory,
        ),
        compared(
            number,
            "viscosity from the curvature of the parabola [a0^2/t0]",
            _estimate(summary["viscosity_curvature"]),
            slit.theory,
            "free of the slip at the walls; beside the theory of the thesis",
        ),
        measured(number, "slip at the walls [% of the maximum]", _estimate(slip)),
    ]
    table = {"y_a0": fluid.y.tolist(), "v_x": velocity.tolist()}
    return Outcome(figure, table, results)


FIGURES = tuple(
    PaperFigure(
        slit.number,
        f"Poiseuille flow between walls, {slit.length} x {slit.width}, "
        f"{slit.density:g} particles a cell, gravity 0.001.",
        partial(_make, slit),
        slit.scenes,
    )
    for slit in SLITS
)

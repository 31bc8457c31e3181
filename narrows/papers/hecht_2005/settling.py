"""Figs. 3 and 4: diffusion when dilute, and the settling speed against the volume fraction."""

import math

import numpy as np

from analysis import analyze
from analysis.estimate import Estimate
from analysis.sedimentation import richardson_zaki
from lammps_inputs import Scene
from lammps_inputs.scenes.claylike import Claylike
from narrows.papers.drawing import one_panel, paper_line, points
from narrows.papers.figure import Directories, Outcome, PaperFigure, Quality
from narrows.papers.results import PaperNumber, Result, compared, measured

FRACTIONS = (0.02, 0.07, 0.14, 0.21)
EXPONENT = PaperNumber(3.5, 0.1)
FRAMES = ("zero_momentum", "relative_to_fluid", "zero_volume_flux")


def dilute(quality: Quality) -> Claylike:
    """2 % of soft spheres without gravity."""
    duration = 4000.0 if quality == "full" else 400.0
    return Claylike.make(
        volume_fraction=0.02,
        potential="hertz",
        md_steps_per_collision=60,
        duration=duration,
        equilibration=50.0,
    )


def settling(quality: Quality) -> list[Scene]:
    """Soft spheres at Pe = 1 (Fig. 4)."""
    duration = 4000.0 if quality == "full" else 200.0
    return [
        Claylike.make(
            volume_fraction=phi,
            potential="hertz",
            peclet=1.0,
            md_steps_per_collision=60,
            duration=duration,
            equilibration=50.0,
        )
        for phi in FRACTIONS
    ]


def _entry(entry: dict[str, float | None]) -> Estimate:
    return Estimate(entry["value"], entry["error"])


def _diffusion(directories: Directories, quality: Quality) -> Outcome:
    scene = dilute(quality)
    summary = analyze(directories[scene].path)
    model = scene.model
    stokes = 1 / (6 * math.pi * model.reduced_viscosity * model.reduced_radius)
    figure, axes = one_panel("", "diffusion coefficient $D$ [$a_0^2/t_0$]")
    results: list[Result] = []
    names = ("msd", "green_kubo", "infinite_box")
    found = [_entry(summary["diffusion"][name]) for name in names]
    points(axes, range(len(names)), found)
    axes.set_xticks(range(len(names)), names)
    paper_line(axes, [0, len(names) - 1], [stokes, stokes], "Stokes and Einstein (18)")
    axes.legend()
    note = "coupling II diffuses faster than Stokes: only its own cell holds a colloid back"
    for name, estimate in zip(names, found, strict=True):
        results.append(measured("3", f"D by {name} [a0^2/t0]", estimate))
    ratio = found[-1].scaled(1 / stokes)
    results.append(compared("3", "D over (18), infinite box", ratio, PaperNumber(1.0, 0.2), note))
    for key in ("temperature", "colloid_temperature"):
        results.append(compared("2", key, _entry(summary[key]), PaperNumber(1.0, 0.005)))
    table = {"way": names, "D": [e.value for e in found], "error": [e.error for e in found]}
    return Outcome(figure, table, results)


def _settling(directories: Directories, quality: Quality) -> Outcome:
    summaries = [analyze(directories[scene].path) for scene in settling(quality)]
    porosity = 1 - np.array(FRACTIONS)
    figure, axes = one_panel(r"porosity $1 - \phi$", "settling speed [$a_0/t_0$]")
    results: list[Result] = []
    table: dict[str, list[float | None]] = {"volume_fraction": list(FRACTIONS)}
    for number, frame in enumerate(FRAMES):
        speeds = [_entry(summary["settling_speed"][frame]) for summary in summaries]
        points(axes, porosity.tolist(), speeds, number, label=frame.replace("_", " "))
        table[frame] = [speed.value for speed in speeds]
        table[f"{frame} error"] = [speed.error for speed in speeds]
        try:
            single, exponent = richardson_zaki(FRACTIONS, speeds)
        except ValueError as error:
            single = exponent = Estimate(None, None, str(error))
        quantity = f"exponent of (37), {frame.replace('_', ' ')}, phi {FRACTIONS[0]} to 0.21"
        if frame == "zero_momentum":
            results.append(compared("4", quantity, exponent, EXPONENT))
            if single.value is not None:
                axes.plot(porosity, single.value * porosity**exponent.number, color="C0")
                line = single.value * porosity**EXPONENT.value
                paper_line(axes, porosity, line, "exponent 3.5")
        else:
            results.append(measured("4", quantity, exponent))
    axes.set(xscale="log", yscale="log")
    axes.legend()
    return Outcome(figure, table, results)


def _dilute_scenes(quality: Quality) -> list[Scene]:
    return [dilute(quality)]


FIGURES = (
    PaperFigure("3", "Diffusion of 2 % of soft spheres, coupling II.", _diffusion, _dilute_scenes),
    PaperFigure("4", "Settling speed at Pe = 1 in three frames.", _settling, settling),
)

"""Tables I to IV: the time scales of the suspension and of both simulations of it."""

import numpy as np

from analysis.estimate import Estimate
from lammps_inputs.material import Model, Suspension, TimeScales
from narrows.papers.drawing import COLOURS, PAPER, one_panel
from narrows.papers.figure import Directories, Outcome, PaperFigure, Quality
from narrows.papers.results import PaperNumber, Result, compared

TIMES = ("settling", "diffusion", "gap", "interaction", "fluid", "particle")
SYMBOLS = ("tau_S", "tau_D", "tau_G", "tau_V", "tau_F", "tau_P")
PRINTED = {  # [s]
    "Table II": ("0.791", "0.582", "36.5e-3", "7.45e-6", "0.320e-6", "0.139e-6"),
    "Table III": ("0.791", "0.582", "36.5e-3", "2.03e-3", "22.9e-3", "10.36e-3"),
    "Table IV": ("0.791", "0.582", "36.5e-3", "1.56e-3", "14.0e-3", "6.02e-3"),
}
CELL = 6.25e-7  # of coupling II [m]: the paper's, where equal volumes give 6.45e-7
MISPRINT = "2 R^2 / nu is 23.9 ms"


def _result(figure: str, quantity: str, value: float, printed: str, note: str | None) -> Result:
    paper = PaperNumber.printed(printed)
    # the paper goes on with rounded time steps, which shows in a third digit
    reading = max(paper.reading, 0.007 * paper.value if figure == "Table IV" else 0.0)
    number = PaperNumber(paper.value, reading)
    return compared(figure, quantity, Estimate(value, 0.0), number, note)


def _make(directories: Directories, quality: Quality) -> Outcome:
    real = Suspension()
    models = {
        "Table III": Model.reflecting(real),
        "Table IV": Model.in_collision(real, cell=CELL),
    }
    scales: dict[str, TimeScales] = {"Table II": real.time_scales()}
    scales |= {name: model.time_scales() for name, model in models.items()}
    results = []
    figure, axes = one_panel("", "time [s]")
    for number, (name, times) in enumerate(scales.items()):
        values = [getattr(times, each) for each in TIMES]
        places = np.arange(len(TIMES)) + 0.15 * (number - 1)
        axes.semilogy(places, values, "o", color=COLOURS[number], label=name)
        printed = [float(text) for text in PRINTED[name]]
        axes.semilogy(places, printed, "_", color=PAPER, markersize=12)
        for symbol, value, text in zip(SYMBOLS, values, PRINTED[name], strict=True):
            note = MISPRINT if text == "22.9e-3" else None
            results.append(_result(name, f"{symbol} [s]", value, text, note))
    axes.set_xticks(range(len(TIMES)), SYMBOLS)
    axes.legend()
    first, second = models.values()
    for quantity, value, text in (
        ("Pe", real.time_scales().peclet, "0.74"),
        ("coupling I: delta t [s]", first.collision_time, "0.91e-3"),
        ("coupling I: nu [m^2/s]", first.viscosity, "1.34e-11"),
        ("coupling I: Re", first.time_scales().reynolds, "3.0e-2"),
        ("coupling II: delta t [s]", second.collision_time, "2.05e-3"),
    ):
        results.append(_result("section VII", quantity, value, text, None))
    table = {"time": SYMBOLS} | {
        name: [getattr(times, each) for each in TIMES] for name, times in scales.items()
    }
    return Outcome(figure, table, results)


FIGURES = (
    PaperFigure(
        "tables",
        "Tables II to IV: the time scales of alumina in water, and of both simulations.",
        _make,
        origin="No run: equations (16) to (33).",
    ),
)

"""Beyond the paper: the ladder of fields down again, kinetic thermostat, n = 1.03."""

from matplotlib.figure import Figure

from lammps_inputs import Scene
from narrows.papers.delhommelle_2005.state_points import CRYSTAL, DOWN, PHI, disks, numbers
from narrows.papers.drawing import points
from narrows.papers.figure import Column, Directories, Outcome, PaperFigure, Quality
from narrows.papers.results import Result, measured

NUMBER = "beyond-hysteresis"
KEYS = {
    "bond_order": r"bond order $\psi_6$",
    PHI: r"lane order $\phi$ among neighbours",
    "configurational_temperature": "configurational temperature",
}


def _fields(quality: Quality) -> tuple[float, ...]:
    """From below; the last is where the way down begins."""
    if quality == "quick":
        return (0.5, 1.0, 1.5)
    return (0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0, 3.0, 4.0, 6.0)


def _up(quality: Quality) -> list[Scene]:
    return [disks(CRYSTAL, field, "kinetic", quality) for field in _fields(quality)]


def _down(quality: Quality) -> list[Scene]:
    fields = _fields(quality)[-2::-1]
    return [disks(CRYSTAL, field, "kinetic", quality, DOWN) for field in fields]


def ladders(quality: Quality) -> list[list[Scene]]:
    """The way down begins where the way up ends."""
    return [[_up(quality)[-1], *_down(quality)]]


def _figure(directories: Directories, quality: Quality) -> Outcome:
    fields = _fields(quality)
    ways = {
        "up": (list(fields), _up(quality)),
        "down": (list(fields[-2::-1]), _down(quality)),
    }
    figure = Figure(figsize=(4.0 * len(KEYS), 3.4), layout="constrained")
    table: dict[str, list[float | int | str | None]] = {"way": [], "field": []}
    for way, (at, _) in ways.items():
        table["way"] += [way] * len(at)
        table["field"] += at
    results: list[Result] = []
    for axes, (key, label) in zip(figure.subplots(1, len(KEYS)), KEYS.items(), strict=True):
        found = {}
        for place, (way, (at, scenes)) in enumerate(ways.items()):
            values = numbers(directories, scenes, key)
            found[way] = dict(zip(at, values, strict=True))
            points(axes, at, values, place, label=way, linestyle="-", linewidth=0.6)
            table.setdefault(key, []).extend(each.value for each in values)
            table.setdefault(f"{key}_error", []).extend(each.error for each in values)
        axes.set(xlabel="field $F$", ylabel=label, ylim=(0, None))
        axes.legend()
        if key == "bond_order":
            results = [
                measured(
                    NUMBER,
                    f"psi_6 at F = {field:g} on the way up less that on the way down",
                    found["up"][field] - found["down"][field],
                )
                for field in (0.5, 1.0)
            ]
    columns: dict[str, Column] = dict(table)
    return Outcome(figure, columns, results)


FIGURES = (
    PaperFigure(
        NUMBER,
        "Order and configurational temperature, fields up and down again.",
        _figure,
        lambda quality: [*_up(quality), *_down(quality)],
        partial=True,
    ),
)

"""Every number of a sweep against a swept field: small panels side by side, with error bars."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

from matplotlib.figure import Figure

from analysis.sweep_table import SweepTable

ACROSS = 3  # panels in a row
PANEL = (4.2, 3.2)  # inches


def draw(table: SweepTable) -> Figure | None:
    """A panel for each number with errors, against the first swept field that is a number.

    Other swept fields are told apart by colour. None where no field with several numbers was swept.
    """
    field = next((name for name in table.fields if _is_axis(table.rows, name)), None)
    quantities = [name for name in table.quantities if _points(table.rows, name)]
    if field is None or not quantities:
        return None
    down = math.ceil(len(quantities) / ACROSS)
    figure = Figure(figsize=(ACROSS * PANEL[0], down * PANEL[1]), layout="constrained")
    panels = figure.subplots(down, ACROSS, squeeze=False).flat
    others = [name for name in table.fields if name != field]
    groups = list(dict.fromkeys(tuple(row[name] for name in others) for row in table.rows))
    for quantity, axes in zip(quantities, panels, strict=False):  # takes no panel too many
        for group in groups:
            rows = [
                row
                for row in _points(table.rows, quantity)
                if tuple(row[name] for name in others) == group
            ]
            label = ", ".join(f"{n} {v}" for n, v in zip(others, group, strict=True))
            axes.errorbar(
                [row[field] for row in rows],
                [row[quantity] for row in rows],
                [row[f"{quantity}_error"] or 0.0 for row in rows],
                fmt="o-",
                markersize=4,
                linewidth=0.8,
                capsize=2,
                label=label,
            )
        axes.set_title(quantity.replace("_", " "), fontsize="medium")
        axes.set_xlabel(field)
    for axes in list(panels):
        axes.set_axis_off()
    if others:
        figure.axes[0].legend(fontsize="small")
    return figure


def _is_axis(rows: Sequence[Mapping[str, Any]], field: str) -> bool:
    values = {row.get(field) for row in rows}
    return len(values) > 1 and all(isinstance(value, int | float) for value in values)


def _points(rows: Sequence[Mapping[str, Any]], quantity: str) -> list[Mapping[str, Any]]:
    return [row for row in rows if row.get(quantity) is not None]

"""What a measure found: entries of summary.json, figures, tables, warnings."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from matplotlib.figure import Figure


@dataclass(frozen=True)
class Findings:
    """What a measure says of a run.

    Attributes:
        entries: of summary.json, by key; docs/analysis.md says what each means.
        figures: by file name.
        tables: columns of equal length by name, by file name.
        warnings: what no correct run shows, one line each.
    """

    entries: Mapping[str, Any] = field(default_factory=dict)
    figures: Mapping[str, Figure] = field(default_factory=dict)
    tables: Mapping[str, Mapping[str, Sequence[Any]]] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()

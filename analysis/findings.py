"""What a measure found: entries of summary.json, figures, tables, warnings."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from matplotlib.figure import Figure

from analysis.estimate import Estimate
from analysis.run_directory import RunDirectory


@dataclass(frozen=True)
class Findings:
    """What a measure says of a run.

    Attributes:
        entries: of summary.json, by key; docs/analysis.md says what each means.
        figures: by file name.
        tables: columns of equal length by name, by file name.
        warnings: what no correct run shows, one line each.
        left_out: what the run is too short or too small to show, one line each.
    """

    entries: Mapping[str, Any] = field(default_factory=dict)
    figures: Mapping[str, Figure] = field(default_factory=dict)
    tables: Mapping[str, Mapping[str, Sequence[Any]]] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()
    left_out: tuple[str, ...] = ()


def in_si(run: RunDirectory, estimate: Estimate, length: int = 0, time: int = 0) -> dict[str, Any]:
    """An entry with an estimate in reduced units and, where the run tells its units, in SI.

    Args:
        run: whose units.
        estimate: in a0^length t0^time.
        length, time: powers.
    """
    entry = estimate.as_json()
    units = run.manifest.si_units
    if units and estimate.value is not None:
        si = estimate.scaled(units["a0"] ** length * units["t0"] ** time)
        powers = {"m": length, "s": time}
        unit = [n if p == 1 else f"{n}^{p}" for n, p in powers.items() if p]
        entry |= {"value_si": si.value, "error_si": si.error, "unit_si": " ".join(unit)}
    return entry

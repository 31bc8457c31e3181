"""`summary.json` and the figures of a run; `docs/analysis.md` says what every key means."""

import csv
import io
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from analysis.findings import Findings
from analysis.measures import measures
from analysis.run_directory import RunDirectory
from run_files.manifest import NAME as MANIFEST
from run_files.progress import NAME as PROGRESS
from run_files.reading import read_json, refuse
from run_files.writing import replace_text

SUMMARY = "summary.json"


def analyze(directory: str | Path) -> dict[str, Any]:
    """Analyses a run and writes summary.json, figures and tables into its directory.

    Args:
        directory: of the run, finished or in progress.

    Returns:
        the content of summary.json.

    Raises:
        RunDirectoryError: when it is no run directory, or nothing lies after the equilibration.
        OSError: when the results cannot be written.
    """
    run = RunDirectory(directory)
    known = measures()
    for name in run.manifest.system.measures:
        if name not in known:
            refuse(run.path / MANIFEST, f"measure {name}: must be one of {', '.join(known)}")
    found = [_whole_run(run), *(known[name](run) for name in run.manifest.system.measures)]
    summary: dict[str, Any] = {}
    for findings in found:
        summary |= findings.entries
    figures = {name: figure for findings in found for name, figure in findings.figures.items()}
    summary["warnings"] = [warning for findings in found for warning in findings.warnings]
    summary["figures"] = sorted(figures)
    if left_out := [line for findings in found for line in findings.left_out]:
        summary["left_out"] = left_out
    for name, figure in figures.items():
        figure.savefig(run.path / name, dpi=150)
    tables = {name: table for findings in found for name, table in findings.tables.items()}
    if tables:
        summary["tables"] = sorted(tables)
    for name, columns in tables.items():
        replace_text(run.path / name, _as_csv(columns))
    replace_text(run.path / SUMMARY, json.dumps(summary, indent=2, allow_nan=False) + "\n")
    return summary


def _as_csv(columns: Mapping[str, Sequence[Any]]) -> str:
    """Columns of equal length as CSV, their names first."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows(zip(*columns.values(), strict=True))
    return text.getvalue()


def is_analysed(directory: Path) -> bool:
    """Whether a driven run was analysed since its newest checkpoint."""
    summary, progress = directory / SUMMARY, directory / PROGRESS
    return summary.is_file() and summary.stat().st_mtime >= progress.stat().st_mtime


def summary_of(directory: Path) -> dict[str, Any]:
    """The summary of a run, analysed unless that was done since its newest checkpoint."""
    return read_json(directory / SUMMARY) if is_analysed(directory) else analyze(directory)


def estimates(summary: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """Every entry with a value and an error; nested ones by their path, `diffusion.exponent`."""
    known: dict[str, dict[str, Any]] = {}
    for key, entry in summary.items():
        if isinstance(entry, dict):
            if "value" in entry:
                known[key] = entry
            known |= {f"{key}.{name}": inner for name, inner in estimates(entry).items()}
    return known


def _whole_run(run: RunDirectory) -> Findings:
    """What every run has."""
    table = run.table()
    used = int(run.sampled(table.steps).sum())
    system = run.manifest.system
    return Findings(
        {
            "scene": run.manifest.scene,
            "engine": run.manifest.engine,
            "finished": run.finished(),
            "simulated_time": run.simulated_time(),
            "sampled_time": used * run.interval,
            "frames": used,
            "wall_seconds": run.wall_seconds(),
            "fluid_particles": system.solvent.particles if system.solvent else 0,
            "colloids": sum(species.count for species in system.species),
        }
    )

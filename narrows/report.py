"""`report.html`: a run or a sweep on one page, in one file: numbers, pictures, provenance."""

import re
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any

from analysis.analyze import estimates, summary_of
from analysis.estimate import Estimate
from analysis.figure_captions import caption
from analysis.sweep_figures import draw
from analysis.sweep_table import SweepTable, tabulate
from lammps_inputs import all_scenes
from lammps_inputs.field_table import FieldRow, field_rows, shown_default
from narrows import html
from narrows.citations import citations
from run_files.manifest import Manifest, read_manifest
from run_files.sweep_file import read_sweep
from run_files.writing import replace_text

NAME = "report.html"
SWEEP_FIGURE = "sweep.png"
ABREAST = 6  # numbers of a sweep beside its fields, on a screen


def report_run(directory: Path) -> Path:
    """Analyse a run, unless that was done since its newest checkpoint, and write its page.

    Raises:
        RunDirectoryError: when it is no run directory, or cannot be analysed.
        OSError: when the page cannot be written.
    """
    summary = summary_of(directory)
    manifest = read_manifest(directory)
    state = "finished" if summary["finished"] else "not finished"
    sections = [
        _section("Numbers", _numbers(summary)),
        _section("Pictures", _pictures(directory, summary["figures"], summary.get("left_out", ()))),
        _section("The scene", _fields(manifest)),
        _section("How it was made", _provenance(manifest, summary)),
        _section("To cite", _cite(citations(manifest))),
    ]
    title = f"{directory.resolve().name}: {manifest.scene}"
    about = (
        f"Scene {manifest.scene}, engine {manifest.engine}, {state}: "
        f"{summary['simulated_time']:g} t0 simulated. {ERRORS}"
    )
    return _write(directory, title, about, sections)


def report_sweep(directory: Path, jobs: int) -> Path:
    """Analyse what is finished of a sweep, and write its page.

    Raises:
        RunDirectoryError: when it is no sweep, or nothing of it is finished.
        OSError: when the page cannot be written.
    """
    table = tabulate(directory, jobs, renew=False)
    sweep = read_sweep(directory)
    name = next(iter(sweep.runs))
    manifest = read_manifest(directory / name)
    sections = [_section("Numbers", "".join(_failed(table.problems)) + _table(table))]
    figure = draw(table)
    if figure:
        figure.savefig(directory / SWEEP_FIGURE, dpi=120)
        says = f"Each number of the analysis against {', '.join(table.fields)}, with error bars."
        shown = html.picture(directory / SWEEP_FIGURE, says)
        sections.append(_section("Pictures", f'<div class="pair wide">{shown}</div>'))
    runs = ", ".join(f"<code>{escape(each)}</code>" for each in sweep.runs)
    sections += [
        _section("The scene of the first run", _fields(manifest)),
        _section("How the first run was made", _provenance(manifest, {}) + f"<p>Runs: {runs}.</p>"),
        _section("To cite", _cite(citations(manifest))),
    ]
    title = f"{directory.resolve().name}: a sweep of {sweep.scene}"
    about = (
        f"Scene {sweep.scene}, engine {sweep.engine}: {len(table.rows)} points from "
        f"{table.finished} of {table.runs} runs. {ERRORS} The same as table.csv."
    )
    return _write(directory, title, about, sections)


ERRORS = "Errors are one standard error; a0 = kBT = m_f = 1 where no other unit is named."


def _write(directory: Path, title: str, about: str, sections: Iterable[str]) -> Path:
    body = f'<h1>{escape(title)}</h1>\n<p class="caption">{escape(about)}</p>\n'
    path = directory / NAME
    replace_text(path, html.page(title, body + "\n".join(sections)))
    return path


def _section(heading: str, body: str) -> str:
    return f"<section><h2>{escape(heading)}</h2>\n{body}</section>"


def _failed(lines: Iterable[str]) -> Iterable[str]:
    return (f'<p class="failed">{escape(line)}</p>' for line in lines)


def _numbers(summary: Mapping[str, Any]) -> str:
    rows = []
    for path, entry in estimates(summary).items():
        estimate = Estimate.of_json(entry)
        theory = entry.get("theory")
        note = estimate.reason or ("" if theory is None else f"theory {theory:.5g}")
        name = re.sub(r"(?<!\d)\.|\.(?!\d)", " ", path).replace("_", " ")
        rows.append((escape(name), html.number(estimate.value, estimate.error), escape(note)))
    warnings = "".join(_failed(summary["warnings"]))
    return warnings + html.table(("quantity", "value", "note"), rows)


def _pictures(directory: Path, figures: Sequence[str], left_out: Sequence[str]) -> str:
    pictures = (
        html.picture(directory / name, caption(name), f"{caption(name)} ({name})")
        for name in figures
    )
    notes = "".join(f'<p class="note">Not drawn: {escape(line)}.</p>' for line in left_out)
    return f'<div class="pair">{"".join(pictures)}</div>{notes}'


def _table(table: SweepTable) -> str:
    """As many tables as a page is too narrow for, each with the fields of the points."""
    return "".join(
        _part(table, table.quantities[first : first + ABREAST])
        for first in range(0, len(table.quantities), ABREAST)
    )


def _part(table: SweepTable, quantities: Sequence[str]) -> str:
    rows = [
        (
            *(escape(str(row[name])) for name in (*table.fields, "repeats")),
            *(html.number(row[name], row[f"{name}_error"]) for name in quantities),
        )
        for row in table.rows
    ]
    names = (name.replace("_", " ") for name in quantities)
    return html.wide_table((*table.fields, "repeats", *names), rows)


def _fields(manifest: Manifest) -> str:
    """The fields as they were; what they mean is told of scenes that this version knows."""
    scene = all_scenes().get(manifest.scene)
    known = {row.name: row for row in field_rows(scene)} if scene else {}
    rows = []
    for name, value in manifest.fields.items():
        row = known.get(name, FieldRow(name, "", "", "", ""))
        given = shown_default(tuple(value) if isinstance(value, list) else value)
        cell = f"<b>{escape(given)}</b>" if given != row.default else escape(given)
        rows.append((f"<code>{escape(name)}</code>", cell, escape(row.unit), escape(row.meaning)))
    note = '<p class="note">Bold: not the default.</p>'
    return html.table(("field", "value", "unit", "meaning"), rows) + note


def _provenance(manifest: Manifest, summary: Mapping[str, Any]) -> str:
    clock = manifest.system.clock
    rows = {
        "engine": manifest.engine,
        "command": manifest.command or "not known",
        "processes": str(manifest.ranks),
        "seeds": ", ".join(f"{name} {seed}" for name, seed in manifest.seeds.items()),
        "versions": ", ".join(f"{name} {each}" for name, each in manifest.versions.items()),
        "steps": f"{clock.total_steps} of {clock.time_step:g} t0, the first "
        f"{clock.equilibration_steps} left out of averages",
    }
    if manifest.si_units:
        rows["units"] = ", ".join(f"{n} = {v:.4g}" for n, v in manifest.si_units.items()) + " in SI"
    if summary.get("wall_seconds"):
        rows["wall time"] = f"{summary['wall_seconds']:.0f} s"
    return html.table((), [(escape(name), escape(text)) for name, text in rows.items()])


def _cite(lines: Iterable[str]) -> str:
    return f"<ul>{''.join(f'<li>{escape(line)}</li>' for line in lines)}</ul>"

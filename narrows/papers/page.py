"""`index.html`: every figure beside the paper's numbers and the verdicts, in one file."""

import base64
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path

from lammps_inputs import Scene
from narrows.papers.figure import Outcome, Paper, PaperFigure, Quality
from narrows.papers.results import Result
from run_files.writing import replace_text


@dataclass(frozen=True)
class Made:
    """A figure with its outcome, the scenes behind it and its PNG file."""

    figure: PaperFigure
    outcome: Outcome
    scenes: Sequence[Scene]
    picture: Path


@dataclass(frozen=True)
class Report:
    """All that the page shows.

    Attributes:
        left_out: one line for each figure that could not be made.
        runs: distinct runs behind the figures.
        engines: of the runs.
        run_seconds: core time of all runs, earlier commands included [s].
        this_run_seconds, figure_seconds: wall time of this command's runs and figures [s].
        seeds: of the runs.
        versions: of the programs, by name.
    """

    paper: Paper
    quality: Quality
    made: Sequence[Made]
    left_out: Sequence[str]
    runs: int
    engines: Sequence[str]
    run_seconds: float
    this_run_seconds: float
    figure_seconds: float
    jobs: int
    seeds: Sequence[int]
    versions: Mapping[str, str]


STYLE = """
:root { color-scheme: light; }
body { font: 15px/1.45 system-ui, sans-serif; color: #1b1f24; background: #f5f6f8; margin: 0; }
main { max-width: 1280px; margin: 0 auto; padding: 24px; }
h1 { font-size: 24px; margin: 0 0 4px; }
h2 { font-size: 18px; margin: 0; }
.caption { margin: 2px 0 12px; color: #4a5360; }
section { background: white; border: 1px solid #dfe3e8; border-radius: 8px; padding: 18px 20px;
  margin: 18px 0; }
.pair { display: grid; grid-template-columns: minmax(320px, 10fr) minmax(380px, 11fr); gap: 22px;
  align-items: start; }
.wide { grid-template-columns: 1fr; }
@media (max-width: 900px) { .pair { grid-template-columns: 1fr; } }
img { width: 100%; height: auto; }
table { border-collapse: collapse; width: 100%; font-size: 13.5px; }
th { text-align: left; font-weight: 600; border-bottom: 2px solid #c9d0d8; padding: 4px 8px; }
td { border-bottom: 1px solid #e6e9ed; padding: 5px 8px; vertical-align: top; }
td.number { white-space: nowrap; font-variant-numeric: tabular-nums; }
.note { color: #5b6570; font-size: 12.5px; }
td .none { white-space: nowrap; }
.claim { color: #a50d26; }
.verdict { font-weight: 600; white-space: nowrap; }
.agrees { color: #17713a; } .disagrees { color: #b3261e; } .open { color: #8a6100; }
nav a { margin-right: 10px; color: #1f5fa8; }
.failed { color: #b3261e; }
"""


def write_page(path: Path, report: Report) -> None:
    """Write the page."""
    replace_text(path, _page(report))


def verdict(result: Result) -> str:
    """`agrees`, `disagrees`, `open` where the errors do not decide, empty without comparison."""
    if result.agrees is None:
        return "open" if result.claim or result.paper else ""
    return "agrees" if result.agrees else "disagrees"


def count_verdicts(results: Sequence[Result]) -> dict[str, int]:
    """How many results have each verdict."""
    found = [verdict(result) for result in results]
    return {name: found.count(name) for name in ("agrees", "disagrees", "open")}


def _page(report: Report) -> str:
    results = [result for made in report.made for result in made.outcome.results]
    counts = count_verdicts(results)
    links = "".join(
        f'<a href="#figure-{made.figure.number}">{made.figure.number}</a>' for made in report.made
    )
    failed = "".join(f'<p class="failed">{escape(line)}</p>' for line in report.left_out)
    sections = "".join(_section(made) for made in report.made)
    return f"""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{escape(report.paper.name)}, {report.quality}</title><style>{STYLE}</style></head>
<body><main>
<h1>{escape(report.paper.title)}</h1>
<p class="caption">Computed again with narrows, {report.quality} quality.
The paper's numbers are red in every figure.</p>
<p><span class="verdict agrees">{counts["agrees"]} agree</span>,
<span class="verdict disagrees">{counts["disagrees"]} disagree</span>,
<span class="verdict open">{counts["open"]} open</span>.
A number agrees with a printed one if they differ by at most two joint standard errors plus one unit
of the last printed digit. A claim without a number is put as a sign or as zero: it holds, or fails,
at two standard errors, and is open where these do not decide. Errors are one standard error.</p>
{failed}
<nav>Figures {links}</nav>
{sections}
<section><h2>How it was made</h2>{_making(report)}</section>
</main></body></html>
"""


def _section(made: Made) -> str:
    number = made.figure.number
    width, height = made.outcome.picture.get_size_inches()
    shape = "pair wide" if width > 2 * height else "pair"
    rows = "".join(_row(result) for result in made.outcome.results)
    return f"""<section id="figure-{number}"><h2>Fig. {number}</h2>
<p class="caption">{escape(made.figure.caption)}</p>
<div class="{shape}"><img alt="Fig. {number}" src="{_image(made.picture)}">
<div><table><tr><th>quantity</th><th>here</th><th>paper</th><th></th></tr>{rows}</table>
<p class="note">{escape(_origin(made))} Data: figure-{number}.csv, vector graphics:
figure-{number}.pdf, beside this page.</p></div></div></section>
"""


def _row(result: Result) -> str:
    entry = result.as_json()
    note = f'<div class="note">{escape(entry["note"])}</div>' if entry["note"] else ""
    words = verdict(result)
    if result.paper:
        paper = f"{result.paper.value:.4g}"
    elif result.claim:
        paper = f'<span class="claim">{escape(result.claim)}</span>'
    else:
        paper = '<span class="note none">no number</span>'
    return (
        f"<tr><td>{escape(result.quantity)}{note}</td>"
        f'<td class="number">{_number(entry["value"], entry["error"])}</td><td>{paper}</td>'
        f'<td class="verdict {words}">{words}</td></tr>'
    )


def _number(value: float | None, error: float | None) -> str:
    """The value to the second digit of its error."""
    if value is None:
        return "-"
    if not error:
        return f"{value:.5g}"
    digits = max(0, 1 - int(f"{error:e}".split("e")[1]))
    return f"{value:.{digits}f} &plusmn; {error:.{digits}f}"


def _image(picture: Path) -> str:
    return "data:image/png;base64," + base64.b64encode(picture.read_bytes()).decode()


def _origin(made: Made) -> str:
    scenes = made.scenes
    if not scenes:
        return made.figure.origin
    time = sum(scene.duration for scene in scenes)
    seeds = sorted({scene.seed for scene in scenes})
    span = f"seed {seeds[0]}" if len(seeds) == 1 else f"seeds {seeds[0]} to {seeds[-1]}"
    count = "one run" if len(scenes) == 1 else f"{len(set(scenes))} runs"
    return f"{count}, {time:.0f} t0 in all, {span}."


def _making(report: Report) -> str:
    versions = ", ".join(f"{name} {version}" for name, version in report.versions.items())
    span = f"{report.seeds[0]} to {report.seeds[-1]}" if report.seeds else "none"
    rows = {
        "runs": f"{report.runs} by the engine {' or '.join(report.engines)}, "
        f"{report.run_seconds / 60:.1f} core minutes",
        "this command": f"{report.this_run_seconds / 60:.1f} minutes of runs, {report.jobs} at a "
        f"time, and {report.figure_seconds:.0f} seconds for the figures",
        "seeds": span,
        "versions": versions,
        "units": report.paper.units,
    }
    body = "".join(
        f"<tr><td>{name}</td><td>{escape(text)}</td></tr>" for name, text in rows.items()
    )
    return f"<table>{body}</table>"

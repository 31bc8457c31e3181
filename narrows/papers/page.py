"""`index.html`: every figure beside the paper's numbers and the verdicts, in one file."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape, unescape
from pathlib import Path

from lammps_inputs import Scene
from narrows import html
from narrows.citations import PAPERS
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
        left_out: one line for each figure that could not be made, or run that one is without.
        system: a picture of one of the systems, and what it shows.
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
    system: tuple[Path, str] | None
    runs: int
    engines: Sequence[str]
    run_seconds: float
    this_run_seconds: float
    figure_seconds: float
    jobs: int
    seeds: Sequence[int]
    versions: Mapping[str, str]


VERDICTS = ("agrees", "disagrees", "open")


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
    return {name: found.count(name) for name in VERDICTS}


def _page(report: Report) -> str:
    failed = "".join(f'<p class="failed">{escape(line)}</p>' for line in report.left_out)
    sections = "".join(_section(made) for made in report.made)
    cite = PAPERS.get(report.paper.name, report.paper.title)
    quick = "Larger errors leave more open: full quality may decide otherwise."
    body = f"""<h1>{escape(report.paper.title)}</h1>
<p class="caption">Computed again with narrows, {report.quality} quality.
{quick if report.quality == "quick" else ""}
The paper's numbers are red in every figure.</p>
<section id="verdicts"><h2>Verdicts</h2>{_verdicts(report)}
<p class="note">A number agrees with a printed one if they differ by at most two joint standard
errors plus one unit of the last printed digit. A claim without a number is put as a sign or as
zero: it holds, or fails, at two standard errors, and is open where these do not decide. Errors are
one standard error.</p>
{failed}</section>
{_system(report)}{sections}
<section><h2>How it was made</h2>{_making(report)}
<p>The paper: {escape(cite)}.</p></section>"""
    return html.page(f"{report.paper.name}, {report.quality}", body)


def _system(report: Report) -> str:
    if report.system is None:
        return ""
    picture, says = report.system
    return f"""<section id="system"><h2>A system of these figures</h2>
{html.picture(picture, says, says)}</section>
"""


def _verdicts(report: Report) -> str:
    """A row for each figure, with a link to it, and one for all of them."""
    everything = [result for made in report.made for result in made.outcome.results]
    rows = [
        (
            f'<a href="#figure-{made.figure.number}">{made.figure.number}</a> '
            + escape(made.figure.caption),
            *_counted(made.outcome.results),
        )
        for made in report.made
    ]
    together = (f"<b>{len(everything)} numbers</b>", *_counted(everything))
    headings = ("figure", *VERDICTS, "nothing to compare")
    return html.table(headings, [together, *rows])


def _counted(results: Sequence[Result]) -> list[str]:
    counts = count_verdicts(results)
    cells = [f'<td class="verdict {name}">{counts[name] or ""}</td>' for name in VERDICTS]
    return [*cells, f"<td>{len(results) - sum(counts.values()) or ''}</td>"]


def _section(made: Made) -> str:
    number = made.figure.number
    width, height = made.outcome.picture.get_size_inches()
    shape = "pair wide" if width > 2 * height else "pair"
    rows = [_row(result) for result in made.outcome.results]
    stem = f"figure-{number}"
    return f"""<section id="{stem}"><h2>Fig. {number}</h2>
<p class="caption">{escape(made.figure.caption)}</p>
<div class="{shape}">{html.picture(made.picture, _says(made))}
<div>{html.table(("quantity", "here", "paper", ""), rows)}
<p class="note">{escape(_origin(made))} Data: <a href="{stem}.csv">{stem}.csv</a>, vector graphics:
<a href="{stem}.pdf">{stem}.pdf</a>, beside this page.</p></div></div></section>
"""


def _says(made: Made) -> str:
    """What is to be seen, for those who do not see it: the caption, and each number."""
    numbers = [
        f"{result.quantity} {_plain(result)}"
        + (f", in the paper {result.paper.value:.4g}" if result.paper else "")
        for result in made.outcome.results
    ]
    return f"Fig. {made.figure.number}: {made.figure.caption} " + "; ".join(numbers)


def _plain(result: Result) -> str:
    measured = result.measured
    return unescape(html.measured(measured.value, measured.error))


def _row(result: Result) -> tuple[str, ...]:
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
        f"{escape(result.quantity)}{note}",
        html.number(entry["value"], entry["error"]),
        paper,
        f'<td class="verdict {words}">{words}</td>',
    )


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
    return html.table((), [(name, escape(text)) for name, text in rows.items()])

"""`narrows analyze`: the numbers of a run, or of all runs of a sweep, with their errors."""

import re
from pathlib import Path
from typing import Annotated

import typer

from narrows.messages import complain, printable, say, user_errors, warn
from run_files.sweep_file import is_sweep
from srd_driver.sweep import available_cores


def analyze(
    directory: Annotated[Path, typer.Argument(metavar="DIR", help="of a run or a sweep")],
) -> None:
    """Analyse a run: writes summary.json and figures into DIR; of a sweep, all runs and a table."""
    from rich.console import Console  # here, so that `narrows --help` stays fast
    from rich.table import Table

    from analysis import analyze as analyze_run
    from analysis.analyze import estimates

    if is_sweep(directory):
        _tabulate(directory)
        return
    with user_errors():
        summary = analyze_run(directory)
    state = "" if summary["finished"] else ", not finished"
    title = f"{summary['scene']}, engine {summary['engine']}{state}"
    headings = ("quantity", "value", "error", "note")
    table = Table(*headings, title=printable(title), title_justify="left")
    for path, entry in estimates(summary).items():
        name = re.sub(r"(?<!\d)\.|\.(?!\d)", " ", path).replace("_", " ")  # not in numbers
        theory = entry.get("theory")
        note = entry.get("reason") or ("" if theory is None else f"theory {theory:.5g}")
        numbers = _number(entry["value"], 5), _number(entry["error"], 2)
        table.add_row(printable(name), *numbers, printable(note))
    console = Console(markup=False, emoji=False)
    console.print(table)
    files = ["summary.json", *summary.get("tables", ()), *summary["figures"]]
    files_line = f"written to {directory}: {', '.join(files)}"
    console.print(printable(files_line), highlight=False, soft_wrap=True)
    for line in summary.get("left_out", ()):
        console.print(printable(f"not drawn: {line}"), highlight=False, soft_wrap=True)
    warn(summary["warnings"])


def _tabulate(directory: Path) -> None:
    from analysis import tabulate

    with user_errors():
        table = tabulate(directory, available_cores())
    for problem in table.problems:
        complain(problem)
    say(
        f"written: {directory / 'table.csv'}: {len(table.rows)} points "
        f"from {table.finished} of {table.runs} runs"
    )
    if table.problems:
        raise typer.Exit(1)


def _number(value: float | None, digits: int) -> str:
    return "-" if value is None else f"{value:.{digits}g}"

"""`narrows analyze`: the numbers of a run with their errors, and its figures."""

from pathlib import Path
from typing import Annotated, Any

import typer


def analyze(
    directory: Annotated[Path, typer.Argument(metavar="DIR", help="run directory")],
) -> None:
    """Analyse a run: writes summary.json and figures into DIR."""
    from rich.console import Console  # here, so that `narrows --help` stays fast
    from rich.table import Table

    from analysis import RunDirectoryError
    from analysis import analyze as analyze_run

    try:
        summary = analyze_run(directory)
    except (RunDirectoryError, OSError) as error:
        typer.echo(f"narrows analyze: {error}", err=True)
        raise typer.Exit(2) from None
    state = "" if summary["finished"] else ", not finished"
    title = f"{summary['scene']}, engine {summary['engine']}{state}"
    table = Table("quantity", "value", "error", "note", title=title, title_justify="left")
    for name, entry in _estimates(summary):
        theory = entry.get("theory")
        note = entry.get("reason") or ("" if theory is None else f"theory {theory:.5g}")
        table.add_row(name, _number(entry["value"], 5), _number(entry["error"], 2), note)
    console = Console()
    console.print(table)
    files = ["summary.json", *summary["figures"]]
    files_line = f"written to {directory}: {', '.join(files)}"
    console.print(files_line, highlight=False, markup=False, soft_wrap=True)


def _estimates(summary: dict[str, Any], prefix: str = "") -> list[tuple[str, dict[str, Any]]]:
    """Every entry with a value and an error, nested ones by their path."""
    found = []
    for key, entry in summary.items():
        if isinstance(entry, dict):
            name = f"{prefix}{key}".replace("_", " ")
            if "value" in entry:
                found.append((name, entry))
            found += _estimates(entry, f"{name} ")
    return found


def _number(value: float | None, digits: int) -> str:
    return "-" if value is None else f"{value:.{digits}g}"

"""Tables of pages from results.json.

    python -m narrows.papers.table RESULTS PAGE PAPER     # what is held against the paper
    python -m narrows.papers.table RESULTS PAGE FIGURE    # all numbers of a figure
    python -m narrows.papers.table RESULTS FILE.csv       # all numbers of all figures
    python -m narrows.papers.table FIGURE.csv PAGE NAME COLUMNS  # of a figure's data, by commas

The page has the marks of the paper, of the figure or of that name.
"""

import csv
import io
import sys
from pathlib import Path
from typing import Any

from narrows.markdown import number, replace_block, table
from run_files.reading import read_json_list
from run_files.writing import replace_text

COLUMNS = ("figure", "quantity", "here", "paper", "agrees")
WORDS = {True: "yes", False: "**no**", None: "open"}


def compared_table(entries: list[dict[str, Any]]) -> str:
    """The numbers that are held against one of the paper's, or against a claim."""
    rows = []
    for entry in entries:
        if entry["paper"] is None and entry["claim"] is None:
            continue
        rows.append((entry["figure"], *_row(entry)))
    return table(COLUMNS, rows)


def figure_table(entries: list[dict[str, Any]]) -> str:
    """All numbers of a figure, with what the paper has of them."""
    return table(COLUMNS[1:], map(_row, entries))


def _row(entry: dict[str, Any]) -> tuple[str, str, str, str]:
    """Quantity, our number, the paper's number or claim, and whether they agree."""
    paper = entry["claim"] or ""
    if entry["paper"] is not None:
        paper = f"{entry['paper']:.4g}"
    here = number(entry["value"], entry["error"])
    return entry["quantity"], here, paper, WORDS[entry["agrees"]] if paper else ""


def write_csv(results: Path, file: Path) -> None:
    """All numbers as a table for other programs, empty where a result has none."""
    entries = read_json_list(results)
    text = io.StringIO()
    writer = csv.DictWriter(text, list(entries[0]) if entries else [], lineterminator="\n")
    writer.writeheader()
    writer.writerows(entries)
    replace_text(file, text.getvalue())


def data_table(file: Path, columns: list[str]) -> str:
    """Columns of a figure's data, each with its error where the file has it.

    Raises:
        KeyError: for a column that the file does not have.
    """
    with file.open(encoding="utf-8", newline="") as lines:
        return table(
            columns, ([_cell(row, name) for name in columns] for row in csv.DictReader(lines))
        )


def _cell(row: dict[str, str], column: str) -> str:
    error = row.get(f"{column}_error")
    return number(float(row[column]), float(error)) if error else row[column]


def main(results: str, page: str, name: str = "", columns: str = "") -> None:
    """Renew the table of the page, or write the file of all numbers."""
    if columns:
        replace_block(Path(page), name, data_table(Path(results), columns.split(",")))
        return
    if page.endswith(".csv"):
        write_csv(Path(results), Path(page))
        return
    entries = read_json_list(Path(results))
    of_figure = [entry for entry in entries if entry["figure"] == name]
    text = figure_table(of_figure) if of_figure else compared_table(entries)
    replace_block(Path(page), name, text)


if __name__ == "__main__":
    main(*sys.argv[1:])

"""The table of a page from results.json: `python -m narrows.papers.table RESULTS PAGE NAME`.

NAME is the paper, or a figure of it that is a page of its own; the page has its marks.
"""

import sys
from pathlib import Path
from typing import Any

from narrows.markdown import number, replace_block, table
from run_files.reading import read_json_list

COLUMNS = ("figure", "quantity", "here", "paper", "agrees")
WORDS = {True: "yes", False: "**no**", None: "open"}


def compared_table(entries: list[dict[str, Any]]) -> str:
    """The numbers that are held against one of the paper's, or against a claim."""
    rows = []
    for entry in entries:
        if entry["paper"] is None and entry["claim"] is None:
            continue
        paper = entry["claim"] if entry["paper"] is None else f"{entry['paper']:.4g}"
        here = number(entry["value"], entry["error"])
        rows.append((entry["figure"], entry["quantity"], here, paper, WORDS[entry["agrees"]]))
    return table(COLUMNS, rows)


def main(results: str, page: str, name: str, *figures: str) -> None:
    """Renew the table of the page; with figures, of these only."""
    entries = [
        entry
        for entry in read_json_list(Path(results))
        if not figures or entry["figure"] in figures
    ]
    replace_block(Path(page), name, compared_table(entries))


if __name__ == "__main__":
    main(*sys.argv[1:])

"""Verdicts that changed: `python -m narrows.papers.changes OLD NEW PAGE NAME`.

OLD and NEW are results.json of the same paper; the page has the marks of NAME.
"""

import math
import sys
from pathlib import Path
from typing import Any

from narrows.markdown import number, replace_block, table
from narrows.papers.table import WORDS
from run_files.reading import read_json_list

COLUMNS = ("figure", "quantity", "before", "", "now", "", "why")
LARGER = 1.25  # times the error before
FEW = 30  # degrees of freedom; from there on Student's t is a normal distribution to 5 %

Entry = dict[str, Any]


def changed_table(before: list[Entry], now: list[Entry]) -> str:
    """The entries of both whose verdicts differ."""
    known = {(entry["figure"], entry["quantity"]): entry for entry in before}
    rows = []
    for entry in now:
        old = known.get((entry["figure"], entry["quantity"]))
        if old is None or old["agrees"] == entry["agrees"]:
            continue
        rows.append(
            (
                *(entry["figure"], entry["quantity"]),
                *(number(old["value"], old["error"]), WORDS[old["agrees"]]),
                *(number(entry["value"], entry["error"]), WORDS[entry["agrees"]]),
                reason(old, entry),
            )
        )
    return table(COLUMNS, rows)


def reason(old: Entry, entry: Entry) -> str:
    """Whether the error or the value is another, by how much."""
    if None in (old["value"], old["error"], entry["value"], entry["error"]):
        return "known in one of them only"
    told = []
    if old["error"] and not 1 / LARGER < entry["error"] / old["error"] < LARGER:
        told.append(f"the error is {entry['error'] / old['error']:.2g} times that before")
    joint = math.hypot(old["error"], entry["error"])
    if joint and abs(entry["value"] - old["value"]) > joint:
        told.append(f"{abs(entry['value'] - old['value']) / joint:.1f} joint errors from before")
    freedom = entry.get("freedom")
    if freedom and freedom < FEW:
        told.append(f"the error has {freedom:.2g} degrees of freedom")
    return "; ".join(told) or "close to the limit in both"


def main(before: str, now: str, page: str, name: str) -> None:
    """Renew the table of the page."""
    text = changed_table(read_json_list(Path(before)), read_json_list(Path(now)))
    replace_block(Path(page), name, text)


if __name__ == "__main__":
    main(*sys.argv[1:])

"""Tables in Markdown pages, written by the command that measured them."""

import math
import re
from collections.abc import Iterable, Sequence
from decimal import Decimal
from pathlib import Path

from run_files.writing import replace_text


def table(columns: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A Markdown table."""
    lines = [columns, ["---"] * len(columns), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def number(value: float | None, error: float | None) -> str:
    """`0.1420 +- 0.0042`: the value to the second digit of its error, if it has two."""
    if value is None:
        return "-"
    if not error:
        return f"{value:.4g}"
    significant = Decimal(repr(error)).normalize().as_tuple().digits[:2]
    first = math.floor(math.log10(error))
    decimals = max(0, len(significant) - 1 - first)
    return f"{value:.{decimals}f} +- {error:.{decimals}f}"


def replace_block(page: Path, name: str, text: str) -> None:
    """Put a text between the marks `<!-- NAME -->` and `<!-- end of NAME -->` of a page.

    Raises:
        ValueError: when the page does not have the two marks, once each.
    """
    begin, end = f"<!-- {name} -->", f"<!-- end of {name} -->"
    content = page.read_text(encoding="utf-8")
    if content.count(begin) != 1 or content.count(end) != 1:
        raise ValueError(f"{page}: must have the marks {begin} and {end} once each")
    pattern = re.escape(begin) + ".*?" + re.escape(end)
    block = f"{begin}\n{text}\n{end}"
    replace_text(page, re.sub(pattern, lambda _: block, content, flags=re.DOTALL))

"""Pages in one file, for any width and for dark rooms: pictures inside, no network, no scripts."""

import base64
from collections.abc import Iterable, Sequence
from html import escape
from pathlib import Path

STYLE = """
:root { color-scheme: light dark; --text: #1b1f24; --soft: #4a5360; --ground: #f5f6f8;
  --card: #ffffff; --line: #dfe3e8; --link: #1f5fa8; --agrees: #17713a; --disagrees: #b3261e;
  --open: #7a5600; --claim: #a50d26; }
@media (prefers-color-scheme: dark) { :root { --text: #e6e9ed; --soft: #aeb7c2; --ground: #14171b;
  --card: #1d2126; --line: #3a414a; --link: #8ab8ff; --agrees: #6cc68c; --disagrees: #ff8a80;
  --open: #e0b04a; --claim: #ff8fa3; } }
* { box-sizing: border-box; }
body { font: 15px/1.45 system-ui, sans-serif; color: var(--text); background: var(--ground);
  margin: 0; overflow-wrap: anywhere; }
main { max-width: 1280px; margin: 0 auto; padding: 16px; }
h1 { font-size: 24px; margin: 0 0 4px; }
h2 { font-size: 18px; margin: 0; }
a { color: var(--link); }
.caption { margin: 2px 0 12px; color: var(--soft); }
section { background: var(--card); border: 1px solid var(--line); border-radius: 8px;
  padding: 14px 16px; margin: 16px 0; }
.pair { display: grid; gap: 20px; align-items: start;
  grid-template-columns: repeat(auto-fit, minmax(min(380px, 100%), 1fr)); }
.wide { grid-template-columns: minmax(0, 1fr); }
figure { margin: 0; }
figcaption { color: var(--soft); font-size: 13px; }
img { max-width: 100%; height: auto; background: white; border-radius: 4px; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: 13.5px; }
th, td { overflow-wrap: break-word; }
th { text-align: left; font-weight: 600; border-bottom: 2px solid var(--line); padding: 4px 8px; }
td { border-bottom: 1px solid var(--line); padding: 5px 8px; vertical-align: top; }
td.number { white-space: nowrap; font-variant-numeric: tabular-nums; }
.stack { margin-bottom: 14px; }
.note { color: var(--soft); font-size: 12.5px; }
.claim { color: var(--claim); }
.verdict { font-weight: 600; white-space: nowrap; }
.agrees { color: var(--agrees); } .disagrees, .failed { color: var(--disagrees); }
.open { color: var(--open); }
nav a { margin-right: 10px; }
pre { white-space: pre-wrap; font-size: 12.5px; margin: 0; }
@media (max-width: 600px) { main { padding: 6px; } section { padding: 10px; }
  table { font-size: 12.5px; } th, td { padding: 4px 3px; }
  td:first-child { overflow-wrap: anywhere; }
  td.number { white-space: normal; }
  .stack tr:first-child { display: none; } .stack tr { display: block; margin-bottom: 10px; }
  .stack td { display: flex; justify-content: space-between; gap: 12px; text-align: right; }
  .stack td::before { content: attr(data-name); font-weight: 600; text-align: left; } }
"""


def page(title: str, body: str) -> str:
    """A whole page; the body is HTML."""
    return f"""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{escape(title)}</title><style>{STYLE}</style></head>
<body><main>
{body}
</main></body></html>
"""


def picture(path: Path, says: str, caption: str = "") -> str:
    """A PNG inside the page; `says` is what somebody reads who does not see it."""
    data = base64.b64encode(path.read_bytes()).decode()
    image = f'<img alt="{escape(says)}" src="data:image/png;base64,{data}">'
    below = f"<figcaption>{escape(caption)}</figcaption>" if caption else ""
    return f"<figure>{image}{below}</figure>"


def table(headings: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table of HTML cells; without headings, a list of names and values."""
    head = "".join(f"<th>{escape(each)}</th>" for each in headings)
    body = "".join(
        "<tr>"
        + "".join(cell if cell[:3] == "<td" else f"<td>{cell}</td>" for cell in row)
        + "</tr>"
        for row in rows
    )
    first = f"<tr>{head}</tr>" if head else ""
    return f'<div class="scroll"><table>{first}{body}</table></div>'


def wide_table(headings: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table whose rows a narrow page shows as lists of names and values."""
    named = (
        [
            f'<td data-name="{escape(name)}"{cell[3:] if cell[:3] == "<td" else f">{cell}</td>"}'
            for name, cell in zip(headings, row, strict=True)
        ]
        for row in rows
    )
    return f'<div class="stack">{table(headings, named)}</div>'


def number(value: float | None, error: float | None) -> str:
    """A cell: the value to the second digit of its error."""
    return f'<td class="number">{measured(value, error)}</td>'


def measured(value: float | None, error: float | None) -> str:
    """The value to the second digit of its error."""
    if value is None:
        return "-"
    if not error:
        return f"{value:.5g}"
    digits = max(0, 1 - int(f"{error:e}".split("e")[1]))
    return f"{value:.{digits}f} &plusmn; {error:.{digits}f}"

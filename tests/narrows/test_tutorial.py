"""docs/tutorial.md: its commands and snippets, in order, as printed."""

import math
import os
import re
import subprocess
import sys
from collections.abc import Sequence
from itertools import groupby
from pathlib import Path

import pytest

from tests.conftest import COMMANDS, ROOT

BLOCK = re.compile(r"^```(sh|python|text)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


ALLOWED = 4  # joint standard errors between a printed estimate and this machine's
PACE = re.compile(r"\S+ t0/s")
CENTRE = " centre of mass"  # of one moment, so of no use beyond it, but at the start


def cells(line: str) -> list[str]:
    """Quantity, value and error of a row of a table; of another line the line."""
    return [cell.strip() for cell in re.split("[│┃]", line)[1:4]] or [line.strip()]


def numbers(words: Sequence[str]) -> list[float] | None:
    """The words as numbers, None where one is none."""
    try:
        return [float(word) for word in words]
    except ValueError:
        return None


def estimate(line: str) -> tuple[str, float, float] | None:
    """Name, value and error that a line prints, as a row of a table or with `+-`."""
    told = re.fullmatch(r"(.*\S) +(\S+) \+- (\S+)", line)
    name, *pair = told.groups() if told else cells(line)
    found = numbers(pair)
    return (name, found[0], found[1]) if found and len(found) == 2 else None


def agree(shown: str, said: str) -> bool:
    """Whether a command said what the page shows.

    Estimates agree within their errors, which themselves agree within a factor of two. Of thermo
    output and of a centre of mass, which depend on the machine and have no error, the time agrees.
    Other lines are the same, up to the pace of the machine and to an ellipsis.
    """
    ours, theirs = estimate(shown), estimate(said)
    if ours and theirs:
        (name, value, error), (named, other, other_error) = ours, theirs
        apart = abs(value - other) <= ALLOWED * math.hypot(error, other_error)
        return name == named and apart and error / 2 <= other_error <= 2 * error
    rows = [numbers(line.split()) for line in (shown, said)]
    if rows[0] and rows[1]:
        return len(rows[0]) == len(rows[1]) and rows[0][0] == rows[1][0]
    shown, said = (PACE.sub("t0/s", line) for line in (shown, said))
    if CENTRE in shown and not shown.startswith("time 0.0"):
        shown, said = (line.partition(CENTRE)[0] for line in (shown, said))
    if shown.endswith("..."):
        return said.startswith(shown.removesuffix("..."))
    return [cell.split() for cell in cells(shown)] == [cell.split() for cell in cells(said)]


@pytest.mark.parametrize(
    ("shown", "said", "same"),
    [
        ("│ speed │ 0.30 │ 0.03 │", "│ speed │ 0.49 │ 0.04 │ a note │", True),
        ("│ speed │ 0.30 │ 0.03 │", "│ speed │ 0.51 │ 0.04 │ a note │", False),
        ("│ speed │ 0.30 │ 0.03 │", "│ speed │ 0.30 │ 0.07 │ a note │", False),
        ("│ speed │ 0.30 │ 0.03 │", "│ rate  │ 0.30 │ 0.03 │ a note │", False),
        ("speed 0.30 +- 0.03", "speed 0.49 +- 0.04", True),
        ("speed 0.30 +- 0.03", "speed 0.51 +- 0.04", False),
        ("  750   0.99  1e-17", "  750   1.01   0.2", True),
        ("  750   0.99  1e-17", "  751   0.99  1e-17", False),
        ("12 of 12 runs finished", "11 of 12 runs finished", False),
        ("2100 of 2100 t0  221 t0/s", "2100 of 2100 t0  1e+03 t0/s", True),
        ("2100 of 2100 t0  221 t0/s", "2099 of 2100 t0  221 t0/s", False),
        ("has length, width, ...", "has length, width, angle", True),
        ("time 1.0 centre of mass [1. 2.]", "time 1.0 centre of mass [3. 4.]", True),
        ("time 0.0 centre of mass [1. 2.]", "time 0.0 centre of mass [3. 4.]", False),
    ],
)
def test_what_agrees(shown: str, said: str, same: bool) -> None:
    assert agree(shown, said) == same


def test_the_tutorial_does_what_it_prints(tmp_path: Path) -> None:
    """Every line that it shows is a line that the commands before it said."""
    page = (ROOT / "docs" / "tutorial.md").read_text(encoding="utf-8")
    (_, install), *blocks = BLOCK.findall(page)
    assert "pip install" in install  # done, or this would not run
    environment = os.environ | {
        "PATH": f"{COMMANDS}:/usr/bin:/bin",
        "PYTHONPATH": str(ROOT),
        "HOME": str(tmp_path),
        "MPLBACKEND": "Agg",
        "COLUMNS": "200",
    }
    said: list[str] = []
    for language, group in groupby(blocks, key=lambda block: str(block[0])):
        text = "\n".join(block for _, block in group)
        if language == "text":
            for shown in text.strip("\n").splitlines():
                assert any(agree(shown, line) for line in said), "\n".join([shown, "", *said])
            said.clear()
            continue
        program = [sys.executable, "-c"]
        if language == "sh":
            program = ["bash", "-e", "-c"]
            text += '\n[ "$PWD" = "$HOME" ] # the next block begins where this one did'
        done = subprocess.run(
            [*program, text],
            cwd=tmp_path,
            env=environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        assert done.returncode == 0, f"{text}\n{done.stdout}"
        said += done.stdout.splitlines()
    assert {path.name for path in tmp_path.glob("*.png")} == {"speed.png", "heights.png"}

"""docs/tutorial.md: its commands and snippets, in order, as printed."""

import os
import re
import subprocess
import sys
from itertools import groupby
from pathlib import Path

from tests.conftest import COMMANDS, ROOT

BLOCK = re.compile(r"^```(sh|python|text)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def words(text: str) -> set[str]:
    return set(re.findall(r"[A-Za-z_]{2,}", text))


def test_the_tutorial_does_what_it_prints(tmp_path: Path) -> None:
    """What it shows of the outputs is compared by its words: numbers depend on the machine."""
    page = (ROOT / "docs" / "tutorial.md").read_text(encoding="utf-8")
    (_, install), *blocks = BLOCK.findall(page)
    assert "pip install" in install  # done, or this would not run
    environment = os.environ | {
        "PATH": f"{COMMANDS}:/usr/bin:/bin",
        "PYTHONPATH": str(ROOT),
        "HOME": str(tmp_path),
        "MPLBACKEND": "Agg",
    }
    said: set[str] = set()
    for language, group in groupby(blocks, key=lambda block: block[0]):
        text = "\n".join(block for _, block in group)
        if language == "text":
            assert words(text) <= said
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
        said |= words(done.stdout)
    assert {path.name for path in tmp_path.glob("*.png")} == {"speed.png", "heights.png"}

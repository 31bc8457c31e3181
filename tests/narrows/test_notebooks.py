"""The notebooks of docs/notebooks, cell by cell, and the Python of docs/python.md."""

import json
import re
from pathlib import Path
from typing import Any

import matplotlib
import pytest

from tests.conftest import ROOT

NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))


def cells(notebook: Path) -> list[dict[str, Any]]:
    content: list[dict[str, Any]] = json.loads(notebook.read_text(encoding="utf-8"))["cells"]
    return [cell for cell in content if cell["cell_type"] == "code"]


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(notebook: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Numbers and figures are those that it shows, as far as a line says what it is of."""
    names: dict[str, Any] = {"__name__": "notebook"}
    pyplot = pytest.importorskip("matplotlib.pyplot")
    with matplotlib.rc_context({"backend": "agg"}):
        for cell in cells(notebook):
            exec(compile("".join(cell["source"]), notebook.name, "exec"), names)
            told = capsys.readouterr().out
            for output in cell["outputs"]:
                if output["output_type"] == "stream":
                    shown = "".join(output["text"])
                    words = [re.findall(r"[a-z_]{3,}", text) for text in (shown, told)]
                    assert words[0] == words[1]
        figures = sum(
            "image/png" in o.get("data", {}) for c in cells(notebook) for o in c["outputs"]
        )
        assert len(pyplot.get_fignums()) == figures == 1


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_holds_what_it_made(notebook: Path) -> None:
    assert all(cell["outputs"] or "=" in "".join(cell["source"]) for cell in cells(notebook))
    assert str(Path.home()) not in notebook.read_text(encoding="utf-8")
    assert "stderr" not in notebook.read_text(encoding="utf-8")


def test_the_python_of_the_page(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Every block but the sweep, which a notebook runs; the first for a shorter while."""
    page = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")
    first, *blocks, sweep = re.findall(r"^```python\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    assert sweep.startswith("from narrows import sweep\n")
    monkeypatch.chdir(tmp_path)
    for block in (first.replace("length=60", "length=60, duration=5, equilibration=0"), *blocks):
        exec(compile(block, "python.md", "exec"), {"__name__": "page"})
    assert "[2. 2. 2.]" in capsys.readouterr().out

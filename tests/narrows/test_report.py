"""`narrows report`: a run and a sweep on one page each."""

import json
import re
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from analysis.figure_captions import CAPTIONS
from narrows.citations import PAPERS
from narrows.cli import app
from narrows.html import measured
from narrows.papers import papers
from narrows.report import report_sweep
from srd_driver import Simulation, sweep_definition
from tests.conftest import ROOT, Run

FIELDS = {"length": 20, "colloids": 2, "duration": 6, "equilibration": 1, "sampling_interval": 0.15}
SETTINGS = [word for field in FIELDS.items() for word in ("--set", "{}={}".format(*field))]


def require_one_file(page: str) -> None:
    """Nothing is fetched from elsewhere, no script runs, every picture says what it shows."""
    assert not re.search(r"https?://|@import|url\(|<script", page)
    images = re.findall(r'<img alt="([^"]*)" src="([^"]{22})', page)
    assert len(images) == page.count("<img")
    assert all(len(says) > 20 for says, _ in images)
    assert {source for _, source in images} <= {"data:image/png;base64,"}


def test_of_a_run(tmp_path: Path, command: Run) -> None:
    out = tmp_path / "a<b>"
    command("narrows", "run", "channel", *SETTINGS, "--out", out)
    assert command("narrows", "report", out).stdout == f"open {out / 'report.html'}\n"
    page = (out / "report.html").read_text()
    require_one_file(page)
    summary = json.loads((out / "summary.json").read_text())
    assert page.count("<img") == len(summary["figures"])
    speed = summary["settling_speed"]
    assert f">{measured(speed['value'], speed['error'])}</td>" in page
    assert "a&lt;b&gt;: channel" in page
    assert "finished: 7.05 t0 simulated" in page  # rounded up to whole outputs
    assert "<td><code>length</code></td><td><b>20</b></td><td>a0</td>" in page
    assert "<td><code>width</code></td><td>10</td>" in page
    manifest = json.loads((out / "manifest.json").read_text())
    for said in (f"narrows {manifest['versions']['narrows']}", "seed 1", "run channel --set"):
        assert said in page
    assert "Thompson" in page
    assert "Malevanets" in page
    assert PAPERS["tabatabaei-2009"] in page


def test_of_a_sweep(tmp_path: Path) -> None:
    out = tmp_path / "s"
    over: dict[str, list[Any]] = {"gravity": [0.1, 0.2], "hydrodynamics": ["on", "bath"]}
    sweep = sweep_definition.store(sweep_definition.plan(out, "channel", FIELDS, over, 1))
    for run in sweep.runs:
        with Simulation(run.scene, run.engine, run.folder) as simulation:
            simulation.finish()
    assert report_sweep(out, jobs=1) == out / "report.html"
    page = (out / "report.html").read_text()
    require_one_file(page)
    assert page.count("<img") == 1
    assert "4 points from 4 of 4 runs" in page
    assert "<th>gravity</th><th>hydrodynamics</th><th>repeats</th>" in page
    assert "gravity=0.2,hydrodynamics=on,seed=1" in page


def test_what_is_neither_is_one_line(tmp_path: Path) -> None:
    done = CliRunner().invoke(app, ["report", str(tmp_path)])
    assert done.exit_code == 2
    assert done.stderr.startswith(f"narrows: {tmp_path}")
    assert done.stderr.count("\n") == 1


def test_every_figure_of_the_measures_has_a_caption() -> None:
    named = {
        name
        for file in (ROOT / "analysis" / "measures").glob("*.py")
        for name in re.findall(r'"(\w+\.png)"', file.read_text(encoding="utf-8"))
    }
    assert len(named) > 15
    assert named <= CAPTIONS.keys()


def test_every_paper_can_be_cited() -> None:
    assert sorted(PAPERS) == papers()


@pytest.mark.parametrize(
    ("value", "error", "text"),
    [
        (0.0323456, 0.0012345, "0.0323 &plusmn; 0.0012"),
        (1101.4, 23.0, "1101 &plusmn; 23"),
        (None, None, "-"),
        (0.5, None, "0.5"),
    ],
)
def test_numbers_to_the_second_digit_of_their_error(
    value: float | None, error: float | None, text: str
) -> None:
    assert measured(value, error) == text

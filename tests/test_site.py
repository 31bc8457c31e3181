"""The documentation site: every page, link, picture and docstring of it, without the network."""

import sys
from pathlib import Path

import pytest

from tests.conftest import ROOT, Run

pytest.importorskip("furo")


def test_the_site_is_built_without_a_warning(tmp_path: Path, command: Run) -> None:
    built = command(
        *(Path(sys.executable).name, "-m", "sphinx", "-W", "--keep-going", "-q", "-b", "html"),
        *(ROOT / "docs", tmp_path / "site"),
    )
    assert "WARNING: " not in built.stderr.replace("WARNING MDAnalysis", "")
    pages = {path.stem for path in (tmp_path / "site").glob("*.html")}
    assert {path.stem for path in (ROOT / "docs").glob("*.md")} <= pages
    api = (tmp_path / "site" / "api.html").read_text(encoding="utf-8")
    for name in ("analysis.estimate.Estimate", "srd_driver.simulation.Simulation"):
        assert f'id="{name}"' in api


def test_every_page_is_in_a_section() -> None:
    listed = (ROOT / "docs" / "index.md").read_text(encoding="utf-8").split("```{toctree}")[1:]
    pages = {line for section in listed for line in section.splitlines()}
    wanted = {path.stem for path in (ROOT / "docs").glob("*.md")} - {"index"}
    assert wanted <= pages

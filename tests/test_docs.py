"""The pages: links lead somewhere, and what docs/theory.md names is in the code."""

import doctest
import importlib
import re
import tomllib
from pathlib import Path

import pytest

from narrows.papers.table import main as renew_table
from tests.conftest import ROOT

FRONT = [ROOT / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")]
PAGES = [*FRONT, *sorted((ROOT / "docs").glob("*.md"))]
PACKAGES = ("lammps_inputs", "srd_driver", "run_files", "analysis", "lattice", "narrows")
WITH_EXAMPLES = [
    ".".join(path.relative_to(ROOT).with_suffix("").parts)
    for package in PACKAGES
    for path in sorted((ROOT / package).rglob("*.py"))
    if "\n    >>> " in path.read_text(encoding="utf-8")
]
RESULTS = sorted((ROOT / "docs" / "results").glob("*.json"))
LINK = re.compile(r"\]\(([^)\s]+)\)")
HEADING = re.compile(r"^#+ (.*)$", re.MULTILINE)


def anchors(page: Path) -> set[str]:
    """The anchors that a reader of the page on a forge can be sent to."""
    headings = HEADING.findall(page.read_text(encoding="utf-8"))
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_resolve(page: Path) -> None:
    for link in LINK.findall(page.read_text(encoding="utf-8")):
        if re.match(r"[a-z]+:", link):
            continue
        path, _, anchor = link.partition("#")
        target = page.parent / path if path else page
        assert target.exists(), link
        assert not anchor or anchor in anchors(target), link


def test_the_readme_leads_to_every_page() -> None:
    linked = set(LINK.findall(PAGES[0].read_text(encoding="utf-8")))
    assert {str(page.relative_to(ROOT)) for page in PAGES[1:]} <= linked


def test_the_version_is_told_alike() -> None:
    """In the metadata, to those who cite, and at the top of the changes."""
    version = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"]
    assert f"\nversion: {version}\n" in (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    newest = re.search(r"^## (\S+?),? ", FRONT[2].read_text(encoding="utf-8"), re.MULTILINE)
    assert newest
    assert newest[1] == version


def test_the_readme_begins_with_what_it_is_for() -> None:
    """A picture and the speed, then the two commands, that for use first."""
    text = FRONT[0].read_text(encoding="utf-8")
    before, first, *_ = text.split("```sh\n")
    assert "![" in before
    assert "fix srd" in before
    assert "pytest" not in before + first  # .ci/run takes the first line that has it
    assert first.startswith("python3 -m venv .venv && .venv/bin/pip install . && ")


def test_what_the_theory_page_names_is_there() -> None:
    """Of `path::name` the file exists and defines the name; of `path` alone the file exists."""
    text = (ROOT / "docs" / "theory.md").read_text(encoding="utf-8")
    named = re.findall(r"`([\w/]+\.(?:py|h|cpp))(?:::([\w:]+))?`", text)
    assert len(named) > 50
    for path, names in named:
        code = (ROOT / path).read_text(encoding="utf-8")
        for name in filter(None, names.split("::")):
            if path.endswith(".py"):
                defined = rf"^ *(?:class|def) {name}\b|^ *{name}\b.*="
            else:
                defined = rf"^(?!\s*return )[\w<>:&* ]*[\w>&*] {name}\b\s*(?:[({{:]|$)"
            assert re.search(defined, code, re.MULTILINE), f"{path}::{name}"


@pytest.mark.parametrize("module", WITH_EXAMPLES)
def test_examples_in_docstrings(module: str) -> None:
    found = doctest.testmod(importlib.import_module(module))
    assert found.attempted > 0
    assert found.failed == 0


def test_the_python_of_the_readme(capsys: pytest.CaptureFixture[str]) -> None:
    (block,) = re.findall(r"^```python\n(.*?)^```$", PAGES[0].read_text(), re.MULTILINE | re.DOTALL)
    exec(compile(block, "README.md", "exec"), {})
    assert len(capsys.readouterr().out.strip().splitlines()) == 5  # a line a colloid


THESIS = "tabatabaei-2009.json"
TABLES = [
    *((results.name, "reproduce.md", results.stem) for results in RESULTS),
    *((THESIS, "beyond.md", figure) for figure in ("beyond-flux", "beyond-front")),
]


@pytest.mark.parametrize("results", RESULTS, ids=lambda path: path.stem)
def test_all_numbers_are_in_a_csv_that_its_page_links(results: Path, tmp_path: Path) -> None:
    renew_table(str(results), str(tmp_path / "all.csv"))
    kept = results.with_suffix(".csv")
    assert (tmp_path / "all.csv").read_text() == kept.read_text()
    page = (ROOT / "docs" / "reproduce.md").read_text(encoding="utf-8")
    assert f"](results/{kept.name})" in page


@pytest.mark.parametrize(("results", "page", "name"), TABLES)
def test_tables_of_papers_are_those_of_the_results_kept(
    results: str, page: str, name: str, tmp_path: Path
) -> None:
    before = (ROOT / "docs" / page).read_text(encoding="utf-8")
    copy = tmp_path / page
    copy.write_text(before, encoding="utf-8")
    renew_table(str(ROOT / "docs" / "results" / results), str(copy), name)
    assert copy.read_text(encoding="utf-8") == before


def test_columns_of_a_figures_data_become_a_table(tmp_path: Path) -> None:
    page, data = tmp_path / "page.md", tmp_path / "figure.csv"
    page.write_text("before\n<!-- x -->\n<!-- end of x -->\nafter\n")
    data.write_text("noise,field,current,current_error\nbath,2.0,0.5,0.02\n")
    renew_table(str(data), str(page), "x", "noise,current")
    rows = "| noise | current |\n| --- | --- |\n| bath | 0.50 +- 0.02 |"
    assert rows in page.read_text()
    with pytest.raises(KeyError, match="speed"):
        renew_table(str(data), str(page), "x", "noise,speed")

import re
from pathlib import Path

import pytest
from typer.testing import CliRunner

from narrows.cli import app
from narrows.papers import paper_named
from narrows.papers.reproduction_file import remember
from narrows.papers.session import Plan, select
from srd_driver import Simulation


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["tabatabaei-2010"], "'tabatabaei-2010' is not known; there is carmer-2012, "),
        (["tabatabaei-2009", "4.2"], "figure '4.2': tabatabaei-2009 has 2.1, 2.2, 3.6"),
    ],
)
def test_what_is_not_there(words: list[str], message: str, tmp_path: Path) -> None:
    command = ["reproduce", *words, "--out", str(tmp_path / "out")]
    done = CliRunner().invoke(app, command, env={"COLUMNS": "200", "TERM": "dumb"})
    assert done.exit_code == 2
    assert message in done.stderr
    assert not (tmp_path / "out").exists()


def test_a_figure_of_the_lattice_gas(tmp_path: Path) -> None:
    out = tmp_path / "out"
    command = ["reproduce", "tabatabaei-2009", "2.2", "--quick", "--out", str(out)]
    done = CliRunner().invoke(app, command)
    assert done.exit_code == 0
    lines = done.stdout.splitlines()
    assert lines[0].startswith("tabatabaei-2009, quick quality: 1 figures from 0 runs, 0 of them")
    assert lines[1].startswith("2 results, ")
    assert lines[-1] == f"open {out / 'index.html'}"
    assert {path.name for path in out.iterdir()} >= {
        *("figure-2.2.png", "figure-2.2.pdf", "figure-2.2.csv", "results.json", "index.html")
    }


def test_status_tells_of_each_figure_and_run(tmp_path: Path) -> None:
    """Asked for and interrupted, as after a kill: nothing finished, one run half way."""
    out = tmp_path / "out"
    paper = paper_named("tabatabaei-2009")
    plan = Plan(paper, select(paper, ["2.2", "4.4"]), "quick", out)
    remember(plan)
    remember(Plan(paper, select(paper, ["4.4", "4.5"]), "quick", out))
    half = plan.runs[0]
    with Simulation(half.scene, half.engine, half.folder) as simulation:
        simulation.run(0.75)
        simulation.checkpoint()
    told = CliRunner().invoke(app, ["status", str(out)]).stdout.splitlines()
    assert told[0] == "tabatabaei-2009, quick quality"
    assert told[1] == "  2.2  needs no runs"
    assert told[2] == f"  4.4  1 stopped, {len(plan.runs) - 1} waiting"
    assert told[3].startswith("  4.5  ")
    assert told[4].startswith(f"  {half.folder.name}  stopped")
    assert re.fullmatch(r"  \d+ runs: 1 stopped, \d+ waiting", told[-1])
    file = out / "reproduction.json"
    file.write_text(file.read_text().replace("4.5", "9.9"))
    done = CliRunner().invoke(app, ["status", str(out)])
    assert done.exit_code == 2
    assert done.stderr.startswith(f"narrows: {file}: damaged, or changed by hand")


def test_the_status_of_ladders(tmp_path: Path) -> None:
    """Runs that begin where others end are told of too."""
    paper = paper_named("delhommelle-2005")
    remember(Plan(paper, select(paper, ["10"]), "quick", tmp_path))
    done = CliRunner().invoke(app, ["status", str(tmp_path)])
    assert done.exit_code == 0
    assert done.stdout.splitlines()[-1].split()[-1] == "waiting"

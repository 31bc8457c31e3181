from pathlib import Path

import pytest
from typer.testing import CliRunner

from narrows.cli import app


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

"""The smallest installation, `pip install narrows` without extras: what needs more says so."""

from pathlib import Path

import pytest

from tests.conftest import ROOT, Run

WITHOUT = "import sys; sys.modules['numba'] = None; from narrows.cli import main; main()"
SHORT = ("--set", "duration=3", "--set", "equilibration=0")
MODEL = ROOT / "docs" / "examples" / "lattice" / "one_sided.toml"


def test_a_run_and_its_analysis_need_no_extra(tmp_path: Path, command: Run) -> None:
    run = tmp_path / "run"
    command("python", "-c", WITHOUT, "run", "channel", *SHORT, "--out", run)
    command("python", "-c", WITHOUT, "analyze", run)
    command("python", "-c", WITHOUT, "picture", run)
    command("python", "-c", WITHOUT, "lattice", "check", MODEL, "--sites", "5")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (
            ("run", "pore", "--out", "pore"),
            "engine events needs numba: pip install 'narrows[events]'",
        ),
        (
            ("sweep", "pore", "--over", "width=5,6", "--out", "pores"),
            "engine events needs numba: pip install 'narrows[events]'",
        ),
        (
            ("lattice", "simulate", str(MODEL)),
            "kinetic Monte Carlo needs numba: pip install 'narrows[lattice]'",
        ),
        (
            ("reproduce", "tabatabaei-2009", "--out", "thesis"),
            "kinetic Monte Carlo needs numba: pip install 'narrows[lattice]'",
        ),
    ],
    ids=["run", "sweep", "lattice", "reproduce"],
)
def test_what_needs_more_names_the_extra(
    words: tuple[str, ...], message: str, tmp_path: Path, command: Run
) -> None:
    refused = command("python", "-c", WITHOUT, *words, cwd=tmp_path, succeed=False)
    assert refused.returncode in (1, 2)
    assert message in refused.stderr
    assert len(refused.stderr.splitlines()) == 1
    assert not list(tmp_path.iterdir())

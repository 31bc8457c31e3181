import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner, Result

from narrows.cli import app
from tests.analysis.run_writer import write_channel

FRAMES = 101


@pytest.fixture
def run(tmp_path: Path) -> Path:
    times = np.arange(FRAMES)[:, None, None]
    positions = np.array([[5.0, 5.0]]) + times * [0.03, 0.0]
    velocities = 0.1 * np.random.default_rng(0).normal(size=(FRAMES, 1, 2))
    write_channel(tmp_path / "run", positions, velocities, np.full(FRAMES - 1, 0.01))
    return tmp_path / "run"


def narrows(*words: str | Path) -> Result:
    return CliRunner().invoke(app, ["analyze", *map(str, words)], env={"COLUMNS": "200"})


def test_table_and_files(run: Path) -> None:
    done = narrows(run)
    assert done.exit_code == 0
    assert "channel, engine srd, not finished" in done.stdout
    assert "settling speed rest" in done.stdout
    assert "0.03" in done.stdout
    assert "96 frames; at least 320 are needed" in done.stdout
    assert (
        "summary.json, profile.png, settling_speed.png, snapshot.png, space_time.png" in done.stdout
    )
    assert json.loads((run / "summary.json").read_text())["scene"] == "channel"


def test_bad_directory_is_one_line_on_stderr(tmp_path: Path) -> None:
    done = narrows(tmp_path / "nowhere")
    assert done.exit_code == 2
    assert done.stdout == ""
    assert done.stderr == f"narrows: {tmp_path / 'nowhere'}: no such directory\n"


def test_results_that_cannot_be_written(run: Path) -> None:
    (run / "summary.json").mkdir()
    done = narrows(run)
    assert done.exit_code == 1
    assert done.stderr.startswith("narrows: ")
    assert done.stderr.count("\n") == 1
    assert "summary.json" in done.stderr


def test_missing_argument() -> None:
    done = narrows()
    assert done.exit_code == 2
    assert "Missing argument 'DIR'" in done.stderr


def test_run_that_has_only_begun(run: Path) -> None:
    (run / "observables.dat").write_text("# Time-averaged data\n# TimeStep v_fluid_temperature\n")
    done = narrows(run)
    assert done.exit_code == 2
    assert done.stderr.count("\n") == 1
    assert "observables.dat: no column v_mean_velocity_x" in done.stderr

"""`sweep.json`: written, read, and refused where a run would leave the folder."""

import json
from pathlib import Path
from typing import Any

import pytest

from run_files import RunDirectoryError
from run_files.sweep_file import SweepFile, SweptRun, is_sweep, read_sweep, write_sweep

SWEEP = SweepFile(
    scene="channel",
    engine="mpc",
    over=("gravity",),
    runs={"gravity=0.1,seed=1": SweptRun(fields={"gravity": 0.1, "seed": 1}, total_steps=1000)},
)


def test_what_is_written_is_read(tmp_path: Path) -> None:
    assert not is_sweep(tmp_path)
    write_sweep(tmp_path, SWEEP)
    assert is_sweep(tmp_path)
    assert read_sweep(tmp_path) == SWEEP


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"runs": {"../run": {"fields": {}, "total_steps": 1}}}, "run '../run': not the name of"),
        (
            {"runs": {"run": {"fields": {}, "total_steps": 0}}},
            "runs.run.total_steps: should be gre",
        ),
        ({"runs": {"run": {"fields": {}}}}, "runs.run.total_steps: Field required"),
        ({"runs": []}, "runs: should be a valid dictionary"),
        ({"over": "gravity"}, "over: should be a valid tuple"),
        ({"scene": 3}, "scene: should be a valid string"),
        ({"more": 1}, "more: Extra inputs are not permitted"),
    ],
)
def test_a_damaged_sweep_is_refused(change: dict[str, Any], reason: str, tmp_path: Path) -> None:
    path = tmp_path / "sweep.json"
    path.write_text(json.dumps(SWEEP.model_dump(mode="json") | change))
    with pytest.raises(RunDirectoryError) as error:
        read_sweep(tmp_path)
    assert str(error.value).startswith(f"{path}: {reason}")
    assert "\n" not in str(error.value)


def test_no_sweep(tmp_path: Path) -> None:
    with pytest.raises(RunDirectoryError) as error:
        read_sweep(tmp_path)
    assert str(error.value) == f"{tmp_path}: holds no sweep: it has no sweep.json"

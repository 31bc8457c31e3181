"""`progress.json`: only what we may have written is believed."""

import json
from pathlib import Path
from typing import Any

import pytest

from run_files import RunDirectoryError
from run_files.progress import (
    Progress,
    is_begun,
    read_failure,
    read_progress,
    write_failure,
    write_progress,
)


def test_the_newest_checkpoint_stays_and_older_ones_go(tmp_path: Path) -> None:
    assert not is_begun(tmp_path)
    for step in (0, 10, 20):
        (tmp_path / f"checkpoint.{step}.npz").touch()
    progress = Progress(step=10, wall_seconds=1.5, checkpoint="checkpoint.10.npz")
    assert write_progress(tmp_path, progress) == progress
    assert is_begun(tmp_path)
    assert read_progress(tmp_path) == progress
    assert [path.name for path in tmp_path.glob("checkpoint.*")] == ["checkpoint.10.npz"]


def test_before_the_first_checkpoint(tmp_path: Path) -> None:
    write_progress(tmp_path, Progress())
    assert read_progress(tmp_path) == Progress(step=0, finished=False, checkpoint=None)


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"checkpoint": "../checkpoint.10.npz"}, "checkpoint '../checkpoint.10.npz': not that of"),
        (
            {"checkpoint": "checkpoint.20.npz"},
            "checkpoint 'checkpoint.20.npz': not that of step 10",
        ),
        ({"checkpoint": "notes.txt"}, "checkpoint 'notes.txt': not that of step 10"),
        ({"step": -1}, "step: should be greater than or equal to 0"),
        ({"step": 2**63}, "step: should be less than 9223372036854775808"),
        ({"step": 1.5}, "step: should be a valid integer"),
        ({"wall_seconds": float("inf")}, "wall_seconds: should be a finite number"),
        ({"finished": "perhaps"}, "finished: should be a valid boolean"),
    ],
)
def test_what_is_not_ours_is_refused(change: dict[str, Any], reason: str, tmp_path: Path) -> None:
    content = {
        "step": 10,
        "wall_seconds": 1.0,
        "finished": False,
        "checkpoint": "checkpoint.10.npz",
    }
    path = tmp_path / "progress.json"
    path.write_text(json.dumps(content | change))
    with pytest.raises(RunDirectoryError) as error:
        read_progress(tmp_path)
    assert str(error.value).startswith(f"{path}: {reason}")
    assert "\n" not in str(error.value)


def test_a_failure_is_told(tmp_path: Path) -> None:
    assert read_failure(tmp_path) is None
    write_failure(tmp_path, "no room")
    assert read_failure(tmp_path) == "no room"
    write_failure(tmp_path / "no" / "such" / "folder", "no room either")  # is not in the way

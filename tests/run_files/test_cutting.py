"""Outputs cut back to a step: no gap, nothing twice, whatever a kill left."""

from pathlib import Path

import pytest

from run_files import RunDirectoryError
from run_files.cutting import cut_output

TABLE = ["# TimeStep v_x\n", "10 1.0\n", "20 2.0\n", "30 3.0\n"]
PROFILE = ["# a\n", "10 2 8\n", "  1 0.5 4\n", "  2 1.5 4\n", "20 2 8\n", "  1 0.5 4\n"]
FRAME = "ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n1\n1 1 0.5\n"


def cut(text: str, kind: str, step: int, tmp_path: Path) -> str:
    path = tmp_path / "output"
    path.write_text(text)
    cut_output(path, kind, step)
    return path.read_text()


@pytest.mark.parametrize(("step", "rows"), [(0, 1), (10, 2), (25, 3), (30, 4), (40, 4)])
@pytest.mark.parametrize("tail", ["", "40 4", "40"])
def test_a_table_keeps_the_row_of_the_step(step: int, rows: int, tail: str, tmp_path: Path) -> None:
    assert cut("".join(TABLE) + tail, "table", step, tmp_path) == "".join(TABLE[:rows])


@pytest.mark.parametrize(("step", "lines"), [(0, 1), (10, 4), (20, 6)])
def test_a_profile_keeps_the_bins_of_the_step(step: int, lines: int, tmp_path: Path) -> None:
    assert cut("".join(PROFILE), "profile", step, tmp_path) == "".join(PROFILE[:lines])


@pytest.mark.parametrize(("step", "frames"), [(0, 0), (10, 1), (15, 2), (20, 2), (30, 3)])
@pytest.mark.parametrize("tail", ["", "ITEM: TIME", "ITEM: TIMESTEP\n", "ITEM: TIMESTEP\n3"])
def test_a_trajectory_loses_the_frame_of_the_step(
    step: int, frames: int, tail: str, tmp_path: Path
) -> None:
    """The engine writes that one again."""
    whole = [FRAME.format(each) for each in (0, 10, 20)]
    left = cut("".join(whole) + tail, "trajectory", step, tmp_path)
    assert left == "".join(whole[:frames])


def test_what_is_missing_is_left(tmp_path: Path) -> None:
    cut_output(tmp_path / "none", "table", 10)
    assert not (tmp_path / "none").exists()


@pytest.mark.parametrize(
    ("text", "kind"),
    [("one 1.0\n", "table"), ("\n", "table"), ("ITEM: TIMESTEP\nx\n", "trajectory")],
)
def test_another_file_is_not_cut(text: str, kind: str, tmp_path: Path) -> None:
    path = tmp_path / "output"
    path.write_text(text)
    with pytest.raises(RunDirectoryError, match="where a step should be"):
        cut_output(path, kind, 10)
    assert path.read_text() == text

import csv
import json
from pathlib import Path

import numpy as np
import pytest

from analysis import RunDirectoryError, tabulate
from tests.analysis.run_writer import Json, channel, write_channel, write_manifest

CHANNEL = {"length": 40.0, "width": 10.0, "gravity": 0.1}


def write_sweep(
    path: Path, over: list[str], runs: dict[str, Json], total_steps: int = 20_000
) -> None:
    path.mkdir(exist_ok=True)
    definition = {
        "scene": "channel",
        "engine": "srd",
        "over": over,
        "runs": {
            name: {"fields": CHANNEL | fields, "total_steps": total_steps}
            for name, fields in runs.items()
        },
    }
    (path / "sweep.json").write_text(json.dumps(definition))


def write_analysed(path: Path, fields: Json, summary: Json, step: int = 20_000) -> None:
    write_manifest(path, "channel", channel(1), CHANNEL | fields)
    write_progress(path, step, finished=step == 20_000)
    (path / "summary.json").write_text(json.dumps(summary))


def write_progress(path: Path, step: int, finished: bool) -> None:
    checkpoint = f"checkpoint.{step}.restart"
    progress = {"step": step, "finished": finished, "checkpoint": checkpoint}
    (path / "progress.json").write_text(json.dumps(progress))


def speed(value: float, error: float) -> Json:
    return {"scene": "channel", "settling_speed": {"value": value, "error": error}}


def read(path: Path) -> list[dict[str, str]]:
    with (path / "table.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def test_one_row_a_point(tmp_path: Path) -> None:
    runs = {
        f"gravity={g},seed={s}": {"gravity": g, "seed": s} for g in (0.2, 0.1) for s in (1, 2, 3, 4)
    }
    write_sweep(tmp_path, ["gravity"], runs)
    values = dict(zip(runs, [1, 2, 3, 6, 5, 7, 0, 0], strict=True))
    for name, fields in runs.items():
        if fields["gravity"] == 0.2 or fields["seed"] < 3:
            write_analysed(tmp_path / name, fields, speed(values[name], 0.3))
    write_analysed(tmp_path / "gravity=0.1,seed=3", runs["gravity=0.1,seed=3"], {}, step=10)
    table = tabulate(tmp_path, 1, renew=False)
    assert (table.finished, table.runs, table.problems) == (6, 8, [])
    low, high = read(tmp_path)
    assert list(low) == ["gravity", "repeats", "settling_speed", "settling_speed_error", "notes"]
    assert {key: float(low[key]) for key in list(low)[:4]} == pytest.approx(
        {
            "gravity": 0.1,
            "repeats": 2,
            "settling_speed": 6.0,
            "settling_speed_error": 1.0,  # 5 and 7 lie further apart than errors of 0.3 allow
        }
    )
    assert low["notes"].endswith("the repeats spread beyond their own errors")
    assert {key: float(high[key]) for key in list(high)[:4]} == pytest.approx(
        {
            "gravity": 0.2,
            "repeats": 4,
            "settling_speed": 3.0,
            "settling_speed_error": np.sqrt(14 / 12),
        }
    )


def test_a_field_that_differs_is_a_column_though_it_was_not_swept(tmp_path: Path) -> None:
    runs = {
        "gravity=0.1,seed=1": {"gravity": 0.1, "width": 10.0},
        "gravity=0.2,seed=1": {"gravity": 0.2, "width": 12.0},
    }
    write_sweep(tmp_path, ["gravity"], runs)
    for name, fields in runs.items():
        write_analysed(tmp_path / name, fields, speed(1, 1))
    tabulate(tmp_path, 1, renew=False)
    assert [(row["gravity"], row["width"]) for row in read(tmp_path)] == [
        ("0.1", "10.0"),
        ("0.2", "12.0"),
    ]


def test_runs_are_analysed_and_one_that_cannot_be_is_named(tmp_path: Path) -> None:
    write_sweep(tmp_path, [], {"seed=1": {"seed": 1}, "seed=2": {"seed": 2}}, total_steps=1000)
    times = np.arange(101)[:, None, None]
    velocities = 0.1 * np.random.default_rng(0).normal(size=(101, 1, 2))
    for name in ("seed=1", "seed=2"):
        path = tmp_path / name
        positions = np.array([[5.0, 5.0]]) + times * [0.03, 0.0]
        write_channel(path, positions, velocities, np.full(100, 0.01), total_steps=1000)
        write_progress(path, 1000, finished=True)
    (tmp_path / "seed=2" / "observables.dat").write_text("# TimeStep\n")
    table = tabulate(tmp_path, 2)
    assert (table.finished, table.runs) == (1, 2)
    assert len(table.problems) == 1
    assert "observables.dat: no column v_fluid_temperature" in table.problems[0]
    (row,) = read(tmp_path)
    assert float(row["settling_speed_rest"]) == pytest.approx(0.03)
    assert (tmp_path / "seed=1" / "summary.json").exists()


def test_what_is_no_sweep_is_refused(tmp_path: Path) -> None:
    with pytest.raises(RunDirectoryError, match=r"holds no sweep: it has no sweep\.json"):
        tabulate(tmp_path, 1)

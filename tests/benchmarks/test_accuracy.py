"""What the chart of accuracy makes of numbers, and that its settings are what they say."""

import math
from pathlib import Path

import pytest

import accuracy
from accuracy import (
    Quantity,
    Result,
    Setting,
    Study,
    full_table,
    measure,
    plain,
    recommended,
    setting,
)
from analysis import Estimate

STUDY = Study("bulk", {}, (), (), name="waves", unit=("decay", lambda scene: 2.0))
QUANTITY = Quantity("viscosity", plain("viscosity"), 1.0)


def result(chosen: Setting, statistical: float, deviation: float, known: float) -> Result:
    return Result(QUANTITY, STUDY, chosen, 1 + deviation, statistical, 4.0, deviation, known, 0.5)


def test_no_setting_is_credited_with_more_than_was_measured() -> None:
    """The error of a long run is the deviation, or the error to which that is known."""
    wrong = result(setting("mpc"), 0.04, -0.03, 0.01)
    right = result(setting("mpc"), 0.04, 0.0, 0.05)
    assert wrong.error(4.0) == pytest.approx(0.05)
    assert wrong.error(1e12) == pytest.approx(0.03)
    assert right.error(1e12) == pytest.approx(0.05)
    assert wrong.time_to(0.05) == pytest.approx(4.0)
    assert wrong.time_to(0.03) == math.inf


def test_the_first_at_an_error_is_recommended() -> None:
    fast = result(setting("mpc", density=3), 0.01, 0.05, 0.001)
    exact = result(setting("mpc", density=30), 0.04, 0.0, 0.005)
    lines = recommended([fast, exact]).splitlines()
    assert lines[2] == "| waves: viscosity | 10% | mpc density=3 | below 1 s |"
    assert lines[3] == "| waves: viscosity | 3% | mpc density=30 | 7.3 s |"
    assert lines[4] == "| waves: viscosity | 1% | mpc density=30 | 85 s |"
    table = full_table([fast])
    assert "| price of decay [s] |" in table
    assert "| waves: viscosity | mpc density=3 | 0.5 | 1.05 | +5.00% +- 0.10% | 0.63% |" in table


def test_a_study_from_runs_to_numbers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Values, deviations from the converged setting, and a folder that is used again."""
    monkeypatch.setattr(accuracy, "ROUNDS", 1)
    monkeypatch.setattr(accuracy, "PIECE_SECONDS", 0.01)
    fields = {"length": 8, "width": 8, "density": 5, "equilibration": 1}
    truth = setting("mpc", 2, collision_time=0.1)
    temperature = Quantity("temperature", plain("temperature"), truth)
    study = Study(
        "bulk", fields, (setting("mpc", thermostat="none"),), (temperature,), converged=truth
    )
    (found,) = measure((study,), tmp_path, 0.05, 1)
    assert (found.setting.changes, found.price) == ((("thermostat", "none"),), None)
    assert abs(found.deviation) < 0.2
    speeds = (tmp_path / "speed.json").read_text()
    assert measure((study,), tmp_path, 0.05, 1) == [found]
    assert (tmp_path / "speed.json").read_text() == speeds
    assert (tmp_path / "pareto.png").exists()


def test_nested_numbers_and_their_scale() -> None:
    summary = {"diffusion": {"msd": {"value": 2.0, "error": 0.2}}}
    assert plain("diffusion.msd", 0.5)(summary, None) == Estimate(1.0, 0.1)  # type: ignore[arg-type]

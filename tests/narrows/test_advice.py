"""Advice: the chart's settings, a calibration, and what follows from them."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lammps_inputs import SceneError, all_engines, make_scene
from narrows.advice import advise
from narrows.chart import ChartedSetting, best, chart
from narrows.until import run_until
from srd_driver import RunError
from tests.conftest import Run

FLUID = {"length": 8, "width": 8, "shear_wave": 0, "density": 5, "equilibration": 2}


def setting(
    deviation: float, deviation_error: float, error: float, **fields: Any
) -> ChartedSetting:
    return ChartedSetting(
        scene="channel",
        quantity="settling_speed",
        engine="mpc",
        fields=fields,
        deviation=deviation,
        deviation_error=deviation_error,
        error_after_10_s=error,
    )


CAREFUL = setting(0.001, 0.005, 0.03)
FAST = setting(-0.04, 0.006, 0.01, gravity=0.3)
ROUGH = setting(0.005, 0.017, 0.02, md_steps_per_collision=1)


def test_the_setting_depends_on_the_error() -> None:
    known = [CAREFUL, FAST, ROUGH]
    assert best(known, 0.1) == FAST  # its deviation is in the error
    assert best(known, 0.02) == CAREFUL  # 24 s against 36 s: 1.7 % leave little of 2 %
    assert best(known, 0.03) == ROUGH
    assert best(known, 0.004) == ROUGH  # none is known so well; of the right ones it is fastest
    assert best([], 0.1) is None


def test_time_leaves_room_for_the_deviation() -> None:
    seconds = ROUGH.time_to(0.03)
    assert math.hypot(0.017, 0.02 * math.sqrt(10 / seconds)) == pytest.approx(0.03)
    assert FAST.time_to(0.04) == math.inf


def test_the_chart_is_of_scenes_and_engines_that_are() -> None:
    assert {entry.engine for entry in chart()} <= all_engines().keys()
    for entry in chart():
        scene = make_scene(entry.scene, **entry.fields)
        assert entry.error_after_10_s > 0, str(scene)


def test_advice_is_a_run_that_holds_it(tmp_path: Path) -> None:
    scene = make_scene("bulk", **FLUID)
    advice = advise(scene, "temperature=0.1%", calibration_seconds=2, cores=1)
    assert (advice.engine, advice.repeats) == ("mpc", 1)
    found = run_until(advice.scene, ["temperature=0.1%"], tmp_path)["temperature"]
    assert found.standard_error <= 0.001
    assert advice.wall_seconds == pytest.approx(
        advice.calibration.pace * (advice.scene.duration + 2)
    )


def test_many_cores_take_many_seeds() -> None:
    scene = make_scene("bulk", **FLUID)
    # a second tells it to some 0.03 %, on any machine far from what is asked
    advice = advise(scene, "temperature=0.002%", calibration_seconds=1, cores=64)
    assert 1 < advice.repeats <= 64
    assert advice.scene.duration >= advice.calibration.sampled


def test_a_calibration_without_an_error_says_so() -> None:
    scene = make_scene("channel", colloids=1, gravity=0, length=20)
    with pytest.raises(RunError, match=r"diffusion .*: the calibration is too short"):
        advise(scene, "diffusion=2%", engine="mpc", calibration_seconds=0.2)
    with pytest.raises(SceneError, match="does not tell difusion"):
        advise(scene, "difusion=2%")


def test_the_command(command: Run) -> None:
    fields = [word for name, value in FLUID.items() for word in ("--set", f"{name}={value}")]
    wish = ("--quantity", "temperature", "--error", "0.2%", "--calibration", "1")
    done = command("narrows", "advise", "bulk", *fields, *wish)
    assert "no setting of bulk was measured for temperature" in done.stderr
    assert "| engine | mpc |" in done.stdout
    last = done.stdout.splitlines()[-1]
    assert last.startswith("narrows ")
    assert "--until temperature=0.2%" in last
    assert "--set length=8.0" in last


@pytest.mark.statistics
def test_advised_runs_have_the_error_promised(tmp_path: Path) -> None:
    """20 runs of the advised length, as they are, without `--until`."""
    fields = {"length": 10, "width": 10, "equilibration": 30}
    scene = make_scene("poiseuille", **fields)
    advice = advise(scene, "viscosity_curvature=2%", calibration_seconds=5, cores=1)
    values = []
    for seed in range(11, 31):
        again = make_scene("poiseuille", **(advice.scene.model_dump() | {"seed": seed}))
        found = run_until(again, ["viscosity_curvature=100"], tmp_path / str(seed), longest=1e6)
        values.append(found["viscosity_curvature"].number)
    spread = np.std(values, ddof=1) / np.mean(values)
    assert spread < 0.02 * (1 + 3 / math.sqrt(2 * 19))
    assert spread > 0.005  # nor much longer than needed

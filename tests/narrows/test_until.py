"""Runs and sweeps that end when they are precise."""

from pathlib import Path

import pytest

from analysis import RunDirectory
from lammps_inputs import Scene, SceneError, make_scene
from narrows.until import Look, precisions_of, run_until, sweep_until
from srd_driver import RunError, Simulation, sweep_definition
from tests.conftest import Run

FIELDS = {"length": 8, "width": 8, "shear_wave": 0, "density": 5, "equilibration": 2}
PRECISE = "temperature=0.2%"


def fluid(duration: float = 10.0, seed: int = 1) -> Scene:
    return make_scene("bulk", **FIELDS, duration=duration, seed=seed)


def test_a_run_ends_at_the_precision(tmp_path: Path) -> None:
    looks: list[Look] = []
    found = run_until(fluid(), [PRECISE], tmp_path / "run", report=looks.append)["temperature"]
    assert found.standard_error <= 0.002 * found.number
    assert found.reason is None
    run = RunDirectory(tmp_path / "run")
    assert run.finished()
    assert [look.next_duration is None for look in looks] == [False] * (len(looks) - 1) + [True]
    assert len(looks) > 1
    assert run.manifest.fields["duration"] == looks[-1].duration
    # it is the run of that duration, to the last byte
    with Simulation(fluid(looks[-1].duration), directory=tmp_path / "whole") as whole:
        whole.finish()
    for file in ("observables.dat", "fluid_profile.dat"):
        assert (tmp_path / "run" / file).read_bytes() == (tmp_path / "whole" / file).read_bytes()


def test_a_stopped_one_goes_on(tmp_path: Path) -> None:
    def stop(simulation: Simulation) -> None:
        simulation.stop()
        simulation.finish()

    with pytest.raises(KeyboardInterrupt, match="--resume"):
        run_until(fluid(), [PRECISE], tmp_path, finish=stop)
    found = run_until(fluid(), [PRECISE], tmp_path, resume=True)
    assert found["temperature"].standard_error <= 0.002


def test_the_longest_time_ends_it(tmp_path: Path) -> None:
    with pytest.raises(RunError, match=r"after 15 t0, the longest time, temperature = .* asked"):
        run_until(fluid(), ["temperature=0.001%"], tmp_path, longest=15)
    assert RunDirectory(tmp_path).manifest.fields["duration"] == 15
    assert RunDirectory(tmp_path).finished()


def test_bad_wishes_are_told_before_anything_runs(tmp_path: Path) -> None:
    with pytest.raises(SceneError) as error:
        precisions_of(["speed=2%", "temperature"], fluid())
    speed, form = error.value.problems
    assert speed.startswith("until = 'speed=2%': bulk does not tell speed; must be one of temp")
    assert form.startswith("until = 'temperature': must have the form")
    with pytest.raises(SceneError, match=r"^longest = 5\.0: must be at least the duration, 10 t0"):
        run_until(fluid(), [PRECISE], tmp_path / "none", longest=5.0)
    assert not (tmp_path / "none").exists()


def test_of_a_sweep_each_point_gets_the_time_it_needs(tmp_path: Path) -> None:
    fields = FIELDS | {"duration": 10.0}
    over = {"density": [3, 20]}
    plan = sweep_definition.plan(tmp_path, "bulk", fields, over, repeats=2)
    done = sweep_until(plan, [PRECISE], jobs=2)
    assert not done.failures
    assert not done.missed
    durations = [
        {RunDirectory(tmp_path / name).manifest.fields["duration"] for name in point.runs}
        for point in done.table.points
    ]
    assert [len(each) for each in durations] == [1, 1]  # all repeats alike
    assert max(durations[0]) > max(durations[1])
    for point in done.table.points:
        found = point.estimates["temperature"]
        assert found.standard_error <= 0.002 * found.number
    files = {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*.dat")}
    again = sweep_until(plan, [PRECISE], jobs=2)  # which is all there
    assert again.table.rows == done.table.rows
    assert files == {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*.dat")}


def test_the_commands(tmp_path: Path, command: Run) -> None:
    settings = [word for name, value in FIELDS.items() for word in ("--set", f"{name}={value}")]
    scene = ["bulk", *settings, "--set", "duration=10", "--until", PRECISE]
    last = command("narrows", "run", *scene, "--out", tmp_path / "run").stdout.splitlines()[-1]
    assert "t0 temperature = " in last
    assert last.endswith("0.2 % asked")
    swept = command(
        *("narrows", "sweep", *scene, "--over", "seed=1,2"),
        *("--longest", "11", "--out", tmp_path / "sweep"),
        succeed=False,
    )
    assert swept.returncode == 1
    assert "not precise at the longest time: seed=1: temperature =" in swept.stderr


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["sweep", "--until", PRECISE, "--commands", "-"], "--commands: not with --until"),
        (["run", "--longest", "5"], "longest = 5.0: only with --until"),
        (["sweep", "--longest", "5"], "longest = 5.0: only with --until"),
        (["run", "--until", "speed=1%"], "bulk does not tell speed; must be one of"),
    ],
)
def test_what_does_not_go_together(
    arguments: list[str], message: str, tmp_path: Path, command: Run
) -> None:
    name, *rest = arguments
    done = command("narrows", name, "bulk", *rest, "--out", tmp_path / "none", succeed=False)
    assert done.returncode == 2
    assert message in done.stderr
    assert not (tmp_path / "none").exists()

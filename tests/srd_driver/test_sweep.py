"""Sweeps: points and seeds, what is done and what is left, failures, status."""

import json
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lammps_inputs import Scene, SceneError, make_scene
from lammps_inputs.scenes.channel import Channel
from run_files import RunDirectoryError
from run_files.progress import read_failure, write_failure
from srd_driver import RunError, Simulation, sweep_definition
from srd_driver.status import status_of, stored_run
from srd_driver.sweep import Advance, Run, is_finished, run_all
from tests.dumps import frames

TINY: dict[str, Any] = {
    "length": 20.0,
    "colloids": 1,
    "duration": 0.6,
    "equilibration": 0.0,
    "sampling_interval": 0.15,
}


def tiny(**fields: Any) -> Scene:
    return make_scene("channel", **(TINY | fields))


def plan(
    directory: Path, over: dict[str, list[Any]], repeats: int = 1, **fields: Any
) -> sweep_definition.Sweep:
    return sweep_definition.plan(directory, "channel", TINY | fields, over, repeats, "srd")


def channel_of(run: Run) -> Channel:
    assert isinstance(run.scene, Channel)
    return run.scene


def test_points_are_the_product_and_repeats_count_the_seed_up(tmp_path: Path) -> None:
    found = plan(tmp_path, {"gravity": [0.1, 1], "hydrodynamics": ["on"]}, repeats=2, seed=7)
    assert {run.folder.name: (channel_of(run).gravity, run.scene.seed) for run in found.runs} == {
        "gravity=0.1,hydrodynamics=on,seed=7": (0.1, 7),
        "gravity=0.1,hydrodynamics=on,seed=8": (0.1, 8),
        "gravity=1,hydrodynamics=on,seed=7": (1.0, 7),
        "gravity=1,hydrodynamics=on,seed=8": (1.0, 8),
    }
    assert all(run.folder.parent == tmp_path for run in found.runs)
    assert {channel_of(run).length for run in found.runs} == {20.0}
    seeds = plan(tmp_path, {"seed": [3, 5]})
    assert [run.folder.name for run in seeds.runs] == ["seed=3", "seed=5"]
    assert [run.folder.name for run in plan(tmp_path, {}).runs] == ["seed=1"]


@pytest.mark.parametrize(
    ("over", "repeats", "fields", "problems"),
    [
        (
            {"gravity": [0.1, "x"], "width": [10, 12]},
            1,
            {},
            ["point gravity=x,width=10 and 1 more: gravity = 'x': should be a valid number"],
        ),
        (
            {"width": [3]},
            3,
            {},
            ["point width=3: width = 3.0: colloids", "point width=3: wall_"],
        ),
        (
            {"gravity": [1, 2]},
            1,
            {"angle": 120},
            ["point gravity=1 and 1 more: angle = 120.0"],
        ),
        ({"speed": [1]}, 1, {}, ["point speed=1: speed = 1: unknown field; channel has duration"]),
        ({"gravity": [0.1, 0.10]}, 1, {}, ["point gravity=0.1: given twice"]),
        ({"seed": [1, 2]}, 2, {}, ["repeats = 2: must be 1 where the seed is swept"]),
        ({}, 2, {"seed": 2**31 - 1}, ["every point: seed = 2147483648: should be less than 21474"]),
    ],
)
def test_bad_points_are_named(
    over: dict[str, list[Any]],
    repeats: int,
    fields: dict[str, Any],
    problems: list[str],
    tmp_path: Path,
) -> None:
    with pytest.raises(SceneError) as error:
        plan(tmp_path, over, repeats, **fields)
    assert len(error.value.problems) == len(problems)
    for problem, start in zip(error.value.problems, problems, strict=True):
        assert problem.startswith(start)
        assert "\n" not in problem


def test_a_sweep_is_extended_but_not_mixed_with_another(tmp_path: Path) -> None:
    first = sweep_definition.store(plan(tmp_path / "s", {"gravity": [0.1]}))
    assert sweep_definition.read(tmp_path / "s") == first
    more = sweep_definition.store(plan(tmp_path / "s", {"gravity": [0.2, 0.1]}, repeats=2))
    assert [run.folder.name for run in more.runs] == [
        *("gravity=0.1,seed=1", "gravity=0.2,seed=1"),
        *("gravity=0.2,seed=2", "gravity=0.1,seed=2"),
    ]
    assert sweep_definition.read(tmp_path / "s") == more
    with Simulation(first.runs[0].scene, "srd", first.runs[0].folder) as simulation:
        simulation.run(0.15)
    before = (tmp_path / "s" / "sweep.json").read_bytes()
    with pytest.raises(RunError, match=r"gravity=0\.1,seed=1 holds another scene: density = 10\.0"):
        sweep_definition.store(plan(tmp_path / "s", {"gravity": [0.1, 0.3]}, density=5))
    bulk = sweep_definition.plan(tmp_path / "s", "bulk", {}, {"angle": [120]}, 1, "reference")
    with pytest.raises(RunError, match="a sweep of channel by the engine srd, not of bulk by refe"):
        sweep_definition.store(bulk)
    assert (tmp_path / "s" / "sweep.json").read_bytes() == before
    with pytest.raises(RunError, match="is not empty and holds no sweep"):
        sweep_definition.store(plan(first.runs[0].folder, {"gravity": [0.1]}))


def test_a_broken_definition_is_named(tmp_path: Path) -> None:
    with pytest.raises(RunDirectoryError, match=r"holds no sweep: it has no sweep\.json"):
        sweep_definition.read(tmp_path)
    (tmp_path / "sweep.json").write_text('{"scene": "channel", "engine": "srd"}')
    with pytest.raises(RunDirectoryError, match=r"sweep\.json: over: Field required"):
        sweep_definition.read(tmp_path)


def test_runs_are_done_once_and_one_that_fails_stops_no_other(tmp_path: Path) -> None:
    good = [Run(tmp_path / f"seed={seed}", tiny(seed=seed), "srd") for seed in (1, 2)]
    nothing_keeps_it_in = {"wall_strength": 0, "width": 2, "wall_sigma": 1, "colloid_radius": 0.3}
    bad = Run(tmp_path / "bad", tiny(density=3, duration=30, **nothing_keeps_it_in), "srd")
    told: list[Advance] = []
    (failure,) = run_all([bad, *good, good[0]], 2, told.append)
    assert failure.run == bad
    assert "LAMMPS: ERROR: Lost atoms" in failure.message
    assert failure.message.endswith(f"(its output: {tmp_path / 'bad.log'})")
    assert "Lost atoms" in (tmp_path / "bad.log").read_text()
    assert status_of(bad).state == "failed"
    assert [is_finished(run) for run in [bad, *good]] == [False, True, True]
    assert (told[-1].finished, told[-1].failed, told[-1].running, told[-1].runs) == (2, 1, 0, 3)
    works = [run.scene.system.work for run in (*good, bad)]
    assert sum(works[:2]) / sum(works) <= told[-1].work < 1  # what the failed run wrote counts
    assert sorted(path.name for path in tmp_path.glob("*.log")) == ["bad.log"]

    written = {path: path.stat().st_mtime_ns for run in good for path in run.folder.iterdir()}
    assert run_all(good, 2) == []
    assert {path: path.stat().st_mtime_ns for path in written} == written

    longer = Run(good[0].folder, tiny(duration=0.9), "srd")
    assert not is_finished(longer)
    assert run_all([longer], 1) == []
    assert list(frames(longer.folder / "trajectory.lammpsdump")) == list(range(0, 901, 150))


def test_a_directory_of_another_scene_is_refused_before_anything_runs(tmp_path: Path) -> None:
    with Simulation(tiny(), "reference", tmp_path / "there") as simulation:
        simulation.run(0.15)
    runs = [
        Run(tmp_path / "new", tiny(), "reference"),
        Run(tmp_path / "there", tiny(density=5), "reference"),
    ]
    with pytest.raises(RunError, match=r"there holds another scene: density = 10\.0 there"):
        run_all(runs, 1)
    assert not (tmp_path / "new").exists()


def test_a_run_that_another_process_has_taken_up_is_waited_for(tmp_path: Path) -> None:
    run = Run(tmp_path / "run", tiny(), "reference")
    with Simulation(run.scene, "reference", run.folder) as simulation:
        simulation.run(0.15)
        failures: list[Any] = []
        waiter = threading.Thread(target=lambda: failures.extend(run_all([run], 1)))
        waiter.start()
        waiter.join(1.0)
        assert waiter.is_alive()
        with pytest.raises(RunError, match=r"is being run by process \d+ on "):
            Simulation(run.scene, "reference", run.folder, resume=True)
        simulation.finish()
    waiter.join(120.0)
    assert not waiter.is_alive()
    assert failures == []
    steps = np.loadtxt(run.folder / "observables.dat")[:, 0]
    np.testing.assert_array_equal(steps, [150, 300, 450, 600])


def test_a_run_killed_while_it_was_made_is_made_again(tmp_path: Path) -> None:
    run = Run(tmp_path / "run", tiny(), "reference")
    run.folder.mkdir()
    (run.folder / ".lock").write_text("process 1 on nowhere")
    (run.folder / "scene.toml").write_text('scene = "chan')
    assert status_of(run).state == "waiting"
    assert run_all([run], 1) == []
    assert is_finished(run)


def test_stop_leaves_a_checkpoint(tmp_path: Path) -> None:
    with Simulation(tiny(duration=60), "srd", tmp_path / "run") as simulation:
        simulation.finish(lambda now: now.stop() if now.time > 0.2 else None)
        assert 0 < simulation.time < 60
        assert not simulation.finished
        step = simulation.step
    assert json.loads((tmp_path / "run" / "progress.json").read_text())["step"] == step


def test_status_tells_all_states(tmp_path: Path) -> None:
    runs = {
        name: Run(tmp_path / name, tiny(), "reference")
        for name in ("new", "half", "failed", "running", "finished")
    }
    assert status_of(runs["new"]).state == "waiting"
    assert status_of(runs["new"]).end == pytest.approx(0.6)
    for name in ("half", "failed", "finished"):
        with Simulation(tiny(), "reference", tmp_path / name) as simulation:
            simulation.run(0.3 if name != "finished" else 0.6)
    write_failure(tmp_path / "failed", "no room")
    half, failed = status_of(runs["half"]), status_of(runs["failed"])
    assert (half.state, half.failure) == ("stopped", None)
    assert half.time == pytest.approx(0.3)
    assert (failed.state, failed.failure) == ("failed", "no room")
    finished = status_of(runs["finished"])
    assert finished.state == "finished"
    assert finished.time == pytest.approx(0.6)
    assert finished.speed is not None
    assert finished.speed > 0
    assert status_of(stored_run(tmp_path / "finished")) == finished
    longer = Run(tmp_path / "finished", tiny(duration=1.2), "reference")
    assert status_of(longer).state == "stopped"
    with Simulation(tiny(), "reference", tmp_path / "running") as simulation:
        assert status_of(runs["running"]).state == "running"
        session = simulation._session
        assert session is not None
        session.advance(150)  # output beyond the newest checkpoint
        running = status_of(runs["running"])
        assert running.time == pytest.approx(0.15)
        assert running.speed is None
    with Simulation(tiny(), "reference", tmp_path / "failed", resume=True):
        assert read_failure(tmp_path / "failed") is None

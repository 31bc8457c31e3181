"""Running from Python: sessions, views, checkpoints, and a run directory that survives."""

import json
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import lammps_plugin
from lammps_inputs import Scene, initial_state, make_scene
from lammps_inputs.manifest import manifest
from run_files.manifest import read_manifest
from srd_driver import RunError, Simulation
from srd_driver.resume import reopen, write_scene
from tests.dumps import frames
from tests.parts import solvent_of

needs_plugin = pytest.mark.skipif(not lammps_plugin.folder(), reason="the plugin is not built")
ENGINES = ["srd", pytest.param("mpc", marks=needs_plugin), "reference"]
SHORT: dict[str, Any] = {"duration": 1.2, "equilibration": 0.0, "sampling_interval": 0.15}


def channel(**fields: Any) -> Scene:
    return make_scene("channel", **(SHORT | fields))


def table(directory: Path, name: str = "observables.dat") -> Any:
    return np.loadtxt(directory / name)


def data_lines(file: Path) -> list[str]:
    """Without comments: LAMMPS writes the heading of a table again when it goes on."""
    return [line for line in file.read_text().splitlines() if not line.startswith("#")]


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("name", ["channel", "poiseuille", "bulk"])
def test_every_scene_leaves_a_complete_run_directory(
    engine: str, name: str, tmp_path: Path
) -> None:
    scene = make_scene(name, duration=1.0, equilibration=0.5, sampling_interval=0.3)
    directory = tmp_path / "run"
    with Simulation(scene, engine, directory) as run:
        run.finish()
        assert run.finished
        steps = run.step
    told = read_manifest(directory)
    clock = told.system.clock
    assert clock.total_steps == steps
    assert told.engine == engine
    assert clock.equilibration_steps * clock.time_step == pytest.approx(0.5, abs=0.05)
    assert told.fields["seed"] == 1
    progress = json.loads((directory / "progress.json").read_text())
    assert progress["finished"]
    assert progress["step"] == steps
    assert progress["wall_seconds"] > 0
    assert (directory / progress["checkpoint"]).exists()
    outputs = np.arange(clock.sample_steps, steps + 1, clock.sample_steps)
    np.testing.assert_array_equal(table(directory)[:, 0], outputs)
    labels = [
        int(line.split()[0])
        for line in (directory / "fluid_profile.dat").read_text().splitlines()
        if not line.startswith(("#", " "))
    ]
    np.testing.assert_array_equal(labels, outputs)
    if scene.system.species:
        assert list(frames(directory / "trajectory.lammpsdump")) == [0, *outputs]
    else:
        assert not (directory / "trajectory.lammpsdump").exists()


@pytest.mark.parametrize("engine", ENGINES)
def test_engines_start_from_the_same_state_and_write_the_same_columns(
    engine: str, tmp_path: Path
) -> None:
    scene = channel()
    with Simulation(scene, engine, tmp_path) as run:
        run.run(0.15)
    first = frames(tmp_path / "trajectory.lammpsdump")[0]
    state = initial_state(scene.system, scene.seed)
    np.testing.assert_allclose(first[:, 2:4], state.colloid_positions, rtol=1e-9)
    np.testing.assert_allclose(first[:, 5:7], state.colloid_velocities, rtol=1e-9)
    assert (tmp_path / "observables.dat").read_text().splitlines()[1] == (
        "# TimeStep v_fluid_temperature v_mean_velocity_x"
    )
    profile = (tmp_path / "fluid_profile.dat").read_text().splitlines()
    assert profile[2] == "# Chunk Coord1 Ncount density/number vx temp"
    step, bins, count = profile[3].split()
    assert (int(step), int(bins)) == (150, 20)
    assert float(count) == pytest.approx(solvent_of(scene).particles)
    rows = np.loadtxt(profile[4:24])
    np.testing.assert_allclose(rows[:, 1], np.arange(20) / 2 + 0.25)
    np.testing.assert_allclose(rows[:, 3], rows[:, 2] / (40 * 0.5), rtol=1e-4)


@pytest.mark.parametrize("engine", ENGINES)
def test_views_look_into_the_engine(engine: str) -> None:
    with Simulation(channel(), engine) as run:
        run.run(0.15)
        positions, velocities = run.colloid_positions, run.colloid_velocities
        assert positions.shape == velocities.shape == (3, 2)
        before = run.mean_colloid_position()
        velocities[:, 0] = 10.0
        run.run(0.15)
        # the fluid takes some of it, but not most of it in so short a time
        assert 0.5 < run.mean_colloid_position() - before < 1.5
        directory = run.directory
        assert directory.exists()
    assert not directory.exists()


def test_time_runs_in_whole_sampling_intervals() -> None:
    with Simulation(channel(), "reference") as run:
        run.run(0.2)
        assert run.time == pytest.approx(0.15)
        run.run(0.001)
        assert run.time == pytest.approx(0.3)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_kill_while_a_run_is_taken_up_does_no_harm(engine: str, tmp_path: Path) -> None:
    """Once the outputs are cut, and before the engine writes the frame of the checkpoint again."""
    scene = channel(length=20, colloids=1)
    with Simulation(scene, engine, tmp_path) as run:
        run.run(0.6)
    for _ in range(2):
        reopen(scene, engine, tmp_path, 1)
    with Simulation(scene, engine, tmp_path, resume=True) as run:
        run.finish()
    assert list(frames(tmp_path / "trajectory.lammpsdump")) == list(range(0, 1201, 150))


@pytest.mark.parametrize("engine", ENGINES)
def test_resume_goes_on_without_a_gap(engine: str, tmp_path: Path) -> None:
    scene = channel()
    with Simulation(scene, engine, tmp_path / "whole") as run:
        run.finish()
    with Simulation(scene, engine, tmp_path / "parts", checkpoint_interval=0.3) as run:
        run.run(0.75)  # two checkpoints on the way, at 0.3 and 0.6, one at the end
    broken = tmp_path / "parts" / "trajectory.lammpsdump"
    broken.write_text(broken.read_text() + "ITEM: TIMESTEP\n900\nITEM: NUM")  # a kill amid a frame
    with Simulation(scene, engine, tmp_path / "parts", resume=True) as run:
        assert run.time == pytest.approx(0.75)
        run.finish()
    whole = frames(tmp_path / "whole" / "trajectory.lammpsdump")
    parts = frames(tmp_path / "parts" / "trajectory.lammpsdump")
    assert list(whole) == list(parts)
    np.testing.assert_array_equal(table(tmp_path / "whole")[:, 0], table(tmp_path / "parts")[:, 0])
    if engine != "srd":  # exact
        for name in ("trajectory.lammpsdump", "observables.dat", "fluid_profile.dat"):
            assert data_lines(tmp_path / "whole" / name) == data_lines(tmp_path / "parts" / name)
    else:  # the state is exact, what follows has other random numbers
        np.testing.assert_allclose(parts[750], whole[750], rtol=1e-6, atol=1e-6)
        assert abs(parts[1200][:, 2:4] - whole[1200][:, 2:4]).max() > 1e-6


@pytest.mark.parametrize("engine", ENGINES)
def test_a_checkpoint_may_be_made_at_any_time(engine: str, tmp_path: Path) -> None:
    with Simulation(channel(), engine, tmp_path) as run:
        run.run(0.45)
        run.checkpoint()
        run.run(0.15)
    with Simulation(channel(), engine, tmp_path, resume=True) as run:
        assert run.time == pytest.approx(0.6)
    (checkpoint,) = tmp_path.glob("checkpoint.*")
    assert checkpoint.name.startswith("checkpoint.600.")


def test_a_checkpoint_that_a_kill_left_half_written_is_not_taken(tmp_path: Path) -> None:
    with Simulation(channel(), "srd", tmp_path) as run:
        run.run(0.3)
    (tmp_path / "checkpoint.600.restart").write_bytes(b"half")
    with Simulation(channel(), "srd", tmp_path, resume=True) as run:
        run.run(0.3)  # ends, with a checkpoint, at the step of the broken file
    with Simulation(channel(), "srd", tmp_path, resume=True) as run:
        run.finish()


def test_a_finished_run_can_be_made_longer(tmp_path: Path) -> None:
    with Simulation(channel(), "reference", tmp_path) as run:
        run.finish()
    before = (tmp_path / "trajectory.lammpsdump").read_text()
    with Simulation(channel(), "reference", tmp_path, resume=True) as run:
        assert run.finished
        with pytest.raises(RunError, match="is finished"):
            run.run(1.0)
    assert (tmp_path / "trajectory.lammpsdump").read_text() == before
    longer = channel(duration=1.5)
    with Simulation(longer, "reference", tmp_path, resume=True) as run:
        run.finish()
    assert list(frames(tmp_path / "trajectory.lammpsdump")) == list(range(0, 1501, 150))
    assert read_manifest(tmp_path).system.clock.total_steps == 1500


def test_a_used_directory_is_refused(tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("mine")
    with pytest.raises(RunError, match="is not empty: go on with its run by --resume"):
        Simulation(channel(), "srd", tmp_path)
    with pytest.raises(RunError, match=r"is not a run directory: it has no manifest\.json"):
        Simulation(channel(), "srd", tmp_path, resume=True)
    assert (tmp_path / "notes.txt").read_text() == "mine"


def test_another_scene_or_engine_is_not_resumed(tmp_path: Path) -> None:
    with Simulation(channel(), "reference", tmp_path) as run:
        run.run(0.15)
    with pytest.raises(RunError, match=r"another scene: gravity = 0\.1 there, 0\.2 here"):
        Simulation(channel(gravity=0.2), "reference", tmp_path, resume=True)
    with pytest.raises(RunError, match="holds another scene than bulk"):
        Simulation(make_scene("bulk"), "reference", tmp_path, resume=True)
    with pytest.raises(RunError, match="run by the engine reference, not srd"):
        Simulation(channel(), "srd", tmp_path, resume=True)
    (checkpoint,) = tmp_path.glob("checkpoint.*")
    checkpoint.unlink()
    with pytest.raises(RunError, match=r"its checkpoint checkpoint\.150\.npz is missing"):
        Simulation(channel(), "reference", tmp_path, resume=True)


def test_without_the_plugin_a_run_says_what_is_missing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(lammps_plugin, "folder", lambda: "")
    with pytest.raises(RunError, match=r"engine mpc needs .* was not built .* or use --engine srd"):
        Simulation(channel(), directory=tmp_path / "run")
    assert not (tmp_path / "run").exists()


def test_a_lammps_error_says_where_and_how_to_go_on(tmp_path: Path) -> None:
    with Simulation(channel(), "srd", tmp_path, checkpoint_interval=0.3) as run:
        run.run(0.3)
        run.colloid_positions[0] = run.colloid_positions[1] + 0.01  # breaks the integration
        run.colloid_velocities[2] = 1e6
        with pytest.raises(RunError, match="LAMMPS: ERROR") as error:
            run.run(0.9)
    assert "stopped after step 300" in str(error.value)
    assert "nothing written before time 0.3 is lost, go on from there by --resume" in str(
        error.value
    )
    with Simulation(channel(), "srd", tmp_path, resume=True) as run:
        run.finish()
    assert list(frames(tmp_path / "trajectory.lammpsdump")) == list(range(0, 1201, 150))


def test_a_missing_mpi_library_is_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    import sys

    monkeypatch.setitem(sys.modules, "mpi4py", None)
    with pytest.raises(RunError, match="no MPI library, which LAMMPS needs"):
        Simulation(channel(), "srd", tmp_path / "run")
    assert not (tmp_path / "run").exists()


def test_a_full_disk_is_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    with Simulation(channel(), "reference", tmp_path) as run:
        run.run(0.15)
        full = shutil.disk_usage(tmp_path)._replace(free=0)
        monkeypatch.setattr(shutil, "disk_usage", lambda _: full)

        def no_space(*_: object) -> None:
            raise OSError(28, "No space left on device")

        monkeypatch.setattr(run._session, "_write_frame", no_space)
        with pytest.raises(RunError, match=r"the disk is full .*No space left on device"):
            run.run(0.15)


def test_manifest_tells_analysis_all_it_needs(tmp_path: Path) -> None:
    scene = channel(equilibration=0.6)
    write_scene(scene, "srd", tmp_path)
    told = read_manifest(tmp_path)
    clock = told.system.clock
    assert clock.steps_per_collision == 15
    assert clock.equilibration_steps == 600
    assert clock.sample_steps // clock.look_steps == 2  # 10 collisions, looked at after 5 and 10
    (colloids,) = told.system.species
    assert colloids.mass == pytest.approx(125.664, abs=1e-3)
    assert told.system.box.periodic == (True, False)
    assert told.system.solvent is not None
    assert told.system.solvent.viscosity_theory == pytest.approx(5.0, abs=0.01)
    assert [drive.target for drive in told.system.drives] == ["colloids"]
    assert told.system.measures == scene.system.measures
    assert told.versions["lammps"]
    assert json.dumps(manifest(scene, "srd"), allow_nan=False)


@pytest.mark.parametrize(
    "fields", [{"hydrodynamics": "bath"}, {"hydrodynamics": "shuffle"}, {"angle": 180}]
)
def test_a_fluid_without_kinetic_theory_has_none(fields: dict[str, Any]) -> None:
    told = manifest(channel(**fields), "reference")
    assert told["system"]["solvent"]["viscosity_theory"] is None

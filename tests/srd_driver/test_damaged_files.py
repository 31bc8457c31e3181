"""Damage is refused in one line before anything goes on from it, or is analysed."""

import json
import random
import shutil
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

import lammps_plugin
from analysis import RunDirectory, analyze
from lammps_inputs import Scene, make_scene
from narrows.cli import app
from run_files import RunDirectoryError
from srd_driver import Simulation, sweep_definition
from srd_driver.status import status_of, stored_run
from srd_driver.sweep import run_all

needs_plugin = pytest.mark.skipif(not lammps_plugin.folder(), reason="the plugin is not built")
ENGINES = ["srd", pytest.param("mpc", marks=needs_plugin), "reference"]
OUTPUTS = ("trajectory.lammpsdump", "observables.dat", "fluid_profile.dat")
FLIPS = 40
HUGE = "1" + 5000 * "0"


def scene(seed: int = 1) -> Scene:
    short: dict[str, Any] = {"duration": 1.2, "equilibration": 0.0, "sampling_interval": 0.15}
    return make_scene("channel", seed=seed, **short)


def half_way(directory: Path, engine: str, seed: int = 1) -> Path:
    with Simulation(scene(seed), engine, directory, checkpoint_interval=0.3) as run:
        run.run(0.6)
    return directory


def refused(directory: Path, engine: str) -> str:
    with pytest.raises(RunDirectoryError) as error:
        Simulation(scene(), engine, directory, resume=True)
    assert "\n" not in str(error.value)
    return str(error.value)


def flip(file: Path, byte: int, bit: int) -> None:
    content = bytearray(file.read_bytes())
    content[byte] ^= 1 << bit
    file.write_bytes(content)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_flipped_bit_of_a_checkpoint_is_refused(engine: str, tmp_path: Path) -> None:
    directory = half_way(tmp_path / "run", engine)
    file = next(directory.glob("checkpoint.*"))
    whole = file.read_bytes()
    chance = random.Random(10)
    for _ in range(FLIPS):
        flip(file, chance.randrange(len(whole)), chance.randrange(8))
        assert f"{file.name}: damaged" in refused(directory, engine)
        file.write_bytes(whole)
    for damaged in (b"", whole[:-1], whole + b"x", whole[:1000]):
        file.write_bytes(damaged)
        assert f"its run left {len(whole)}" in refused(directory, engine)
    file.write_bytes(whole)
    with Simulation(scene(), engine, directory, resume=True) as run:
        run.finish()


@pytest.mark.parametrize("engine", ENGINES)
def test_a_checkpoint_of_another_seed_is_refused(engine: str, tmp_path: Path) -> None:
    directory = half_way(tmp_path / "run", engine)
    other = half_way(tmp_path / "other", engine, seed=2)
    checkpoint = next(other.glob("checkpoint.*"))
    shutil.copy(checkpoint, directory)
    assert "checkpoint" in refused(directory, engine)
    shutil.copy(other / "progress.json", directory)
    assert "progress.json: of another run" in refused(directory, engine)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("output", OUTPUTS)
def test_outputs_are_looked_at_when_a_run_goes_on(output: str, engine: str, tmp_path: Path) -> None:
    directory = half_way(tmp_path / "run", engine)
    file = directory / output
    whole = file.read_bytes()
    flip(file, len(whole) // 2, 0)
    assert f"{output}: damaged" in refused(directory, engine)
    for damaged in (b"", whole[:-1], whole[: len(whole) // 2]):
        file.write_bytes(damaged)
        assert output in refused(directory, engine)
    file.unlink()
    assert f"{output}: missing" in refused(directory, engine)


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    directory = tmp_path_factory.mktemp("finished") / "run"
    with Simulation(scene(), "reference", directory) as run:
        run.finish()
    return directory


def cut_rows(text: str, rows: int) -> str:
    return "".join(text.splitlines(keepends=True)[:-rows])


@pytest.mark.parametrize("driven", [True, False], ids=["driven", "by hand"])
@pytest.mark.parametrize(("output", "rows"), [*zip(OUTPUTS, (12, 1, 21), strict=True)])
def test_a_finished_run_of_which_an_end_is_missing_is_not_analysed(
    output: str, rows: int, driven: bool, finished: Path, tmp_path: Path
) -> None:
    directory = tmp_path / "run"
    shutil.copytree(finished, directory)
    if not driven:
        (directory / "progress.json").unlink()
    analyze(directory)
    file = directory / output
    file.write_text(cut_rows(file.read_text(), rows))
    if driven or output != "observables.dat":
        with pytest.raises(RunDirectoryError, match=output):
            analyze(directory)
    else:  # the table alone tells how far a deck came: the others then go too far by one
        assert not analyze(directory)["finished"]
    file.write_text(cut_rows(file.read_text(), 2 * rows))
    with pytest.raises(RunDirectoryError):
        analyze(directory)


@pytest.mark.parametrize(
    ("path", "value", "complaint"),
    [
        (["system", "species", 0, "count"], 5, "3 particles; the manifest says 5"),
        (["system", "box", "sizes"], [40.0, -10.0], "greater than 0"),
        (["system", "box", "sizes"], [41.0, 10.0], "a box edge of 40; the manifest says 41"),
        (["fields", "width"], -1.0, "width = -1.0, but 10.0 in scene.toml"),
        (["scene"], "nonesuch", "scene = 'nonesuch', but 'channel' in scene.toml"),
        (["system", "drives", 0, "target"], "others", "others: no such species"),
        (["system", "clock", "total_steps"], 600, "ends at step 1200; the run is at step 600"),
        (["system", "clock", "total_steps"], HUGE, "manifest.json: "),
        (["system", "measures"], ["nonesuch"], "measure nonesuch"),
        (["system", "outputs", 0, "file"], "../victim", "outputs.0.file"),
    ],
)
def test_a_manifest_that_contradicts_its_directory_is_refused(
    path: list[Any], value: Any, complaint: str, finished: Path, tmp_path: Path
) -> None:
    directory = tmp_path / "run"
    shutil.copytree(finished, directory)
    file = directory / "manifest.json"
    content = json.loads(file.read_text())
    del content["digest"]
    entry = content
    for key in path[:-1]:
        entry = entry[key]
    entry[path[-1]] = value
    text = json.dumps(content).replace(f'"{HUGE}"', HUGE)
    file.write_text(text)
    with pytest.raises(RunDirectoryError) as error:
        analyze(directory)
    assert complaint in str(error.value)
    assert "\n" not in str(error.value)


def test_a_run_of_narrows_0_1_goes_on(tmp_path: Path) -> None:
    """Its progress.json had no checksums."""
    directory = half_way(tmp_path / "run", "reference")
    file = directory / "progress.json"
    content = json.loads(file.read_text())
    for new in ("format", "run", "checksums", "digest"):
        del content[new]
    file.write_text(json.dumps(content))
    with Simulation(scene(), "reference", directory, resume=True) as run:
        run.finish()
    assert RunDirectory(directory).finished()


def test_the_status_of_a_deck_is_that_of_its_outputs(finished: Path, tmp_path: Path) -> None:
    directory = tmp_path / "run"
    shutil.copytree(finished, directory)
    (directory / "progress.json").unlink()
    (directory / ".lock").unlink()  # as lmp leaves it
    assert status_of(stored_run(directory)).state == "finished"
    for name in OUTPUTS[1:]:
        file = directory / name
        file.write_text(cut_rows(file.read_text(), 1 if name == "observables.dat" else 21))
    found = status_of(stored_run(directory))
    assert found.state == "by hand"
    assert found.time == pytest.approx(1.05)
    for name in OUTPUTS:
        (directory / name).unlink()
    assert status_of(stored_run(directory)).state == "waiting"


def test_a_damaged_run_hides_no_other(tmp_path: Path) -> None:
    plan = sweep_definition.plan(
        tmp_path / "s", "channel", scene().model_dump() | {"duration": 0.3}, {}, 3, "reference"
    )
    sweep_definition.store(plan)
    assert run_all(plan.runs[:1], 1) == []
    (plan.runs[0].folder / "progress.json").write_bytes(b"\xff")
    sweep_definition.store(plan)
    failures = run_all(plan.runs, 2)
    assert [failure.run for failure in failures] == [plan.runs[0]]
    assert "progress.json" in failures[0].message
    told = CliRunner().invoke(app, ["status", str(tmp_path / "s")]).stdout.splitlines()
    assert [line.split()[1] for line in told[:3]] == ["failed", "finished", "finished"]


@pytest.mark.parametrize("thermostat", ["rescale", "none", "layer"])
def test_a_fluid_without_motion_about_its_mean_has_no_temperature(
    thermostat: str, tmp_path: Path
) -> None:
    """Four particles, often each alone in its bin: the table must hold numbers."""
    few = {"length": 2, "width": 2, "density": 1, "thermostat": thermostat, "duration": 50.0}
    with Simulation(make_scene("bulk", **few), "reference", tmp_path) as run:
        run.finish()
    assert "nan" not in (tmp_path / "observables.dat").read_text()
    RunDirectory(tmp_path).table()

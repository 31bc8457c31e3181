"""Run directories and sweeps that somebody else wrote, or that lost a file."""

import json
import os
import shutil
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from analysis import tabulate
from lammps_inputs import Scene, all_engines, make_scene
from narrows.cli import app
from run_files import RunDirectoryError
from srd_driver import RunError, Simulation, resume, sweep_definition
from srd_driver.sweep import Run, is_finished
from tests.conftest import Run as Command

SHORT: dict[str, Any] = {"duration": 1.2, "equilibration": 0.0, "sampling_interval": 0.15}
LARGE: dict[str, Any] = {"length": 60.0, "colloids": 5}
SCENES = ["channel", "poiseuille", "bulk"]
OUTPUTS = ("trajectory.lammpsdump", "observables.dat", "fluid_profile.dat")


def channel(**fields: Any) -> Scene:
    return make_scene("channel", **(SHORT | fields))


@pytest.fixture
def half_way(tmp_path: Path) -> Path:
    """A run that has a checkpoint, and output, of time 0.3."""
    directory = tmp_path / "run"
    with Simulation(channel(**LARGE), "srd", directory) as run:
        run.run(0.3)
        run.checkpoint()
    return directory


def change(file: Path, **entries: Any) -> None:
    content = json.loads(file.read_text()) | entries
    file.write_text(json.dumps({key: content[key] for key in content if key != "digest"}))


def contents(directory: Path) -> dict[str, bytes]:
    return {file.name: file.read_bytes() for file in directory.iterdir() if file.name != ".lock"}


@pytest.mark.parametrize(
    ("entries", "complaint"),
    [
        ({"checkpoint": "checkpoint.300.restart\nshell touch ../gotcha"}, "not that of step 300"),
        ({"checkpoint": "../gotcha.restart"}, "not that of step 300"),
        ({"checkpoint": "checkpoint.300.restart remap"}, "not that of step 300"),
        ({"checkpoint": "checkpoint.450.restart"}, "not that of step 300"),
        ({"checkpoint": "checkpoint.300.npz", "format": 1}, "not one of srd"),
        ({"checkpoint": None}, "checkpoint: none of step 300"),
        ({"checkpoint": 300}, "checkpoint: should be a valid string"),
        ({"step": 150}, "not that of step 150"),
        ({"step": -1}, "step: should be greater than or equal to 0"),
        ({"wall_seconds": float("nan")}, "wall_seconds: should be a finite number"),
        ({"shell": "touch gotcha"}, "shell: Extra inputs are not permitted"),
    ],
)
def test_a_progress_that_we_do_not_write_is_refused(
    entries: dict[str, Any], complaint: str, half_way: Path
) -> None:
    change(half_way / "progress.json", **entries)
    name = entries.get("checkpoint")
    if isinstance(name, str):  # it must not be enough that there is such a file
        shutil.copy(half_way / "checkpoint.300.restart", half_way / name.replace("/", ":"))
        (half_way.parent / "gotcha.restart").touch()
    before = contents(half_way)
    with pytest.raises((RunError, RunDirectoryError)) as error:
        Simulation(channel(**LARGE), "srd", half_way, resume=True)
    assert complaint in str(error.value)
    assert "progress.json" in str(error.value)
    assert "\n" not in str(error.value)
    assert contents(half_way) == before
    assert not (half_way.parent / "gotcha").exists()


@pytest.mark.parametrize("text", [b"", b"{", b"[]", b"null", b"\xff\xfe", b'{"step": 1e400}'])
def test_a_progress_that_is_damaged_is_refused(text: bytes, half_way: Path) -> None:
    (half_way / "progress.json").write_bytes(text)
    with pytest.raises(RunDirectoryError, match=r"progress\.json"):
        Simulation(channel(**LARGE), "srd", half_way, resume=True)


@pytest.mark.parametrize("name", ["../victim", "/victim", "", ".", "..", "a\nb", "seed=1/../../v"])
def test_runs_of_a_sweep_are_folders_of_it(name: str, tmp_path: Path) -> None:
    sweep_definition.store(sweep_definition.plan(tmp_path / "s", "channel", SHORT, {}, 1, "srd"))
    definition = tmp_path / "s" / "sweep.json"
    definition.write_text(definition.read_text().replace('"seed=1"', json.dumps(name)))
    change(definition)
    before = sorted(tmp_path.rglob("*"))
    for read in (sweep_definition.read, lambda directory: tabulate(directory, 1)):
        with pytest.raises(RunDirectoryError, match="not the name of a folder") as error:
            read(tmp_path / "s")
        assert "\n" not in str(error.value)
    assert sorted(tmp_path.rglob("*")) == before


def test_all_names_that_a_sweep_writes_are_read(tmp_path: Path) -> None:
    over: dict[str, list[Any]] = {
        "gravity": [-1e-05, 0.25, 0],
        "hydrodynamics": ["on", "shuffle"],
        "thermostat": ["monte_carlo"],
        "spacing": ["none", 4.5],
    }
    sweep = sweep_definition.plan(tmp_path, "channel", {"length": 80}, over, 2, "mpc")
    assert sweep_definition.read(sweep_definition.store(sweep).directory) == sweep


@pytest.mark.parametrize("scene", [channel(**LARGE), channel(), make_scene("bulk")])
def test_data_without_progress_are_never_begun_anew(scene: Scene, half_way: Path) -> None:
    (half_way / "progress.json").unlink()
    before = contents(half_way)
    same = scene == channel(**LARGE)
    complaint = "nothing is begun over what may be data" if same else "holds another scene"
    with pytest.raises(RunError, match=complaint):
        Simulation(scene, "srd", half_way, resume=True)
    assert contents(half_way) == before


@pytest.mark.parametrize("kept", [*OUTPUTS, "log.lammps", "variables.json", "my notes"])
def test_any_file_that_is_not_of_a_new_run_is_kept(kept: str, half_made: Path) -> None:
    (half_made / kept).write_text("{}")
    before = contents(half_made)
    with pytest.raises(RunError, match=f"no progress.json but .*{kept}"):
        Simulation(channel(**LARGE), "reference", half_made, resume=True)
    assert contents(half_made) == before


@pytest.fixture
def half_made(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A directory as a kill leaves it just before progress.json is written."""

    def killed(*_: object) -> None:
        raise KeyboardInterrupt

    directory = tmp_path / "run"
    with monkeypatch.context() as patch:
        patch.setattr(resume, "write_progress", killed)
        with pytest.raises(KeyboardInterrupt):
            Simulation(channel(**LARGE), "reference", directory)
    return directory


def test_a_half_made_run_goes_on_as_itself_only(half_made: Path) -> None:
    before = contents(half_made)
    others: list[tuple[Scene, str, str]] = [
        (channel(), "reference", "length = 60.0 there, 40.0 here"),
        (channel(seed=2, **LARGE), "reference", "seed = 1 there, 2 here"),
        (channel(**LARGE), "srd", "was run by the engine reference, not srd"),
        (make_scene("bulk"), "reference", "holds another scene than bulk"),
    ]
    for scene, engine, complaint in others:
        with pytest.raises(RunError, match=complaint):
            Simulation(scene, engine, half_made, resume=True)
        with pytest.raises(RunError, match=complaint):
            is_finished(Run(half_made, scene, engine))
    assert contents(half_made) == before
    with Simulation(channel(**LARGE), "reference", half_made, resume=True) as run:
        run.finish()


def test_the_command_line_goes_on_with_the_scene_of_the_directory(
    half_made: Path, command: Command
) -> None:
    command("narrows", "run", "channel", "--resume", "--out", half_made)
    told = json.loads((half_made / "manifest.json").read_text())
    assert told["fields"] == channel(**LARGE).model_dump()
    assert told["engine"] == "reference"
    other = half_made.parent / "other"
    shutil.copytree(half_made, other)
    (other / "progress.json").unlink()
    refused = command("narrows", "run", "channel", "--resume", "--out", other, succeed=False)
    assert refused.returncode == 1
    assert "nothing is begun over what may be data" in refused.stderr
    assert refused.stderr.count("\n") == 1


def cases() -> list[Any]:
    """Each engine with each scene that it runs, whatever scenes and engines there are."""
    return [
        pytest.param(engine, name, id=f"{engine}-{name}")
        for engine, each in all_engines().items()
        for name in SCENES
        if not list(each.problems(make_scene(name).system))
    ]


@pytest.mark.parametrize(("engine", "name"), cases())
@pytest.mark.parametrize("renames", range(5))
def test_a_kill_while_the_directory_is_made_costs_nothing(
    renames: int, engine: str, name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After every so many files that took their places."""
    left = iter(range(renames))
    replace = os.replace

    def cut_short(source: Path, target: Path) -> None:
        if next(left, None) is None:
            raise KeyboardInterrupt
        replace(source, target)

    run = Run(tmp_path / "run", make_scene(name, duration=1), engine)
    with monkeypatch.context() as patch:
        patch.setattr("os.replace", cut_short)
        try:
            (tmp_path / "run").mkdir()
            resume.take(run.folder, resume=False).close()
            resume.create(run.scene, run.engine, run.folder, 1)
        except KeyboardInterrupt:
            assert not is_finished(run)
    (run.folder / resume.MAKING).mkdir(exist_ok=True)  # a kill cleans nothing up
    (run.folder / resume.MAKING / "in.lammps").write_text("half")
    if resume.is_half_made(run.folder):
        resume.take(run.folder, resume=True).close()
        resume.create(run.scene, run.engine, run.folder, 1)
    whole = tmp_path / "whole"
    whole.mkdir()
    resume.create(run.scene, run.engine, whole, 1)
    there = contents_of_files(run.folder)
    assert there == contents_of_files(whole)


def contents_of_files(directory: Path) -> dict[str, bytes]:
    hidden = (".lock", resume.MAKING)
    return {file.name: file.read_bytes() for file in directory.iterdir() if file.name not in hidden}


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    directory = tmp_path_factory.mktemp("finished") / "run"
    with Simulation(channel(), "reference", directory) as simulation:
        simulation.finish()
    return directory


@pytest.mark.parametrize("name", ["[/]", "[bold]x[/bold]", ":smile:", "\x1b]0;mine\x07\x1b[31m"])
def test_nothing_in_a_manifest_steers_the_terminal(
    name: str, finished: Path, tmp_path: Path
) -> None:
    run = tmp_path / "run"
    shutil.copytree(finished, run)
    change(run / "manifest.json", scene=name)
    (run / "scene.toml").unlink()
    done = CliRunner().invoke(app, ["analyze", str(run)])
    shown = name.replace("\x1b", "\\x1b").replace("\x07", "\\x07")
    assert f"{shown}, engine reference" in done.stdout
    assert not set(done.output) & {"\x1b", "\x07"}


def test_what_stopped_a_run_does_not_steer_the_terminal(tmp_path: Path) -> None:
    with Simulation(make_scene("channel", colloids=1), "reference", tmp_path / "run"):
        pass
    (tmp_path / "run" / "failure.txt").write_text("\x1b[2J[/] gone")
    done = CliRunner().invoke(app, ["status", str(tmp_path / "run")])
    assert "\\x1b[2J[/] gone" in done.stdout

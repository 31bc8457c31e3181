"""A scene is one file: two that no engine knows, in `tests/scenes`, from deck to numbers."""

import json
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import lammps_inputs.scenes as package
from analysis import RunDirectory, analyze, tabulate
from lammps_inputs import Scene, SceneError, all_scenes, make_scene
from lammps_inputs.deck import check_engine
from srd_driver import Simulation, sweep_definition
from srd_driver.sweep import run_all
from tests.conftest import ROOT, Run

FOLDER = str(ROOT / "tests" / "scenes")
CASES = [
    ("soft_disks", "md", {"temperature", "potential_energy", "mean_velocity_x"}),
    ("sedimenting_spheres", "mpc", {"temperature", "colloid_temperature"}),
]
REFUSED = {
    "soft_disks": {"mpc": "it is a fluid", "srd": "it is a fluid", "reference": "it is a fluid"},
    "sedimenting_spheres": {"md": "it has no fluid"},
}


@pytest.fixture(autouse=True)
def _folder_of_scenes(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """As if NARROWS_SCENES had been set when this process began; for its children it is."""
    monkeypatch.setenv(package.FOLDER_VARIABLE, FOLDER)
    monkeypatch.setattr(package, "__path__", [*package.__path__, FOLDER])
    all_scenes.cache_clear()
    yield
    all_scenes.cache_clear()


@pytest.mark.parametrize(("name", "engine", "numbers"), CASES)
def test_a_scene_in_one_file(
    name: str, engine: str, numbers: set[str], tmp_path: Path, command: Run
) -> None:
    scene = make_scene(name)
    for other, reason in REFUSED[name].items():
        with pytest.raises(SceneError, match=f"engine = '{other}': {reason}"):
            check_engine(scene, other)

    for ranks in (1, 2):  # plain LAMMPS on the deck
        deck = tmp_path / f"lmp{ranks}"
        command("narrows", "deck", name, "--engine", engine, "--out", deck)
        launcher = ["mpirun", "-np", str(ranks)] if ranks > 1 else []
        command(*launcher, "lmp", "-in", "in.lammps", cwd=deck)
    whole = tmp_path / "whole"  # from Python
    with Simulation(scene, engine, whole) as simulation:
        simulation.finish()
        assert simulation.colloid_positions.shape == (
            scene.system.particles,
            scene.system.box.dimensions,
        )
    same_bytes(whole, tmp_path / "lmp1", scene)
    kill_and_resume(scene, engine, tmp_path / "killed")
    same_bytes(whole, tmp_path / "killed", scene)

    swept = sweep_definition.plan(tmp_path / "sweep", name, {}, {"seed": [1, 2]}, 1, engine)
    assert run_all(sweep_definition.store(swept).runs, jobs=2) == []
    assert len(tabulate(tmp_path / "sweep", jobs=1).rows) == 2
    same_bytes(whole, tmp_path / "sweep" / "seed=1", scene)

    summary = analyze(tmp_path / "lmp2")
    assert numbers <= {key for key, entry in summary.items() if isinstance(entry, dict)}
    assert summary["finished"]
    drives = {drive.target: drive for drive in scene.system.drives}
    run, particles = RunDirectory(whole), RunDirectory(whole).particles()
    for target, drive in drives.items():  # every species has gone where its drive pulls it
        moved = (particles.positions[-1] - particles.positions[0])[particles.species == target]
        along = np.array(drive.direction)[: run.box.dimensions]
        assert (moved @ along).mean() > 0
        assert run.acceleration(target) @ np.array(drive.direction) == drive.magnitude


def test_spheres_are_the_same_in_the_reference(tmp_path: Path) -> None:
    """Three dimensions are ordinary: positions of fix mpc and of the numpy engine agree."""
    positions = {}
    for engine in ("mpc", "reference"):
        with Simulation(make_scene("sedimenting_spheres"), engine, tmp_path / engine) as run:
            run.run(1.0)
            positions[engine] = np.array(run.colloid_positions)
    np.testing.assert_allclose(positions["mpc"], positions["reference"], rtol=0, atol=1e-9)


def kill_and_resume(scene: Scene, engine: str, directory: Path) -> None:
    """Begin the run in another process, kill it amid its work, and go on here."""
    code = (
        "import json, sys, lammps_inputs; from srd_driver import Simulation\n"
        f"scene = lammps_inputs.make_scene({scene.name!r}, **json.loads(sys.argv[2]))\n"
        f"Simulation(scene, {engine!r}, sys.argv[1], checkpoint_interval=0.2).finish()"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", code, str(directory), scene.model_dump_json()], cwd=ROOT
    )
    progress = directory / "progress.json"
    while process.poll() is None:
        if progress.exists() and json.loads(progress.read_text())["step"] > 0:
            process.send_signal(signal.SIGKILL)
        time.sleep(0.01)
    assert process.returncode == -signal.SIGKILL, "killed before its end"
    with Simulation(scene, engine, directory, resume=True) as simulation:
        simulation.finish()


def same_bytes(one: Path, other: Path, scene: Scene) -> None:
    """Outputs without their titles, which LAMMPS repeats when it goes on."""
    for output in scene.system.outputs:
        texts = [(folder / output.file).read_text().splitlines() for folder in (one, other)]
        rows = [[line for line in text if not line.startswith("#")] for text in texts]
        assert rows[0] == rows[1], output.file

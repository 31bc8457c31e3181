"""Decks run with plain `lmp`, alone and on two processes, and contain only what they need."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import lammps_plugin
from lammps_inputs import Scene, engine_named, initial_state, make_scene
from lammps_inputs.deck import script, write_deck
from lammps_inputs.engines.engine import Start
from tests.conftest import Run

SCENES = {
    "channel": {"duration": 3.0, "equilibration": 0.0},
    "poiseuille": {"duration": 20.0, "equilibration": 0.0},
    "bulk": {"duration": 5.0, "shear_wave": 0.2},
    "bulk3d": {"duration": 2.0, "dimension": 3, "length": 8, "width": 8},
}


def scene(key: str, **fields: Any) -> Scene:
    return make_scene(key.removesuffix("3d"), **(SCENES[key] | fields))


def frames(file: Path) -> dict[int, Any]:
    """Rows of each frame of a dump, by step."""
    read: dict[int, Any] = {}
    for text in file.read_text().split("ITEM: TIMESTEP\n")[1:]:
        step, _, rows = text.partition("\n")
        read[int(step)] = np.loadtxt(rows.split("iz\n")[1].splitlines(), ndmin=2)
    return read


needs_plugin = pytest.mark.skipif(not lammps_plugin.folder(), reason="the plugin is not built")
ENGINES = ["srd", pytest.param("mpc", marks=needs_plugin)]


def columns(directory: Path, name: str = "observables.dat") -> Any:
    """Step, temperature and mean velocity of each sampling interval."""
    return np.loadtxt(directory / name)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("key", SCENES)
@pytest.mark.parametrize("ranks", [1, 2])
def test_a_deck_of_every_scene_runs_with_plain_lmp(
    key: str, ranks: int, engine: str, tmp_path: Path, command: Run
) -> None:
    chosen = scene(key)
    system, clock = chosen.system, chosen.system.clock
    write_deck(chosen, tmp_path, engine)
    launcher = ["mpirun", "-np", str(ranks)] if ranks > 1 else []
    command(*launcher, "lmp", "-in", "in.lammps", cwd=tmp_path)

    observables = columns(tmp_path)
    outputs = np.arange(clock.sample_steps, clock.total_steps + 1, clock.sample_steps)
    np.testing.assert_array_equal(observables[:, 0], outputs)
    # kBT = 1 within 5 % at any time: the thermostats hold it
    assert abs(observables[:, 1] - 1).max() < 0.05
    profile = (tmp_path / "fluid_profile.dat").read_text().splitlines()
    counts = [float(row.split()[2]) for row in profile if row.startswith("  ")]
    assert system.solvent is not None
    assert sum(counts) == pytest.approx(len(observables) * system.solvent.particles, rel=1e-4)
    if system.species:
        trajectory = frames(tmp_path / "trajectory.lammpsdump")
        assert list(trajectory) == [0, *outputs]
        start = initial_state(system, chosen.seed).colloid_positions
        np.testing.assert_allclose(trajectory[0][:, 2:4], start, rtol=1e-9)
        assert (np.array([frame[:, 3] for frame in trajectory.values()]) > 1).all()


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("gravity_of_scene", [0.1, 0.0])
def test_gravity_changes_on_the_command_line(
    engine: str, gravity_of_scene: float, tmp_path: Path, command: Run
) -> None:
    write_deck(scene("channel", gravity=gravity_of_scene), tmp_path, engine)
    drift = {}
    for gravity in ("0.1", "5.0"):
        command("lmp", "-in", "in.lammps", "-var", "gravity", gravity, cwd=tmp_path)
        *_, last = frames(tmp_path / "trajectory.lammpsdump").values()
        drift[gravity] = last[:, 5].mean()
        assert json.loads((tmp_path / "variables.json").read_text())["gravity"] == float(gravity)
    assert drift["5.0"] > drift["0.1"] + 1


def test_gravity_pulls_as_an_acceleration(tmp_path: Path, command: Run) -> None:
    """Without their fluid the colloids fall freely: their mean velocity gains g t."""
    chosen = scene("channel", gravity=2.0)
    write_deck(chosen, tmp_path, "srd")
    deck = (tmp_path / "in.lammps").read_text().splitlines(keepends=True)
    dry = [line for line in deck if " srd " not in line and "wall/srd" not in line]
    (tmp_path / "in.lammps").write_text("".join(dry))
    command("lmp", "-in", "in.lammps", cwd=tmp_path)
    trajectory = frames(tmp_path / "trajectory.lammpsdump")
    for step, rows in trajectory.items():
        gained = (rows[:, 5] - trajectory[0][:, 5]).mean()
        np.testing.assert_allclose(
            gained, 2.0 * step * chosen.system.clock.time_step, rtol=1e-8, atol=1e-8
        )


@pytest.mark.parametrize("engine", ENGINES)
def test_the_fluid_of_a_poiseuille_deck_feels_its_gravity(
    engine: str, tmp_path: Path, command: Run
) -> None:
    """Without walls in reach, momentum grows by g t: here in the first two samples.

    The scene has no gravity: that of the command line counts.
    """
    write_deck(scene("poiseuille", gravity=0, width=50, length=8, duration=2), tmp_path, engine)
    command("lmp", "-in", "in.lammps", "-var", "gravity", "0.5", cwd=tmp_path)
    speed = columns(tmp_path)[:2, 2]
    # the walls hold back a layer of depth sqrt(4 nu t) ~ 1.7 of 25 on each side
    np.testing.assert_allclose(speed[1] - speed[0], 0.5, rtol=0.12)


@pytest.mark.parametrize("engine", ENGINES)
def test_another_sample_averages_all_of_its_interval(
    engine: str, tmp_path: Path, command: Run
) -> None:
    """Twice the sampling interval gives the means of two: all looks, not the last ones."""
    means = {}
    for sample in (300, 600):
        folder = tmp_path / str(sample)
        folder.mkdir()
        write_deck(scene("channel", sampling_interval=0.3, duration=3.0), folder, engine)
        command("lmp", "-in", "in.lammps", "-var", "sample", str(sample), cwd=folder)
        means[sample] = columns(folder)[:, 1:]
    pairs = means[300].reshape(-1, 2, 2).mean(axis=1)
    np.testing.assert_allclose(means[600], pairs, rtol=1e-5, atol=1e-6)


@pytest.mark.parametrize(("sample", "taken"), [("450", True), ("400", False), ("150", False)])
def test_a_sample_that_looks_do_not_divide_is_refused(
    sample: str, taken: bool, tmp_path: Path, command: Run
) -> None:
    chosen = scene("channel", sampling_interval=0.3)
    assert chosen.system.clock.look_steps == 150
    write_deck(chosen, tmp_path, "srd")
    words = ("lmp", "-in", "in.lammps", "-var", "sample", sample)
    done = command(*words, cwd=tmp_path, succeed=False)
    assert (done.returncode == 0) == taken
    refusal = "ERROR: sample must be a multiple of 150, at least twice that"
    assert (refusal in done.stdout) != taken


def test_decks_are_minimal() -> None:
    def commands(chosen: Scene) -> str:
        return "\n".join(line.partition("#")[0] for line in script(chosen, "srd").splitlines())

    assert "wall/table" not in commands(scene("channel", wall_strength=0.0))
    bulk = commands(scene("bulk"))
    for needless in ("wall", "gravity", "dump", "pair_coeff", "nve", "collision noslip"):
        assert needless not in bulk
    assert "tstat" not in commands(scene("bulk", thermostat="none"))


def test_every_seed_is_in_the_deck_and_follows_the_scene() -> None:
    def seeds(seed: int, step: int = 0) -> dict[str, int]:
        return engine_named("srd").seeds(seed, step)

    chosen = scene("channel")
    lines = script(chosen, "srd")
    assert all(f"{name} index {value}" in lines for name, value in seeds(1).items())
    assert set(seeds(1).values()).isdisjoint(seeds(2).values())
    # a resumed run must not draw the same numbers again
    assert set(seeds(1).values()).isdisjoint(seeds(1, step=1000).values())
    resumed = script(chosen, "srd", Start(1000, "checkpoint.1000.restart"))
    assert "read_restart checkpoint.1000.restart" in resumed
    assert "read_data" not in resumed


def test_looks_at_the_fluid_divide_the_sampling_interval() -> None:
    for collisions in range(2, 100):
        clock = scene("bulk", sampling_interval=collisions * 0.1).system.clock
        assert clock.sample_steps == collisions
        assert collisions % clock.looks == 0
        assert collisions // clock.looks <= 10
        assert clock.looks >= 2

"""Decks run with plain `lmp`, alone and on two processes, and contain only what they need."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lammps_inputs import Scene, initial_state, make_scene, srd_deck
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


@pytest.mark.parametrize("key", SCENES)
@pytest.mark.parametrize("ranks", [1, 2])
def test_a_deck_of_every_scene_runs_with_plain_lmp(
    key: str, ranks: int, tmp_path: Path, command: Run
) -> None:
    one = scene(key)
    write_deck(one, tmp_path, "srd")
    launcher = ["mpirun", "-np", str(ranks)] if ranks > 1 else []
    command(*launcher, "lmp", "-in", "in.lammps", cwd=tmp_path)

    steps = one.collisions * one.steps_per_collision
    sample = one.collisions_per_sample * one.steps_per_collision
    observables = np.loadtxt(tmp_path / "observables.dat")
    np.testing.assert_array_equal(observables[:, 0], np.arange(sample, steps + 1, sample))
    # kBT = 1 within 5 % at any time: fix srd holds it by rescaling
    assert abs(observables[:, 1] - 1).max() < 0.05
    profile = (tmp_path / "fluid_profile.dat").read_text().splitlines()
    counts = [float(row.split()[2]) for row in profile if row.startswith("  ")]
    assert sum(counts) == pytest.approx(len(observables) * one.fluid_particles, rel=1e-4)
    if one.colloids:
        trajectory = frames(tmp_path / "trajectory.lammpsdump")
        assert list(trajectory) == list(range(0, steps + 1, sample))
        first = trajectory[0]
        np.testing.assert_allclose(
            first[:, 2:4], initial_state(one.system, one.seed).colloid_positions, rtol=1e-9
        )
        assert (np.array([frame[:, 3] for frame in trajectory.values()]) > 1).all()


def test_gravity_changes_on_the_command_line(tmp_path: Path, command: Run) -> None:
    write_deck(scene("channel", gravity=0.1), tmp_path, "srd")
    drift = {}
    for gravity in ("0.1", "5.0"):
        command("lmp", "-in", "in.lammps", "-var", "gravity", gravity, cwd=tmp_path)
        *_, last = frames(tmp_path / "trajectory.lammpsdump").values()
        drift[gravity] = last[:, 5].mean()
        assert json.loads((tmp_path / "variables.json").read_text())["gravity"] == float(gravity)
    assert drift["5.0"] > drift["0.1"] + 1


def test_gravity_pulls_as_an_acceleration(tmp_path: Path, command: Run) -> None:
    """Without their fluid the colloids fall freely: their mean velocity gains g t."""
    one = scene("channel", gravity=2.0)
    write_deck(one, tmp_path, "srd")
    deck = (tmp_path / "in.lammps").read_text().splitlines(keepends=True)
    dry = [line for line in deck if " srd " not in line and "wall/srd" not in line]
    (tmp_path / "in.lammps").write_text("".join(dry))
    command("lmp", "-in", "in.lammps", cwd=tmp_path)
    trajectory = frames(tmp_path / "trajectory.lammpsdump")
    for step, rows in trajectory.items():
        gained = (rows[:, 5] - trajectory[0][:, 5]).mean()
        np.testing.assert_allclose(gained, 2.0 * step * one.time_step, rtol=1e-8, atol=1e-8)


def test_the_fluid_of_a_poiseuille_deck_feels_its_gravity(tmp_path: Path, command: Run) -> None:
    """Without walls in reach, momentum grows by g t: here in the first two samples."""
    one = scene("poiseuille", gravity=0.5, width=50, length=8, duration=2)
    write_deck(one, tmp_path, "srd")
    command("lmp", "-in", "in.lammps", cwd=tmp_path)
    speed = np.loadtxt(tmp_path / "observables.dat")[:2, 2]
    # the walls hold back a layer of depth sqrt(4 nu t) ~ 1.7 of 25 on each side
    np.testing.assert_allclose(speed[1] - speed[0], 0.5, rtol=0.12)


def test_decks_are_minimal() -> None:
    def commands(one: Scene) -> str:
        return "\n".join(line.partition("#")[0] for line in script(one, "srd").splitlines())

    assert "gravity" not in commands(scene("channel", gravity=0.0))
    assert "wall/table" not in commands(scene("channel", wall_strength=0.0))
    bulk = commands(scene("bulk"))
    for needless in ("wall", "gravity", "dump", "pair_coeff", "nve", "collision noslip"):
        assert needless not in bulk
    assert "tstat" not in commands(scene("bulk", thermostat="none"))


def test_every_seed_is_in_the_deck_and_follows_the_scene() -> None:
    one, other = scene("channel"), scene("channel", seed=2)
    seeds = srd_deck.seeds(one)
    assert all(f"{name} index {value}" in script(one, "srd") for name, value in seeds.items())
    assert set(seeds.values()).isdisjoint(srd_deck.seeds(other).values())
    # a resumed run must not draw the same numbers again
    assert set(seeds.values()).isdisjoint(srd_deck.seeds(one, step=1000).values())
    resumed = script(one, "srd", Start(1000, "checkpoint.1000.restart"))
    assert "read_restart checkpoint.1000.restart" in resumed
    assert "read_data" not in resumed


def test_looks_at_the_fluid_divide_the_sampling_interval() -> None:
    for collisions in range(2, 100):
        one = scene("bulk", sampling_interval=collisions * 0.1)
        looks = one.fluid_looks
        assert one.collisions_per_sample == collisions
        assert collisions % looks == 0
        assert collisions // looks <= 10
        assert looks >= 2

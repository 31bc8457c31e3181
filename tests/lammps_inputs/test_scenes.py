"""Scenes: the paper's defaults, derived quantities, and everything that is refused."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lammps_inputs import (
    Scene,
    SceneError,
    initial_state,
    make_scene,
    parse_assignment,
    read_scene,
)
from lammps_inputs.deck import check_engine
from lammps_inputs.scenes.channel import Channel

NAN, INFINITY = float("nan"), float("inf")

BAD: list[tuple[str, dict[str, Any], str]] = [
    ("chanel", {}, "scene = 'chanel': must be one of bulk, "),
    ("channel", {"lenght": 40}, "lenght = 40: unknown field; channel has duration, equilibration"),
    ("poiseuille", {"colloids": 2}, "colloids = 2: unknown field"),
    ("channel", {"length": 40.5}, "length = 40.5: a periodic length must be a whole number"),
    ("bulk", {"width": 20.25}, "width = 20.25: a periodic length must be a whole number"),
    ("bulk", {"length": 1}, "length = 1.0: at least 2 collision cells"),
    ("channel", {"length": -40}, "length = -40: should be greater than 0"),
    ("channel", {"length": "long"}, "length = 'long': should be a valid number"),
    ("channel", {"length": 8}, "length = 8.0: a colloid would meet its own periodic image"),
    ("channel", {"width": NAN}, "width = nan: should be a finite number"),
    ("channel", {"gravity": INFINITY}, "gravity = inf: should be a finite number"),
    ("channel", {"width": 4.0}, "width = 4.0: colloids of radius 2.0 touch the walls"),
    ("channel", {"wall_sigma": 5.5}, "wall_sigma = 5.5: the walls overlap the colloids"),
    ("channel", {"wall_strength": -1}, "wall_strength = -1: should be greater than or equal to 0"),
    ("channel", {"colloids": 0}, "colloids = 0: should be greater than or equal to 1"),
    ("channel", {"colloids": 2.5}, "colloids = 2.5: should be a valid integer"),
    ("channel", {"colloids": 11}, "colloids = 11: do not fit in a length of 40.0; at most 10"),
    ("channel", {"spacing": 3.9}, "spacing = 3.9: colloids overlap; must be at least 4.0"),
    ("channel", {"spacing": 19}, "spacing = 19.0: 3 colloids do not fit in a length of 40.0"),
    ("channel", {"spacing": -5}, "spacing = -5: should be greater than 0"),
    ("channel", {"colloid_radius": 0}, "colloid_radius = 0: should be greater than 0"),
    ("channel", {"density": 0}, "density = 0: should be greater than 0"),
    ("channel", {"density": 1e4}, "density = 10000.0: should be less than or equal to 1000"),
    ("bulk", {"density": 1e-4}, "density = 0.0001: leaves 0 fluid particles"),
    ("channel", {"collision_time": 0}, "collision_time = 0: should be greater than 0"),
    ("channel", {"md_steps_per_collision": 0}, "md_steps_per_collision = 0: should be greater"),
    ("channel", {"angle": 0}, "angle = 0: should be greater than 0"),
    ("channel", {"angle": 181}, "angle = 181: should be less than or equal to 180"),
    ("channel", {"hydrodynamics": "off"}, "hydrodynamics = 'off': should be 'on', 'shuffle' or"),
    ("channel", {"thermostat": "nose"}, "thermostat = 'nose': should be 'none', 'layer'"),
    ("channel", {"duration": 0}, "duration = 0: should be greater than 0"),
    ("channel", {"equilibration": -1}, "equilibration = -1: should be greater than or equal"),
    ("channel", {"sampling_interval": 0}, "sampling_interval = 0: should be greater than 0"),
    ("channel", {"seed": 0}, "seed = 0: should be greater than or equal to 1"),
    ("channel", {"seed": 2**31}, "seed = 2147483648: should be less than"),
    ("bulk", {"dimension": 4}, "dimension = 4: should be 2 or 3"),
    ("bulk", {"height": 8}, "height = 8.0: only for dimension = 3"),
    ("bulk", {"dimension": 3, "angle": 120}, "angle = 120.0: rotations about the coordinate"),
    ("bulk", {"shear_wave": 2}, "shear_wave = 2: should be less than or equal to 1"),
    ("channel", {"gravity": -10}, "gravity = -10.0: colloids would fall at about 3."),
    ("poiseuille", {"gravity": 0.05}, "gravity = 0.05: the fluid would flow at about 3.4, faster"),
]


@pytest.mark.parametrize(("name", "fields", "message"), BAD)
def test_bad_input_is_refused_by_name_and_value(
    name: str, fields: dict[str, Any], message: str
) -> None:
    with pytest.raises(SceneError) as error:
        make_scene(name, **fields)
    assert any(problem.startswith(message) for problem in error.value.problems), error.value


def test_all_problems_are_told_at_once() -> None:
    with pytest.raises(SceneError) as error:
        make_scene("channel", length=-1, density=0, colour="red")
    assert len(error.value.problems) == 3


@pytest.mark.parametrize(
    ("name", "fields", "message"),
    [
        ("channel", {"angle": 120}, "angle = 120.0: fix srd rotates by 90 degrees only"),
        ("channel", {"hydrodynamics": "bath"}, "hydrodynamics = 'bath': fix srd cannot"),
        ("channel", {"thermostat": "andersen"}, "thermostat = 'andersen': fix srd rescales"),
        ("poiseuille", {"width": 9.5}, "width = 9.5: fix srd needs a whole number"),
        ("bulk", {"dimension": 3, "rotation": "random_axis"}, "rotation = 'random_axis': fix srd"),
    ],
)
def test_what_fix_srd_cannot_do_is_refused(name: str, fields: dict[str, Any], message: str) -> None:
    scene = make_scene(name, **fields)
    check_engine(scene, "reference")
    with pytest.raises(SceneError, match="fix srd") as error:
        check_engine(scene, "srd")
    assert str(error.value).startswith(message)


def test_defaults_are_the_papers() -> None:
    """Section 3.4.1, Table 3.1 and section 4.4 of tabatabaei-2009; its smallest system."""
    scene = Channel.make()
    assert scene == make_scene("channel")
    assert (scene.length, scene.width, scene.colloids) == (40, 10, 3)
    assert (scene.density, scene.collision_time, scene.angle) == (10, 0.015, 90)
    assert (scene.md_steps_per_collision, scene.gravity, scene.colloid_radius) == (15, 0.1, 2)
    assert (scene.wall_sigma, scene.colloid_colloid.sigma, scene.colloid_fluid.sigma) == (2, 4, 2)
    assert scene.colloid_mass == pytest.approx(125.664, abs=5e-4)


def test_density_counts_per_free_cell() -> None:
    solvent = make_scene("channel", length=300, colloids=31, spacing=5).system.solvent
    assert solvent is not None
    assert solvent.particles == round(10 * (3000 - 31 * math.pi * 4)) == 26104


@pytest.mark.parametrize("name", ["channel", "poiseuille", "bulk"])
def test_scene_file_gives_the_scene_back(name: str, tmp_path: Path) -> None:
    scene = make_scene(name, seed=7, density=5)
    file = tmp_path / "scene.toml"
    file.write_text(scene.toml())
    fields = read_scene(file)
    assert make_scene(fields.pop("scene"), **fields) == scene


def test_unreadable_scene_files_are_named(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match="missing"):
        read_scene(tmp_path / "missing.toml")
    broken = tmp_path / "broken.toml"
    broken.write_text("length = ")
    with pytest.raises(SceneError, match="broken"):
        read_scene(broken)


def test_assignments_are_toml_or_plain_words() -> None:
    assert parse_assignment("length=40") == ("length", 40)
    assert parse_assignment("gravity = 1e-3") == ("gravity", 1e-3)
    assert parse_assignment("thermostat=layer") == ("thermostat", "layer")
    assert parse_assignment("spacing=none") == ("spacing", "none")
    assert make_scene("channel", spacing="none") == make_scene("channel")
    with pytest.raises(SceneError, match="must have the form field=value"):
        parse_assignment("length")


@given(
    sampling=st.floats(0.03, 5),
    duration=st.floats(0.1, 50),
    equilibration=st.just(0.0) | st.floats(1e-6, 50),
)
def test_a_run_is_whole_sampling_intervals_and_not_too_short(
    sampling: float, duration: float, equilibration: float
) -> None:
    scene = make_scene(
        "channel", sampling_interval=sampling, duration=duration, equilibration=equilibration
    )
    clock = scene.system.clock
    assert clock.total_steps % clock.sample_steps == 0
    time, interval = clock.end, clock.sample_steps * clock.time_step
    collision_time = clock.steps_per_collision * clock.time_step
    assert abs(interval - sampling) <= 0.5 * collision_time * (1 + 1e-9)
    assert -1e-6 <= time - (duration + equilibration) < interval * (1 + 1e-6)


@pytest.mark.parametrize(
    "scene",
    [
        make_scene("channel", length=60, colloids=5, spacing=4.2),
        make_scene("poiseuille", width=9.5, seed=3),
        make_scene("bulk", shear_wave=0.3),
        make_scene("bulk", dimension=3, length=10, width=8, height=6),
    ],
    ids=lambda scene: f"{scene.name}{scene.system.box.dimensions}",
)
def test_initial_state(scene: Scene) -> None:
    system = scene.system
    assert system.solvent is not None
    state = initial_state(system, scene.seed)
    x, v = state.fluid_positions, state.fluid_velocities
    assert x.shape == v.shape == (system.solvent.particles, system.box.dimensions)
    assert (x >= 0).all()
    assert (x < np.array(system.box.sizes)).all()
    for centre, radius in zip(state.colloid_positions, system.radii, strict=True):
        apart = system.box.nearest_image(x - centre)
        assert (np.hypot(*apart.T) > radius).all()
    momentum = v.sum(axis=0) + system.masses @ state.colloid_velocities
    np.testing.assert_allclose(momentum, 0, atol=1e-9)
    # kBT = 1: sum of N d squares of variance 1; five standard deviations, false alarm 6e-7
    thermal = v.copy()
    wave = np.sin(2 * np.pi * x[:, 1] / system.box.sizes[1])
    thermal[:, 0] -= system.solvent.shear_wave * wave
    assert abs((thermal**2).mean() - 1) < 5 * math.sqrt(2 / v.size)
    again = initial_state(system, scene.seed)
    np.testing.assert_array_equal(again.fluid_positions, x)


def test_initial_fluid_fills_the_free_space_evenly() -> None:
    """Chi-square of particle counts in quarter cells far from and between colloids."""
    scene = make_scene("channel", density=100)
    state = initial_state(scene.system, scene.seed)
    x = state.fluid_positions
    counts = np.histogram2d(x[:, 0], x[:, 1], bins=(80, 20), range=((0, 40), (0, 10)))[0]
    centres = np.stack(np.meshgrid(np.arange(80) / 2 + 0.25, np.arange(20) / 2 + 0.25), axis=-1)
    apart = np.array([np.hypot(*(centres - c).T) for c in state.colloid_positions])
    free = counts[(apart > 2 + 0.36).all(axis=0)]
    chi_square = ((free - 25) ** 2 / 25).sum()
    assert abs(chi_square - free.size) < 5 * math.sqrt(2 * free.size)

"""What is warned of: the map of docs/stability.md, and silence for the papers' parameters."""

from typing import Any

import numpy as np
import pytest

from lammps_inputs import SceneError, make_scene
from lammps_inputs.deck import check_engine, script, warnings
from lammps_inputs.potentials.integrated_wall import IntegratedWall


@pytest.mark.parametrize("name", ["channel", "poiseuille", "bulk"])
@pytest.mark.parametrize("engine", ["srd", "mpc", "reference"])
def test_the_papers_parameters_raise_no_warning(name: str, engine: str) -> None:
    assert not list(warnings(make_scene(name), engine))


WARNED: list[tuple[str, dict[str, Any], str]] = [
    ("channel", {"density": 0.5, "gravity": 0}, "density = 0.5: most fluid particles are alone"),
    ("channel", {"gravity": -1}, "gravity = -1.0: colloids would fall at about 0.33 a0/t0"),
    ("channel", {"wall_strength": 0}, "wall_strength = 0.0: only the fluid keeps colloids off"),
    ("bulk", {"collision_time": 1}, "collision_time = 1.0, density = 10.0: a fluid of so low a"),
    ("poiseuille", {"width": 10, "collision_time": 1}, "collision_time = 1.0: the mean free path"),
    ("bulk", {"collision_time": 10}, "collision_time = 10.0: the mean free path of 10 a0"),
    ("bulk", {"angle": 1}, "angle = 1.0: the mean free path of 182 a0 is not short"),
    ("bulk", {"angle": 180}, "angle = 180.0: the mean free path"),
    ("bulk", {"dimension": 3, "rotation": "random_axis", "angle": 3}, "angle = 3.0: the mean free"),
]


@pytest.mark.parametrize(("name", "fields", "message"), WARNED)
def test_inaccurate_scenes_are_warned_of(name: str, fields: dict[str, Any], message: str) -> None:
    found = list(warnings(make_scene(name, **fields), "mpc"))
    assert sum(text.startswith(message) for text in found) == 1


def test_the_mean_free_path_is_the_kinetic_viscosity() -> None:
    """2D, alpha 90, n_f large: nu_kin = tau (1 / 2 - 1 / 2) = 0; alpha 10: tau (16.58 - 0.5)."""
    (told,) = warnings(make_scene("bulk", angle=10, density=1000, collision_time=0.2), "mpc")
    assert "mean free path of 3.22 a0" in told


def test_fix_srd_cools_without_a_thermostat() -> None:
    scene = make_scene("bulk", thermostat="none")
    assert len(list(warnings(scene, "srd"))) == 1
    assert not list(warnings(scene, "mpc"))


def test_without_hydrodynamics_gravity_and_mean_free_path_are_the_users() -> None:
    assert not list(warnings(make_scene("channel", hydrodynamics="bath", gravity=5), "mpc"))


def test_faster_than_sound_is_refused() -> None:
    for gravity in (10.0, -10.0):
        with pytest.raises(SceneError) as refused:
            make_scene("channel", gravity=gravity)
        (told,) = refused.value.problems
        assert told.startswith(f"gravity = {gravity}: colloids would fall at about 3.")
        assert told.endswith("must be between -3.1 and 3.1")
    make_scene("channel", gravity=2)
    make_scene("channel", gravity=-2)


def test_steps_too_long_for_the_forces_are_refused() -> None:
    """0.1 / 1 is more than 0.032 * 2; fix srd has no such forces; light colloids need less."""
    scene = make_scene("channel", collision_time=0.1, md_steps_per_collision=1, gravity=0)
    check_engine(scene, "srd")
    for engine in ("mpc", "reference"):
        with pytest.raises(SceneError) as refused:
            check_engine(scene, engine)
        (told,) = refused.value.problems
        assert told.startswith("md_steps_per_collision = 1: steps of 0.1 let fluid fly into")
        assert told.endswith("which takes 2 steps")
    check_engine(make_scene("channel", collision_time=0.06, md_steps_per_collision=1), "mpc")
    with pytest.raises(SceneError, match="which takes 35 steps"):  # 0.032 * 0.05 * sqrt(0.0728)
        check_engine(make_scene("channel", colloid_radius=0.05), "mpc")


def test_walls_too_stiff_for_the_step_are_refused() -> None:
    """U'' = 1.5 pi q (12 * 11 * 21/32 u^11 - 30 u^5) / y^2 at the cutoff: 23.4 q for sigma 2."""
    stiffness = IntegratedWall(sigma=2.0, strength=1.0).stiffness
    y = 2.0 * (231 / 160) ** (1 / 6) - np.array([1e-5, 0])
    numeric = -np.diff(IntegratedWall(sigma=2.0).force(y - 1e-9))[0] / 1e-5
    assert stiffness == pytest.approx(numeric, rel=1e-3)
    with pytest.raises(SceneError, match=r"wall_strength = 100000000\.0: too stiff for steps"):
        make_scene("channel", wall_strength=1e8)
    make_scene("channel", wall_strength=1e6)


@pytest.mark.parametrize(
    "fields", [{"collision_time": 0.3}, {"colloid_radius": 0.5}, {"colloid_radius": 1.0}]
)
def test_the_fluid_sees_colloids_as_far_as_it_must(fields: dict[str, Any]) -> None:
    assert "comm_modify cutoff" in script(make_scene("channel", **fields), engine="mpc")


def test_nothing_is_asked_for_where_the_neighbour_list_reaches() -> None:
    assert "comm_modify" not in script(make_scene("channel"), engine="mpc")

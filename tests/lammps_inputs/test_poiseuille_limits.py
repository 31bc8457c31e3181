"""What is said of a Poiseuille flow that heats, or need not be laminar."""

from typing import Any

import numpy as np
import pytest

from analysis import RunDirectory
from lammps_inputs import SceneError, make_scene
from lammps_inputs.scenes.poiseuille import HEAT
from lammps_inputs.viscosity import viscosity
from srd_driver import Simulation

NU = viscosity(10.0, 0.1, 90.0)


def gravity(speed: float, width: float = 25.0, nu: float = NU) -> float:
    """That drives a fluid to a speed on the mid-line (3.15)."""
    return 8 * nu * speed / width**2


def warned(**fields: Any) -> str:
    return "\n".join(make_scene("poiseuille", **fields).warnings())


def test_heat_and_turbulence_are_warned_of_and_sound_is_the_limit() -> None:
    assert warned() == ""
    assert warned(gravity=gravity(0.5)) == ""
    assert warned(gravity=gravity(0.15), thermostat="none") == ""
    assert "heats the fluid by about 14%" in warned(gravity=gravity(0.5), thermostat="none")
    assert warned(gravity=gravity(0.9), thermostat="none", hydrodynamics="shuffle") == ""
    thin = viscosity(10.0, 0.05, 90.0)
    wide = {"collision_time": 0.05, "width": 10_000.0, "gravity": gravity(0.9, 1e4, thin)}
    assert "need not be laminar" in warned(**wide)
    with pytest.raises(SceneError, match="faster than its sound"):
        make_scene("poiseuille", gravity=gravity(1.55))
    assert "on the mid-line" in warned(gravity=gravity(1.05))


@pytest.mark.statistics
@pytest.mark.parametrize("speed", [0.5, 0.7, 0.95])
@pytest.mark.parametrize("thermostat", ["layer", "monte_carlo", "none"])
def test_the_flow_is_the_parabola_and_heats_as_is_said(
    speed: float, thermostat: str, tmp_path: Any
) -> None:
    """The parabola's height within 8 %, its shape within 0.08 of it: means of 200 t0 are noisy."""
    scene = make_scene(
        "poiseuille",
        gravity=gravity(speed),
        thermostat=thermostat,
        duration=200,
        equilibration=300,
    )
    with Simulation(scene, "mpc", tmp_path) as simulation:
        simulation.finish()
    run = RunDirectory(tmp_path)
    profile = run.profile()
    used = run.sampled(profile.steps)
    velocity = profile.velocity_x[used].mean(axis=0)
    parabola = 4 * profile.y * (run.width - profile.y) / run.width**2
    height = float(velocity @ parabola / (parabola @ parabola))
    assert height == pytest.approx(speed, rel=0.08)
    np.testing.assert_allclose(velocity / height, parabola, atol=0.08)
    temperature = run.table()["fluid_temperature"][used].mean()
    heat = HEAT * speed**2 if thermostat == "none" else 0.0
    assert temperature == pytest.approx(1 + heat, abs=0.03)

"""`lanes` in an MPC fluid: momentum, mobility, temperatures, resume, ranks, what is refused."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import lammps_plugin
from analysis import RunDirectory, analyze
from analysis.estimate import Estimate
from lammps_inputs import Scene, SceneError, make_scene
from lammps_inputs.deck import check_engine, warnings
from lammps_inputs.viscosity import mobility_in_cells
from tests.conftest import Run
from tests.soft_scenes import SMALL, finish, killed_and_resumed, lanes, rows

pytestmark = pytest.mark.skipif(not lammps_plugin.folder(), reason="the plugin is not built")

SPHERES = {"dimension": 3, "particles": 216, "density": 0.7}


def in_solvent(**fields: Any) -> Scene:
    return lanes(
        **({"solvent": "mpc", "time_step": 0.002, "sampling_interval": 0.5, "field": 5.0} | fields)
    )


@pytest.mark.parametrize("hydrodynamics", ["on", "shuffle"])
@pytest.mark.parametrize("fields", [{}, SPHERES], ids=["2D", "3D"])
def test_colours_and_fluid_keep_their_momentum(
    hydrodynamics: str, fields: dict[str, Any], tmp_path: Path
) -> None:
    """Of all together: zero to rounding, however hard the colours are driven."""
    scene = in_solvent(hydrodynamics=hydrodynamics, duration=3.5, **fields)
    run = RunDirectory(finish(scene, tmp_path / "run"))
    table = run.table()
    assert np.abs(table["mean_velocity_x"]).max() < 1e-14
    assert run.manifest.system.solvent is not None
    assert run.manifest.system.solvent.hydrodynamics == hydrodynamics
    found = analyze(run.path)
    assert found["current"]["value"] > 0.02
    assert found["mobility"]["value"] == pytest.approx(found["current"]["value"] / 5.0)


@pytest.mark.parametrize(
    "fields",
    [
        {"mass": 5.0},
        {"mass": 1.0, "solvent_density": 3.0, "field": 10.0},
        {"dimension": 3, "particles": 40, "density": 0.003, "field": 10.0},
    ],
    ids=["2D", "2D, light", "3D"],
)
def test_a_lone_particle_drifts_through_a_bath_as_collisions_say(
    fields: dict[str, Any], tmp_path: Path
) -> None:
    """4 errors of free diffusion, and 2 % for those who meet."""
    common = {"time_step": 0.005, "density": 0.01, "equilibration": 2.0, "duration": 28.0}
    scene = in_solvent(hydrodynamics="bath", **(common | {"field": 20.0} | fields))
    fluid = scene.system.solvent
    assert fluid is not None
    found = analyze(finish(scene, tmp_path / "run"))["mobility"]["value"]
    mass, force = scene.system.species[0].mass, scene.system.drives[0].magnitude
    mobility = mobility_in_cells(fluid, mass, scene.system.box.dimensions)
    diffusion = fluid.temperature * mobility
    error = np.sqrt(2 * diffusion / (scene.system.particles * 28.0)) / (mass * force)
    print(found, mobility, error)
    assert abs(found - mobility) < 4 * error + 0.02 * mobility


@pytest.mark.parametrize("hydrodynamics", ["on", "bath"])
def test_a_killed_run_in_a_solvent_goes_on_to_the_last_bit(
    hydrodynamics: str, tmp_path: Path
) -> None:
    scene = in_solvent(hydrodynamics=hydrodynamics, field=20.0, duration=15.0)
    whole, again = finish(scene, tmp_path / "whole"), killed_and_resumed(scene, tmp_path / "killed")
    assert [output.kind for output in scene.system.outputs].count("profile") == 1
    for output in scene.system.outputs:
        assert rows(whole, output.file) == rows(again, output.file), output.file


def test_plain_lammps_on_two_ranks_is_the_same_run(tmp_path: Path, command: Run) -> None:
    scene = in_solvent()
    file = tmp_path / "scene.toml"
    file.write_text(scene.toml())
    for ranks in (1, 2):
        deck = tmp_path / f"lmp{ranks}"
        command("narrows", "deck", "lanes", "--scene", file, "--out", deck)
        launcher = ["mpirun", "-np", str(ranks)] if ranks > 1 else []
        command(*launcher, "lmp", "-in", "in.lammps", "-var", "steps", "500", cwd=deck)
    one, two = (
        np.array(" ".join(rows(tmp_path / f"lmp{n}", "observables.dat")).split(), dtype=float)
        for n in (1, 2)
    )
    assert one == pytest.approx(two, rel=1e-3, abs=1e-3)


def test_a_run_in_a_solvent_begins_as_one_without_ended(tmp_path: Path) -> None:
    """The particles, not the fluid; boxes with and without a solvent must be the same square."""
    first = finish(in_solvent(duration=1.0), tmp_path / "first")
    second = in_solvent(start=str(first), hydrodynamics="shuffle", duration=1.0)
    before = RunDirectory(first).particles().positions[-1]
    after = RunDirectory(finish(second, tmp_path / "second")).particles().positions[0]
    lengths = np.array(second.system.box.sizes)
    moved = after - before
    np.testing.assert_allclose(moved - lengths * np.round(moved / lengths), 0, atol=1e-5)
    with pytest.raises(SceneError, match=r"start of lanes: .*its box is"):
        finish(lanes(start=str(first)), tmp_path / "third")


BAD: list[tuple[dict[str, Any], str]] = [
    ({"thermostat": "kinetic"}, "thermostat = 'kinetic': a solvent brings its own"),
    ({"solvent": "none", "thermostat": "solvent"}, "thermostat = 'solvent': there is none"),
    ({"solvent": "none", "mass": 2.0}, "mass = 2.0: must be 1, the unit, without a solvent"),
    ({"solvent": "srd"}, "solvent = 'srd': should be 'none' or 'mpc'"),
    ({"hydrodynamics": "off"}, "hydrodynamics = 'off': should be 'on', 'shuffle' or 'bath'"),
    ({"solvent_density": 0}, "solvent_density = 0: should be greater than 0"),
    ({"solvent_density": 0.005}, "solvent_density = 0.005: leaves no fluid"),
    ({"collision_time": 0.0333}, "collision_time = 0.0333: must be a whole number of time steps"),
    ({"collision_time": 2.0}, "collision_time = 2.0: fluid would fly through its cell"),
    ({"field": 500.0, "time_step": 1e-4}, "field = 500.0: would drive lone particles at .* sound"),
    ({"particles": 48}, "particles = 48: a solvent needs a square box, .* by 13%; 896 fit"),
    ({"mass": -1}, "mass = -1: should be greater than 0"),
]


@pytest.mark.parametrize(("fields", "message"), BAD)
def test_bad_input_is_named_in_one_line(fields: dict[str, Any], message: str) -> None:
    with pytest.raises(SceneError, match=f"^{message}") as error:
        make_scene("lanes", **(SMALL | {"solvent": "mpc"} | fields))
    assert all("\n" not in problem for problem in error.value.problems)


@pytest.mark.parametrize("engine", ["srd", "reference"])
def test_other_engines_refuse(engine: str) -> None:
    with pytest.raises(SceneError) as error:
        check_engine(in_solvent(), engine)
    assert f"engine {engine} has 1 only" in str(error.value)
    assert "coupling = 'cell'" in str(error.value)


def test_a_fluid_that_lanes_would_drive_too_fast_is_warned_of() -> None:
    fast, slow = in_solvent(particles=896), in_solvent(particles=896, field=0.05)
    assert any("field = 5.0: two lanes would flow" in text for text in warnings(fast, "mpc"))
    assert not any("two lanes" in text for text in warnings(slow, "mpc"))


@pytest.mark.statistics
@pytest.mark.parametrize("hydrodynamics", ["on", "shuffle", "bath"])
@pytest.mark.parametrize("fields", [{}, SPHERES], ids=["2D", "3D"])
def test_one_equilibrium(hydrodynamics: str, fields: dict[str, Any], tmp_path: Path) -> None:
    """Without a field: energy and pressure as under the kinetic thermostat, one T, 4 errors."""
    common = {"field": 0.0, "equilibration": 20.0, "duration": 200.0, **fields}
    found = analyze(finish(in_solvent(hydrodynamics=hydrodynamics, **common), tmp_path / "fluid"))
    # the same square box
    edge = in_solvent(**common).system.box.sizes
    kinetic = lanes(sampling_interval=0.5, **common)
    assert np.prod(kinetic.system.box.sizes) == pytest.approx(np.prod(edge))
    there = analyze(finish(kinetic, tmp_path / "kinetic"))
    for key in ("potential_energy", "pressure"):
        one, other = (Estimate.of_json(summary[key]) for summary in (found, there))
        print(hydrodynamics, key, one, other)
        assert abs(one.deviation(other)) < 4, key
    temperature = 1.0 if not fields else 0.722
    for key in ("kinetic_temperature", "configurational_temperature", "fluid_temperature"):
        of = Estimate.of_json(found[key])
        print(hydrodynamics, key, of)
        assert abs(of.number - temperature) < 4 * of.standard_error + 2 / 120, key

"""The scenes `lanes` and `shear`: runs, resumes, two ranks, a ladder of fields, bad input."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import lammps_plugin
from analysis import RunDirectory, analyze
from analysis.estimate import Estimate
from lammps_inputs import Scene, SceneError, make_scene
from lammps_inputs.deck import check_engine, warnings
from srd_driver import RunError, Simulation, sweep_definition
from srd_driver.sweep import run_all
from tests.conftest import Run
from tests.soft_scenes import SMALL, finish, killed_and_resumed, lanes, rows, shear

pytestmark = pytest.mark.skipif(not lammps_plugin.folder(), reason="the plugin is not built")

EXACT = ("kinetic", "kinetic_x", "kinetic_y", "configurational")
NOISE = ("langevin", "dpd")
SHEARED_SPHERES = {
    "dimension": 3,
    "particles": 108,
    "density": 0.84,
    "rate": 2.0,
    "time_step": 0.0005,
}
NUMBERS = {
    "lane_order",
    "lane_order_printed",
    "bond_order",
    "configurational_temperature",
    "kinetic_temperature",
    "stream_temperature",
    "potential_energy",
    "pressure",
    "current",
    "mobility",
}


@pytest.mark.parametrize("thermostat", [*EXACT, *NOISE])
def test_a_killed_run_goes_on_to_the_last_bit(thermostat: str, tmp_path: Path) -> None:
    scene = lanes(thermostat=thermostat)
    whole, again = finish(scene, tmp_path / "whole"), killed_and_resumed(scene, tmp_path / "killed")
    for output in scene.system.outputs:
        assert rows(whole, output.file) == rows(again, output.file), output.file
    summary = analyze(again)
    assert {key for key, entry in summary.items() if isinstance(entry, dict)} >= NUMBERS
    assert summary["finished"]
    assert summary["figures"] == ["colour_flow.png", "lane_order.png", "snapshot.png"]


@pytest.mark.parametrize("thermostat", NOISE)
def test_no_interval_repeats_the_noise_of_another(thermostat: str, tmp_path: Path) -> None:
    scene = lanes(thermostat=thermostat)
    finish(scene, tmp_path / "run")
    noise = r"^(?:fix noise all langevin|pair_style .* dpd/tstat) [\d. ]* (\d+)$"
    seeds = re.findall(noise, (tmp_path / "run" / "log.lammps").read_text(), re.MULTILINE)
    clock = scene.system.clock
    assert len(seeds) == clock.total_steps // clock.sample_steps
    assert len(set(seeds)) == len(seeds)


@pytest.mark.parametrize("thermostat", ["kinetic", "configurational"])
@pytest.mark.parametrize("fields", [{}, SHEARED_SPHERES], ids=["2D", "3D"])
def test_a_killed_sheared_run_goes_on_to_the_last_bit(
    thermostat: str, fields: dict[str, Any], tmp_path: Path
) -> None:
    """Over a dozen flips of the box: a strain of 12 and more."""
    scene = shear(**({"thermostat": thermostat} | fields))
    whole, again = finish(scene, tmp_path / "whole"), killed_and_resumed(scene, tmp_path / "killed")
    for output in scene.system.outputs:
        assert rows(whole, output.file) == rows(again, output.file), output.file
    flow = np.polyfit(*_heights_and_speeds(again), 1)
    assert flow[0] == pytest.approx(scene.system.shear_rate, rel=0.1)
    summary = analyze(again)
    assert summary["shear_viscosity"]["value"] > 0
    assert {"configurational_temperature", "pressure", "kinetic_temperature"} <= summary.keys()


@pytest.mark.parametrize(
    "scene",
    [lanes(thermostat="kinetic"), lanes(thermostat="dpd"), shear(thermostat="configurational")],
    ids=["kinetic", "dpd", "shear"],
)
def test_plain_lammps_on_two_ranks_is_the_same_run(
    scene: Scene, tmp_path: Path, command: Run
) -> None:
    """Its first outputs: later, rounding has grown."""
    whole = finish(scene, tmp_path / "whole")
    file = tmp_path / "scene.toml"
    file.write_text(scene.toml())
    for ranks in (1, 2):
        deck = tmp_path / f"lmp{ranks}"
        command("narrows", "deck", scene.name, "--engine", "md", "--scene", file, "--out", deck)
        launcher = ["mpirun", "-np", str(ranks)] if ranks > 1 else []
        command(*launcher, "lmp", "-in", "in.lammps", "-var", "steps", "1000", cwd=deck)
    serial = rows(tmp_path / "lmp1", "observables.dat")
    assert serial == rows(whole, "observables.dat")[: len(serial)]
    if "dpd" not in scene.toml():  # each process has its own noise
        one, two = (
            [float(word) for word in rows(tmp_path / f"lmp{n}", "observables.dat")[0].split()]
            for n in (1, 2)
        )
        assert one == pytest.approx(two, rel=1e-3, abs=1e-3)


def test_a_ladder_of_fields(tmp_path: Path) -> None:
    """A run begins as another one ended; a first field is not there at rest."""
    first = finish(lanes(), tmp_path / "first")
    before = RunDirectory(first).particles()
    scene = lanes(field=2.0, start=str(first), thermostat="configurational")
    after = RunDirectory(finish(scene, tmp_path / "second")).particles()
    lengths = np.array(scene.system.box.sizes)
    moved = after.positions[0] - before.positions[-1]
    np.testing.assert_allclose(moved - lengths * np.round(moved / lengths), 0, atol=1e-5)
    np.testing.assert_allclose(after.velocities[0], before.velocities[-1], atol=1e-6)
    assert (after.species == before.species).all()


@pytest.mark.parametrize("thermostat", ["kinetic", "configurational"])
def test_a_ladder_of_rates(thermostat: str, tmp_path: Path) -> None:
    """The box goes on as tilted as it was, and only the flow is another."""
    first = finish(
        shear(thermostat=thermostat, duration=1.0, sampling_interval=0.3), tmp_path / "1"
    )
    scene = shear(thermostat=thermostat, rate=2.5, start=str(first), duration=1.0)
    second = finish(scene, tmp_path / "2")
    before, after = RunDirectory(first).particles(), RunDirectory(second).particles()
    ended, begun = (_bounds(folder, last) for folder, last in ((first, -1), (second, 0)))
    assert abs(ended[0][2]) > 0.5
    np.testing.assert_allclose(begun, ended, rtol=1e-6)
    lengths = np.array(scene.system.box.sizes)
    old, new = before.positions[-1] % lengths, after.positions[0] % lengths
    inside = np.abs(new - old)[:, 1] < lengths[1] / 2  # others are on the other side of y = 0 now
    moved = (new - old)[inside]
    np.testing.assert_allclose(moved - lengths * np.round(moved / lengths), 0, atol=1e-5)
    assert inside.mean() > 0.95
    own = before.velocities[-1, :, 0] - 1.5 * old[:, 1]
    there = after.velocities[0, :, 0] - 2.5 * new[:, 1]
    np.testing.assert_allclose(there[inside], own[inside], atol=1e-4)
    flow = np.polyfit(*_heights_and_speeds(second), 1)
    assert flow[0] == pytest.approx(2.5, abs=0.2)


def _bounds(folder: Path, frame: int) -> list[list[float]]:
    """Of a frame's box, along x and y."""
    frames = (folder / "trajectory.lammpsdump").read_text().split("ITEM: TIMESTEP")[1:]
    lines = frames[frame].splitlines()[5:7]
    return [[float(word) for word in line.split()] for line in lines]


def _heights_and_speeds(folder: Path) -> tuple[np.ndarray, np.ndarray]:
    run = RunDirectory(folder)
    particles = run.particles()
    return (particles.positions[:, :, 1] % run.width).ravel(), particles.velocities[:, :, 0].ravel()


def test_at_rest_there_is_no_field(tmp_path: Path) -> None:
    """The state after the rest does not depend on it, and is that of step 0."""
    start = [
        RunDirectory(finish(lanes(field=field, duration=0.25, equilibration=0), folder))
        for field, folder in ((0.0, tmp_path / "none"), (3.0, tmp_path / "field"))
    ]
    one, other = (run.particles().positions[0] for run in start)
    np.testing.assert_array_equal(one, other)


def test_a_sweep_over_fields(tmp_path: Path) -> None:
    fixed: dict[str, Any] = SMALL | {"duration": 1.0}
    plan = sweep_definition.plan(tmp_path, "lanes", fixed, {"field": [0.5, 1.0]}, 1, "md")
    assert run_all(sweep_definition.store(plan).runs, jobs=2) == []
    assert RunDirectory(plan.runs[1].folder).acceleration("minus").tolist() == [-1.0, 0.0, 0.0]


@pytest.mark.parametrize(("dimension", "number"), [(2, 896), (3, 1000)])
def test_a_random_start_is_possible(dimension: int, number: int, tmp_path: Path) -> None:
    fields = {"particles": None, "density": None, "start": "random", "dimension": dimension}
    run = RunDirectory(finish(lanes(**fields, duration=0.25, equilibration=0), tmp_path / "run"))
    assert len(run.particles().species) == number
    assert np.isfinite(run.table()["potential_energy"]).all()


BAD: list[tuple[str, dict[str, Any], str]] = [
    ("lanes", {"particles": 897}, "particles = 897: no nearly square crystal has so many disks"),
    ("lanes", {"particles": 14}, "particles = 14: no nearly square crystal .* would do"),
    ("lanes", {"particles": 12}, "particles = 12: leave a .* twice the range"),
    ("lanes", {"particles": 0}, "particles = 0: should be greater than or equal to 2"),
    ("lanes", {"particles": 999, "dimension": 3}, "particles = 999: must be even"),
    ("lanes", {"density": 0}, "density = 0: should be greater than 0"),
    ("lanes", {"density": 2.0}, "density = 2.0: should be less than or equal to 1.3"),
    ("lanes", {"temperature": -1}, "temperature = -1: should be greater than 0"),
    ("lanes", {"field": -1.0}, "field = -1.0: should be greater than or equal to 0"),
    ("lanes", {"field": float("nan")}, "field = nan: should be a finite number"),
    ("lanes", {"thermostat": "nose"}, "thermostat = 'nose': should be 'kinetic', 'kinetic_x'"),
    ("lanes", {"dimension": 4}, "dimension = 4: should be 2 or 3"),
    ("lanes", {"time_step": 0}, "time_step = 0: should be greater than 0"),
    ("lanes", {"time_step": 0.05}, "time_step = 0.05: should be less than or equal to 0.01"),
    ("lanes", {"time_step": 0.01, "temperature": 30}, "time_step = 0.01: too long for a temp"),
    ("lanes", {"field": 900, "time_step": 0.001}, "time_step = 0.001: too long for a field of 900"),
    ("lanes", {"thermostat": "configurational", "rest": 0}, "rest = 0.0: .* runs away from a latt"),
    ("lanes", {"rest": -1}, "rest = -1: should be greater than or equal to 0"),
    ("lanes", {"rest": 1e-4}, "rest = 0.0001: shorter than half a time step"),
    ("lanes", {"friction": 0}, "friction = 0: should be greater than 0"),
    ("lanes", {"thermostat": "dpd", "dpd_cutoff": 9}, "dpd_cutoff = 9.0: must be at most half"),
    ("lanes", {"thermostat": "langevin", "seed": 2**30}, "seed = 1073741824: must be at most"),
    ("lanes", {"damping": 0}, "damping = 0: should be greater than 0"),
    ("lanes", {"duration": 0}, "duration = 0: should be greater than 0"),
    ("lanes", {"rate": 1}, "rate = 1: unknown field; lanes has"),
    ("shear", {"rate": 0}, "rate = 0: should be greater than 0"),
    ("shear", {"rate": 60, "time_step": 0.002}, "time_step = 0.002: too long for a rate of 60"),
    ("shear", {"thermostat": "kinetic_x"}, "thermostat = 'kinetic_x': should be 'kinetic' or"),
    ("shear", {"thermostat": "configurational", "rest": 0}, "rest = 0.0: .* runs away"),
    ("shear", {"field": 1}, "field = 1: unknown field; shear has"),
]


@pytest.mark.parametrize(("name", "fields", "message"), BAD)
def test_bad_input_is_named_in_one_line(name: str, fields: dict[str, Any], message: str) -> None:
    with pytest.raises(SceneError, match=f"^{message}") as error:
        make_scene(name, **(SMALL | fields))
    assert all("\n" not in problem for problem in error.value.problems)


@pytest.mark.parametrize("engine", ["mpc", "srd", "reference"])
@pytest.mark.parametrize("scene", [lanes(), shear()], ids=["lanes", "shear"])
def test_other_engines_refuse(scene: Scene, engine: str) -> None:
    with pytest.raises(SceneError) as error:
        check_engine(scene, engine)
    text = str(error.value)
    assert f"engine = '{engine}': it is a fluid" in text
    assert f"engine {engine} has no such motion" in text
    if engine != "mpc":  # which has the same potentials and rest for disks in a solvent
        assert "SoftDisk" in text
        assert "no rest before the run" in text


def test_a_start_that_is_not_there_is_named(tmp_path: Path) -> None:
    first = finish(lanes(duration=0.25, equilibration=0), tmp_path / "first")
    for fields, reason in (
        ({"start": str(tmp_path / "none")}, "No such file"),
        ({"start": str(first), "density": 0.7}, "its box is .*, not"),
        ({"start": str(first), "particles": 168}, "no whole frame of 168 particles"),
    ):
        with pytest.raises(SceneError, match=f"start of lanes: .*{reason}"):
            finish(lanes(**fields), tmp_path / "second")
    moved = finish(lanes(start=str(first), duration=0.25), tmp_path / "third")
    (first / "trajectory.lammpsdump").unlink()
    with Simulation(lanes(start=str(first), duration=0.5), "md", moved, resume=True) as simulation:
        simulation.finish()  # a run needs its start no more once it is begun


def test_a_flow_that_begins_too_suddenly_is_warned_of_and_stops_by_name(tmp_path: Path) -> None:
    scene = make_scene(
        "shear", rate=35.0, thermostat="configurational", rest=2.0, sampling_interval=0.1
    )
    assert any("rate = 35.0: the flow begins at once" in text for text in warnings(scene, "md"))
    with pytest.raises(RunError, match=r"would move by .* too long for this field"):
        finish(scene, tmp_path / "run")


def test_a_step_too_long_for_the_field_is_named_when_it_shows(tmp_path: Path) -> None:
    scene = lanes(thermostat="configurational", field=50.0, time_step=0.004, duration=50.0)
    assert any("time_step = 0.004: long for a field of 50.0" in w for w in warnings(scene, "md"))
    with pytest.raises(RunError, match=r"would move by .* too long for this field"):
        finish(scene, tmp_path / "run")


@pytest.mark.statistics
@pytest.mark.parametrize("thermostat", [*EXACT[1:], *NOISE])
def test_one_equilibrium(thermostat: str, tmp_path: Path) -> None:
    """Without a field, n = 1.03: as under the kinetic thermostat, T_kin = T_conf = T, 4 errors."""
    found = {}
    for name in ("kinetic", thermostat):
        scene = make_scene(
            "lanes",
            field=0.0,
            thermostat=name,
            sampling_interval=1.0,
            equilibration=20.0,
            duration=100.0,
        )
        found[name] = analyze(finish(scene, tmp_path / name))
    for key in ("potential_energy", "pressure", "bond_order"):
        here, there = (Estimate.of_json(summary[key]) for summary in found.values())
        print(thermostat, key, here, there)
        assert abs(here.deviation(there)) < 4, key
    for key in ("kinetic_temperature", "configurational_temperature"):
        of = Estimate.of_json(found[thermostat][key])
        print(thermostat, key, of)
        finite = 2 / 896  # momentum, and a constraint: terms of order 1/N
        assert abs(of.number - 1) <= 4 * of.standard_error + finite, key

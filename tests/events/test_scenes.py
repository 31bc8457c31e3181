"""The scenes of hard spheres: refused, run, killed, resumed, swept and analysed as every scene."""

import csv
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import lammps_plugin
from analysis import RunDirectory, RunDirectoryError, analyze, tabulate
from lammps_inputs import Scene, SceneError, all_engines, make_scene
from lammps_inputs.deck import check_engine, write_deck
from lammps_inputs.engines import default_engine
from lammps_inputs.scenes.pore import Pore
from srd_driver import Simulation, sweep_definition
from srd_driver.sweep import run_all
from tests.conftest import Run
from tests.test_scene_in_one_file import kill_and_resume

SMALL: dict[str, dict[str, Any]] = {
    "pore": {"particles": 150, "trajectory": True, "reaction_probabilities": [0.1, 1.0]},
    "bulk_spheres": {"particles": 120, "centers": 3, "cutoff": 2.5, "packing_fraction": 0.3},
}
TIMES = {"sampling_interval": 1.0, "equilibration": 2.0, "duration": 10.0}


def small(name: str, **fields: Any) -> Scene:
    return make_scene(name, **(SMALL[name] | TIMES | fields))


def outputs(directory: Path, scene: Scene) -> list[str]:
    return [(directory / output.file).read_text() for output in scene.system.outputs]


BAD: list[tuple[str, dict[str, Any], str]] = [
    ("pore", {"particles": 0}, "particles = 0: should be greater than or equal to 1"),
    ("pore", {"particles": 1.5}, "particles = 1.5: should be a valid integer"),
    ("pore", {"particles": 10**8}, "particles = 100000000: should be less than or equal to"),
    ("pore", {"particles": 5}, "particles = 5: walls of edge 1.22; they must have at least 4, wi"),
    ("pore", {"packing_fraction": 0}, "packing_fraction = 0: should be greater than 0"),
    ("pore", {"packing_fraction": 0.8}, "packing_fraction = 0.8: should be less than 0.740"),
    ("pore", {"packing_fraction": 0.7}, r"packing_fraction = 0.7: 1000 spheres .* do not fit"),
    ("pore", {"packing_fraction": "dense"}, "packing_fraction = 'dense': should be a valid number"),
    ("pore", {"width": 1.0}, "width = 1.0: walls must be further apart than a diameter"),
    ("pore", {"width": -2}, "width = -2: should be greater than 0"),
    ("pore", {"width": math.nan}, "width = nan: should be a finite number"),
    ("pore", {"width_means": "gap"}, "width_means = 'gap': should be 'walls' or 'centres'"),
    ("pore", {"reaction_probabilities": []}, r"reaction_probabilities = \[\]: .*at least 1 item"),
    ("pore", {"reaction_probabilities": [0.1, 0]}, r"probabilities.1 = 0: should be greater tha"),
    ("pore", {"reaction_probabilities": [1.1]}, r"probabilities.0 = 1.1: should be less than or"),
    ("pore", {"reaction_probabilities": [0.1, 0.1]}, "one stands there twice"),
    ("pore", {"reaction_probabilities": 0.1}, "reaction_probabilities = 0.1: must be a list, such"),
    ("pore", {"sampling_interval": 0.1}, "sampling_interval = 0.1: at least 0.2"),
    ("pore", {"duration": 5}, "duration = 5.0: at least the sampling_interval, 20.0"),
    ("pore", {"equilibration": -1}, "equilibration = -1: should be greater than or equal to 0"),
    ("pore", {"seed": 0}, "seed = 0: should be greater than or equal to 1"),
    ("pore", {"gravity": 1}, "gravity = 1: unknown field; pore has"),
    ("pore", {"spheres": "elastic"}, "spheres = 'elastic': should be 'hard', 'pseudo_hard' or"),
    ("pore", {"spheres": "wca"}, "sampling_interval = 20.0: too long to lay colours on the paths"),
    (
        "pore",
        {"spheres": "wca", "sampling_interval": 0.2, "wall_stiffness": 9e4},
        "wall_stiffness = 90000.0: too stiff for a time step of 0.001; must be at most 4e",
    ),
    ("pore", {"time_step": 0.1}, "time_step = 0.1: should be less than or equal to 0.01"),
    ("bulk_spheres", {"cutoff": 1}, "cutoff = 1.0: must be above 1 and below half the edge"),
    ("bulk_spheres", {"cutoff": 6}, "cutoff = 6.0: must be above 1 and below half the edge"),
    ("bulk_spheres", {"centers": 0}, "centers = 0: should be greater than or equal to 1"),
    ("bulk_spheres", {"particles": 10, "centers": 11}, "particles = 10: a cube of edge 2.46"),
    ("bulk_spheres", {"particles": 150, "centers": 151}, "centers = 151: there are 150 particles"),
]


@pytest.mark.parametrize(("name", "fields", "message"), BAD)
def test_bad_fields_are_named(name: str, fields: dict[str, Any], message: str) -> None:
    with pytest.raises(SceneError, match=message):
        make_scene(name, **fields)


@pytest.mark.parametrize("name", SMALL)
def test_other_engines_refuse_by_name(name: str, tmp_path: Path) -> None:
    scene = small(name)
    assert default_engine(scene.system) == "events"
    for engine in all_engines().keys() - {"events"}:
        with pytest.raises(SceneError, match=rf"Events\(\): engine {engine} has no such motion"):
            check_engine(scene, engine)
    with pytest.raises(SceneError, match="the scene needs"):
        check_engine(make_scene("channel"), "events")
    with pytest.raises(SceneError, match="engine = 'events': has no deck"):
        write_deck(scene, tmp_path, "events")


@pytest.mark.parametrize(("means", "open_width"), [("walls", 4.0), ("centres", 5.0)])
def test_both_meanings_of_the_width(means: str, open_width: float) -> None:
    scene = Pore.make(width_means=means)
    *edges, separation = scene.system.box.sizes
    assert separation == open_width + 1
    assert scene.particles * math.pi / 6 / (math.prod(edges) * 5.0) == pytest.approx(0.35)


@pytest.mark.parametrize("name", SMALL)
def test_a_killed_run_goes_on_bit_for_bit(name: str, tmp_path: Path) -> None:
    scene = small(name, duration=60.0)
    with Simulation(scene, directory=tmp_path / "whole") as simulation:
        simulation.finish()
        place = np.array(simulation.colloid_positions)
        assert simulation.engine == "events"
    kill_and_resume(scene, "events", tmp_path / "killed")
    assert outputs(tmp_path / "whole", scene) == outputs(tmp_path / "killed", scene)
    with Simulation(scene, directory=tmp_path / "cut", checkpoint_interval=3.0) as simulation:
        simulation.run(17.0)
    with Simulation(scene, directory=tmp_path / "cut", resume=True) as simulation:
        simulation.finish()
        assert np.array_equal(place, simulation.colloid_positions)
    assert outputs(tmp_path / "whole", scene) == outputs(tmp_path / "cut", scene)


def test_a_sweep_status_and_analysis(tmp_path: Path, command: Run) -> None:
    fixed = SMALL["pore"] | TIMES
    swept = sweep_definition.plan(tmp_path / "sweep", "pore", fixed, {"packing_fraction": [0.1]}, 1)
    assert swept.engine == "events"
    assert run_all(sweep_definition.store(swept).runs, jobs=1) == []
    table = tabulate(tmp_path / "sweep", jobs=1)
    assert len(table.rows) == 1
    assert not table.problems
    told = command("narrows", "status", tmp_path / "sweep" / "packing_fraction=0.1,seed=1")
    assert "finished" in told.stdout


def test_numbers_of_a_pore(tmp_path: Path) -> None:
    """Fluxes by reactions and by currents, wall pressure and contact density, and the table."""
    scene = small("pore", particles=200, duration=250.0, equilibration=50.0, sampling_interval=10.0)
    with Simulation(scene, directory=tmp_path / "run") as simulation:
        simulation.finish()
    summary = analyze(tmp_path / "run")
    assert json.loads((tmp_path / "run" / "summary.json").read_text()) == summary
    assert summary["tables"] == ["diffusivity.csv"]
    for p in ("p=0.1", "p=1"):
        flux = summary["color_flux"][p]
        both = math.hypot(flux["reactions"]["error"], flux["currents"]["error"])
        assert abs(flux["reactions"]["value"] - flux["currents"]["value"]) < 4 * both
    slow, fast = (summary["diffusivity"][p] for p in ("p=0.1", "p=1"))
    assert 0.07 < slow["middle"]["value"] < 0.12  # 0.09 in the default scene
    assert fast["surface"]["value"] > 2 * slow["surface"]["value"]  # the bias of Fig. 2
    assert slow["error_of_labels"] > 1
    assert (
        summary["reacted_speed"]["p=1"]["value"] > 1.6 > summary["reacted_speed"]["p=0.1"]["value"]
    )
    pressure, contact = summary["lower_pressure"], summary["contact_density"]
    joint = math.hypot(pressure["error"], contact["error"])
    assert abs(pressure["value"] - contact["value"]) < 4 * joint

    with (tmp_path / "run" / "diffusivity.csv").open() as file:
        rows = [{name: float(text) for name, text in row.items()} for row in csv.DictReader(file)]
    assert list(rows[0]) == ["reaction_probability", "z", "density", "diffusivity", "error"]
    assert {row["reaction_probability"] for row in rows} == {0.1, 1.0}
    z = np.array([row["z"] for row in rows if row["reaction_probability"] == 0.1])
    assert z[[0, -1]] == pytest.approx([-1.99, 1.99])
    density = np.array([row["density"] for row in rows])[: len(z)]
    edge = scene.system.box.sizes[0]
    assert density.sum() * 0.02 * edge**2 == pytest.approx(200, rel=1e-6)


def test_displacements_in_the_middle_stand_beside_the_colours(tmp_path: Path) -> None:
    """Of the same run: D across the walls by both; and only where there are paths."""
    given = {"particles": 200, "sampling_interval": 0.5, "duration": 300.0, "equilibration": 50.0}
    with Simulation(small("pore", **given), directory=tmp_path / "run") as simulation:
        simulation.finish()
    summary = analyze(tmp_path / "run")
    middle, by_colors = summary["middle_displacement"], summary["diffusivity"]["p=0.1"]["middle"]
    assert middle["window"][0] >= 0.5
    assert middle["value"] == pytest.approx(by_colors["value"], rel=0.25)
    assert middle["error"] < 0.1 * middle["value"]
    assert "middle_displacement" not in small("pore", trajectory=False).system.measures


def test_the_bulk_has_the_pressure_of_carnahan_and_starling(tmp_path: Path) -> None:
    scene = small("bulk_spheres", particles=300, cutoff=3.0, duration=60.0, equilibration=10.0)
    with Simulation(scene, directory=tmp_path / "run") as simulation:
        simulation.finish()
    summary = analyze(tmp_path / "run")
    found = summary["compressibility"]
    assert found["value"] == pytest.approx(found["theory"], rel=0.02)
    with (tmp_path / "run" / "diffusivity.csv").open() as file:
        assert next(csv.reader(file))[1] == "r"


@pytest.mark.skipif(not lammps_plugin.folder(), reason="the plugin is not built")
@pytest.mark.parametrize("spheres", ["pseudo_hard", "wca"])
def test_soft_spheres_leave_paths(spheres: str, tmp_path: Path) -> None:
    """Engine md: kBT is 1, nothing leaves the pore, colours are laid on the paths."""
    scene = make_scene(
        "pore",
        particles=120,
        packing_fraction=0.2,
        spheres=spheres,
        sampling_interval=0.2,
        equilibration=4.0,
        duration=30.0,
    )
    assert default_engine(scene.system) == "md"
    with pytest.raises(SceneError, match="engine events has no such"):
        check_engine(scene, "events")
    with Simulation(scene, directory=tmp_path / "run") as simulation:
        simulation.finish()
    summary = analyze(tmp_path / "run")
    assert summary["temperature"]["value"] == pytest.approx(1, abs=0.01)
    assert 0.1 < summary["self_diffusion"]["value"] < 0.5
    z = RunDirectory(tmp_path / "run").particles().positions[:, :, 2]
    assert z.min() > 0.4  # the harmonic wall at 0.5 lets kBT in by 0.014
    assert z.max() < 4.6
    assert 0.1 < summary["path_diffusivity"]["bayes"]["middle"] < 0.5
    assert 0.1 < summary["middle_displacement"]["value"] < 0.5


def test_too_few_outputs_are_counted(tmp_path: Path) -> None:
    with Simulation(small("pore", duration=3.0), directory=tmp_path / "run") as simulation:
        simulation.finish()
    with pytest.raises(RunDirectoryError, match="3 outputs after the equilibration; at least 6"):
        analyze(tmp_path / "run")


def test_reactions_of_a_damaged_manifest_are_refused(tmp_path: Path) -> None:
    with Simulation(small("pore", duration=3.0), directory=tmp_path / "run") as simulation:
        simulation.run(1.0)
    file = tmp_path / "run" / "manifest.json"
    content = json.loads(file.read_text())
    for entry, value, message in (
        ("probabilities", [], "at least 1 item"),
        ("probabilities", [2.0], "less than or equal to 1"),
        ("axis", 0, "reactions at walls of axis 0: it has none"),
    ):
        changed = json.loads(json.dumps(content))
        changed.pop("digest", None)  # as one written by hand
        changed["system"]["reactions"][entry] = value
        file.write_text(json.dumps(changed))
        with pytest.raises(RunDirectoryError, match=message):
            RunDirectory(tmp_path / "run")

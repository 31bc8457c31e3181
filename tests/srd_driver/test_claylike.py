"""The scene of hecht-2005 from deck to numbers: both couplings, moving walls, kill and resume."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from analysis import RunDirectory, analyze, tabulate
from lammps_inputs import SceneError, make_scene
from lammps_inputs.deck import check_engine
from srd_driver import Simulation, sweep_definition
from srd_driver.sweep import run_all
from tests.conftest import Run
from tests.test_scene_in_one_file import kill_and_resume, same_bytes

SHORT = {"duration": 12, "equilibration": 0}
CELL = {"cells": 6, "density": 10, "md_steps_per_collision": 150, **SHORT}
REFLECTION = {"coupling": "reflection", "cells": 15, "peclet": 2, "duration": 8, "equilibration": 0}
CASES: dict[str, dict[str, Any]] = {
    "cell": CELL | {"peclet": 1.0},
    "cell, sheared": CELL | {"boundaries": "bottom", "shear_rate": 0.1, "peclet": 1.0},
    "reflection": REFLECTION,
    "reflection, capillary": REFLECTION | {"boundaries": "capillary", "potential": "hertz"},
}


@pytest.mark.parametrize("fields", CASES.values(), ids=CASES)
def test_deck_driver_and_resumed_run_are_the_same(
    fields: dict[str, Any], tmp_path: Path, command: Run
) -> None:
    """To the last bit, with friction and fluctuations; on two processes to rounding at first."""
    scene = make_scene("claylike", **fields)
    for ranks in (1, 2):
        deck = tmp_path / f"lmp{ranks}"
        settings = [word for pair in fields.items() for word in ("--set", "{}={}".format(*pair))]
        command("narrows", "deck", "claylike", *settings, "--out", deck)
        launcher = ["mpirun", "-np", str(ranks)] if ranks > 1 else []
        clock = scene.system.clock
        steps = 4 * clock.sample_steps if ranks > 1 else clock.total_steps
        command(*launcher, "lmp", "-in", "in.lammps", "-var", "steps", str(steps), cwd=deck)
    with Simulation(scene, "mpc", tmp_path / "whole") as simulation:
        simulation.finish()
    same_bytes(tmp_path / "whole", tmp_path / "lmp1", scene)
    kill_and_resume(scene, "mpc", tmp_path / "killed")
    same_bytes(tmp_path / "whole", tmp_path / "killed", scene)

    one, two = (RunDirectory(tmp_path / f"lmp{ranks}").particles() for ranks in (1, 2))
    np.testing.assert_allclose(one.positions[:3], two.positions[:3], rtol=0, atol=1e-7)
    summary = analyze(tmp_path / "lmp1")
    assert summary["finished"]
    expected = {"settling_speed", "diffusion", "clusters", "rotational_temperature"}
    assert expected | {"temperature", "colloid_temperature"} <= summary.keys()
    turned = fields.get("coupling") == "reflection"
    assert ("rotational_diffusion" in summary) == turned
    assert ("shear_flow" in summary) == ("shear_rate" in fields)
    assert summary["settling_speed"].keys() == {
        *("zero_momentum", "relative_to_fluid", "zero_volume_flux"),
    }
    assert summary["diffusion"].keys() == {"msd", "green_kubo", "infinite_box"}
    assert {"skewness", "excess_kurtosis"} <= summary["fluid_velocity_distribution"].keys()
    if "shear_rate" in fields:
        assert {"stress", "viscosity"} <= summary["shear_flow"].keys()
    assert {"largest", "number", "bonds_per_colloid"} <= summary["clusters"].keys()


@pytest.mark.parametrize("case", ["cell", "reflection"])
def test_the_reference_engine_begins_alike_and_resumes_bit_for_bit(
    case: str, tmp_path: Path
) -> None:
    """Frames of both engines, to the digits of the file; and what analysis makes of numpy's."""
    fields = CASES[case] | {"duration": 6, "md_steps_per_collision": 60, "potential": "hertz"}
    scene = make_scene("claylike", **fields, volume_fraction=0.05)
    runs = []
    for engine in ("reference", "mpc"):
        with Simulation(scene, engine, tmp_path / engine) as simulation:
            simulation.finish()
        runs.append(RunDirectory(tmp_path / engine))
    numpy_frames, lammps_frames = (run.particles().positions[:4] for run in runs)
    np.testing.assert_allclose(numpy_frames, lammps_frames, rtol=0, atol=1e-5)
    if case == "reflection":
        spins = [run.particles().spins for run in runs]
        assert spins[0] is not None
        assert spins[1] is not None
        np.testing.assert_allclose(spins[0][:4], spins[1][:4], rtol=0, atol=1e-5)
        assert abs(spins[0][3]).max() > 0
    of_numpy, of_lammps = (run.table() for run in runs)
    for column in of_numpy.columns:
        np.testing.assert_allclose(of_numpy[column][:3], of_lammps[column][:3], rtol=0, atol=1e-5)
    kill_and_resume(scene, "reference", tmp_path / "killed")
    same_bytes(tmp_path / "reference", tmp_path / "killed", scene)
    assert {"colloid_temperature", "rotational_temperature"} <= analyze(runs[0].path).keys()


def test_the_reference_engine_refuses_what_it_has_not() -> None:
    for fields, complaint in (
        ({"thermostat": "rescale"}, "thermostat = 'rescale'"),
        ({"thermostat": "layer", "boundaries": "bottom"}, "thermostat = 'layer'"),
        ({"hydrodynamics": "bath"}, "hydrodynamics = 'bath'"),
    ):
        with pytest.raises(SceneError, match=complaint):
            check_engine(make_scene("claylike", **fields), "reference")


def test_total_momentum_stays_zero_while_colloids_settle(tmp_path: Path) -> None:
    """The fluid balances gravity (VIII A, iii): to rounding at every output."""
    for name in ("cell", "reflection"):
        with Simulation(make_scene("claylike", **CASES[name]), "mpc", tmp_path / name) as run:
            run.finish()
        table = RunDirectory(tmp_path / name).table()
        assert abs(table["mean_velocity_z"]).max() < 1e-13
        assert abs(table["fluid_velocity_z"]).min() > 1e-9, "what the colloids have not"


def test_fluid_follows_the_walls(tmp_path: Path) -> None:
    fields = CASES["cell, sheared"] | {"peclet": 0}
    with Simulation(make_scene("claylike", **fields), "mpc", tmp_path) as run:
        run.finish()
    particles = RunDirectory(tmp_path).particles()
    upper = particles.positions[-1, :, 2] > 3
    moved = (particles.positions[-1] - particles.positions[0])[:, 0]
    assert moved[upper].mean() > 0 > moved[~upper].mean()


def test_a_sweep_over_volume_fractions(tmp_path: Path) -> None:
    swept = sweep_definition.plan(
        tmp_path, "claylike", CELL, {"volume_fraction": [0.07, 0.14]}, 1, "mpc"
    )
    assert run_all(sweep_definition.store(swept).runs, jobs=2) == []
    assert len(tabulate(tmp_path, jobs=1).rows) == 2


def test_fix_srd_runs_the_reflecting_suspension(tmp_path: Path) -> None:
    fast = {"thermostat": "layer", "potential": "hertz", "md_steps_per_collision": 30}
    scene = make_scene("claylike", **REFLECTION | fast | {"duration": 3})
    with Simulation(scene, "srd", tmp_path) as run:
        run.finish()
    table = RunDirectory(tmp_path).table()
    alone = scene.system.drives[0].magnitude * scene.system.clock.end / 3  # a third of the mass
    assert abs(table["mean_velocity_z"]).max() < 0.1 * alone, "fix srd keeps momentum roughly"
    assert abs(table["fluid_temperature"].mean() - 1) < 0.05


REFUSALS = {
    ("srd", "cell"): r"coupling = 'cell': engine srd has .* only",
    ("md", "cell"): "engine = 'md': it has no fluid",
    ("srd", "reflection"): "thermostat = 'monte_carlo': fix srd rescales",
}


@pytest.mark.parametrize(("engine", "coupling"), REFUSALS)
def test_other_engines_refuse_by_name(engine: str, coupling: str) -> None:
    with pytest.raises(SceneError, match=REFUSALS[engine, coupling]):
        check_engine(make_scene("claylike", coupling=coupling), engine)


@pytest.mark.parametrize("fields", [CELL, REFLECTION], ids=["cell", "reflection"])
def test_a_run_begins_with_the_last_colloids_of_another(
    fields: dict[str, Any], tmp_path: Path
) -> None:
    """Their places and velocities, less what the momentum of all takes; a weaker attraction."""
    first, second = tmp_path / "first", tmp_path / "second"
    short = fields | {"duration": 4.0, "sampling_interval": 2.0, "surface_potential": 0.03}
    with Simulation(make_scene("claylike", **short), "mpc", first) as simulation:
        simulation.finish()
    weaker = short | {"surface_potential": 0.05, "seed": 2}
    other = make_scene("claylike", **weaker, start=str(first))
    with Simulation(other, "mpc", second) as simulation:
        simulation.finish()
    before, after = RunDirectory(first).particles(), RunDirectory(second).particles()
    box = RunDirectory(first).box.sizes
    apart = after.positions[0] - before.positions[-1]
    np.testing.assert_allclose(apart - box * np.round(apart / box), 0, atol=1e-9)
    drift = after.velocities[0] - before.velocities[-1]
    np.testing.assert_allclose(drift - drift[0], 0, atol=1e-6)  # read in single precision
    wrong = make_scene("claylike", **(short | {"volume_fraction": 0.1}), start=str(first))
    with pytest.raises(SceneError, match=r"start of claylike: .*no whole frame of"):
        Simulation(wrong, "mpc", tmp_path / "third")

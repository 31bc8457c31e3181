"""fix mpc in single precision: the numpy reference's particles, any ranks, restarts, no drifts."""

import functools
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lammps_inputs import Scene, make_scene
from lammps_inputs.deck import write_deck
from lammps_inputs.engines import engine_named
from lammps_inputs.engines.engine import Start
from srd_driver.reference.single_engine import PLACES, SingleEngine
from tests.conftest import Run
from tests.plugin import test_large_restart as large
from tests.plugin.fluid import largest_difference, run_mpc

COLLISIONS = 20
TOLERANCE = 1e-5  # a place is 1e-6 and a digit 1e-7 to 2e-7: a few of both
GRAZING = 1e-4  # what slides along a wall meets it later by a place over its slow speed
COLLOIDS = 1e-3  # they amplify a rounding by some hundreds in 20 collisions
TOLERANCES = {"colloids": COLLOIDS, "slit": GRAZING}

BULK3D = {"dimension": 3, "length": 6, "width": 8, "height": 7, "thermostat": "none"}
DRIVEN = {"length": 12, "width": 9.3, "gravity": 0.02}
NAMED: dict[str, tuple[str, dict[str, Any]]] = {
    "bulk 2D": ("bulk", {"thermostat": "none", "length": 13, "width": 17, "angle": 130}),
    "bulk 3D, coordinate axes": ("bulk", {**BULK3D, "rotation": "coordinate_axes"}),
    "bulk 3D, random axis": ("bulk", {**BULK3D, "rotation": "random_axis", "angle": 60}),
    "bulk 3D, layer": ("bulk", {**BULK3D, "thermostat": "layer"}),
    "slit, none": ("poiseuille", {**DRIVEN, "thermostat": "none"}),
    "slit, layer": ("poiseuille", {**DRIVEN, "thermostat": "layer"}),
    "slit, monte_carlo": ("poiseuille", {**DRIVEN, "thermostat": "monte_carlo"}),
    "slit, rescale": ("poiseuille", {**DRIVEN, "thermostat": "rescale"}),
    "slit, andersen": ("poiseuille", {**DRIVEN, "thermostat": "andersen"}),
    "colloids": ("channel", {"colloids": 3, "length": 21, "gravity": 2.0}),
}
CASES: dict[str, Scene] = {
    case: make_scene(name, precision="single", **of) for case, (name, of) in NAMED.items()
}


@functools.cache
def reference(case: str) -> SingleEngine:
    engine = SingleEngine(CASES[case])
    engine.advance(COLLISIONS)
    return engine


@pytest.mark.parametrize(
    ("case", "ranks"),
    [
        *((case, 1) for case in CASES),
        ("bulk 2D", 4),
        ("bulk 3D, random axis", 2),
        ("slit, layer", 3),
        ("colloids", 2),
    ],
)
def test_every_particle_agrees_with_the_reference(
    case: str, ranks: int, tmp_path: Path, command: Run
) -> None:
    scene = CASES[case]
    mpc = run_mpc(scene, COLLISIONS, tmp_path, command, ranks)
    tolerance = TOLERANCES.get(case.partition(",")[0], TOLERANCE)
    assert largest_difference(mpc, reference(case), scene) < tolerance
    places = mpc.fluid_positions * PLACES
    np.testing.assert_array_equal(places, np.rint(places))
    np.testing.assert_array_equal(mpc.fluid_velocities, mpc.fluid_velocities.astype(np.float32))


def test_a_restart_goes_on_to_the_last_bit_and_tells_its_precision(
    tmp_path: Path, command: Run
) -> None:
    scene = CASES["colloids"]
    step = 10 * scene.system.clock.steps_per_collision
    whole = run_mpc(scene, COLLISIONS, tmp_path / "whole", command)
    parts = tmp_path / "parts"
    run_mpc(scene, 10, parts, command, end="write_restart half.restart\n")
    start = Start(step, "half.restart")
    end = run_mpc(scene, COLLISIONS, parts, command, start=start)
    assert largest_difference(end, whole, scene) == 0
    name, fields = NAMED["colloids"]
    double = make_scene(name, **fields)
    with pytest.raises(AssertionError, match="restart: of precision single, not double"):
        run_mpc(double, COLLISIONS, parts, command, start=start)


def test_a_large_fluid_beside_its_restart_goes_on_to_the_last_bit(
    tmp_path: Path, command: Run
) -> None:
    save = "fix_modify fluid save end.fluid\n"
    whole, parts = tmp_path / "whole", tmp_path / "parts"
    text = large.deck(large.BOX, f"write_restart {large.HALF}\nrun 6\n{save}")
    large.run(whole, text.replace("density", "precision single density"), 2, command)
    start = large.deck(f"read_restart {whole / large.HALF}", save)
    large.run(parts, start.replace("density", "precision single density"), 2, command)
    assert (parts / "end.fluid").read_bytes() == (whole / "end.fluid").read_bytes()
    said = large.run(parts, start, 2, command, succeed=False)
    assert "restart: of precision single, not double" in said


@pytest.mark.parametrize(
    ("option", "complaint"),
    [
        ("precision half", "precision half: must be one of double, single"),
        ("hydro bath", "precision single: hydro bath is in double precision only"),
    ],
)
def test_what_it_does_not_do_is_refused(
    option: str, complaint: str, tmp_path: Path, command: Run
) -> None:
    write_deck(CASES["bulk 2D"], tmp_path, "mpc")
    deck = (tmp_path / "in.lammps").read_text()
    (tmp_path / "in.lammps").write_text(
        deck.replace("precision single", f"precision single {option}")
    )
    done = command("lmp", "-in", "in.lammps", cwd=tmp_path, succeed=False)
    assert done.returncode != 0
    assert complaint in done.stdout + done.stderr


def test_random_solvents_and_fix_srd_have_double_only() -> None:
    for engine, fields, complaint in (
        ("mpc", {"hydrodynamics": "bath"}, "precision = 'single': needs hydrodynamics = 'on'"),
        ("srd", {}, "precision = 'single': fix srd has double only"),
    ):
        scene = make_scene("bulk", precision="single", **fields)
        assert any(complaint in line for line in engine_named(engine).problems(scene.system))

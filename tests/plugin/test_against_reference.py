"""fix mpc and the numpy reference give the same particles, from the same state and seed.

Both draw the same random numbers, so all that may differ is rounding: a particle that it puts into
another cell, or a wrong number of random numbers, differs by 0.1 at once.
"""

import functools
from pathlib import Path
from typing import Any

import pytest

from lammps_inputs import Scene, make_scene
from srd_driver.reference import ReferenceEngine, SuspensionEngine
from tests.conftest import Run
from tests.hand_made import Mixture3D, Slit3D
from tests.plugin.fluid import largest_difference, run_mpc

COLLISIONS = 30
FEWER = {"claylike, cell": 8}  # 2000 steps of charged spheres; their chaos gains 1e10 in 30
TOLERANCE = 1e-9  # rounding grows by about 1e3 in 30 collisions with colloids: 1e-13 is typical

BULK3D = {"dimension": 3, "length": 6, "width": 8, "height": 7}
CHAIN = {"colloids": 3, "length": 21, "gravity": 2.0}
DRIVEN = {"length": 12, "width": 9.5, "gravity": 0.02}
NAMED: dict[str, tuple[str, dict[str, Any]]] = {
    "bulk 2D": ("bulk", {"thermostat": "none", "length": 13, "width": 17, "angle": 130}),
    "bulk 3D, coordinate axes": ("bulk", {**BULK3D, "rotation": "coordinate_axes"}),
    "bulk 3D, random axis": ("bulk", {**BULK3D, "rotation": "random_axis", "angle": 60}),
    "slit, none": ("poiseuille", {**DRIVEN, "thermostat": "none"}),
    "slit, layer": ("poiseuille", {**DRIVEN, "thermostat": "layer"}),
    "slit, monte_carlo": ("poiseuille", {**DRIVEN, "thermostat": "monte_carlo"}),
    "slit, maxwell_boltzmann": ("poiseuille", {**DRIVEN, "thermostat": "maxwell_boltzmann"}),
    "bulk 3D, maxwell_boltzmann": ("bulk", {**BULK3D, "thermostat": "maxwell_boltzmann"}),
    "slit, rescale": ("poiseuille", {**DRIVEN, "thermostat": "rescale"}),
    "slit, andersen": ("poiseuille", {**DRIVEN, "thermostat": "andersen"}),
    "slit, shuffle": ("poiseuille", {**DRIVEN, "hydrodynamics": "shuffle"}),
    "slit, bath": ("poiseuille", {**DRIVEN, "hydrodynamics": "bath"}),
    "colloids": ("channel", CHAIN),
    "colloids, shuffle": ("channel", {**CHAIN, "hydrodynamics": "shuffle"}),
    "colloids, bath": ("channel", {**CHAIN, "hydrodynamics": "bath"}),
}
CLAY: dict[str, dict[str, Any]] = {
    "claylike, cell": {"cells": 6, "density": 5.0, "volume_fraction": 0.1, "peclet": 2.0},
    "claylike, reflection, bottom": {
        "coupling": "reflection",
        "cells": 12,
        "volume_fraction": 0.12,
        "peclet": 2.0,
        "boundaries": "bottom",
        "shear_rate": 0.02,
        "potential": "hertz",
    },
}
NAMED |= {case: ("claylike", fields) for case, fields in CLAY.items()}
CASES: dict[str, Scene] = {
    **{case: make_scene(name, **fields) for case, (name, fields) in NAMED.items()},
    "slit 3D, layer": Slit3D.make(diagonal=True),
    "slit 3D, random axis": Slit3D.make(rotation="random_axis", angle=120, thermostat="none"),
    "slit 3D, bath": Slit3D.make(hydrodynamics="bath"),
    "slit 3D, shuffle": Slit3D.make(hydrodynamics="shuffle", thermostat="monte_carlo"),
    "two species of colloids, slit 3D": Mixture3D.make(),
}
SERIAL = [(case, 1) for case in CASES]
PARALLEL = [
    *(("colloids", ranks) for ranks in (2, 3, 4)),
    *(("slit, layer", ranks) for ranks in (2, 3)),
    ("slit, shuffle", 2),
    ("slit 3D, shuffle", 3),
    ("slit 3D, bath", 3),
    ("colloids, shuffle", 2),
    ("colloids, bath", 2),
    ("bulk 2D", 4),
    ("bulk 3D, random axis", 4),
    ("slit 3D, layer", 2),
    ("two species of colloids, slit 3D", 2),
    ("claylike, cell", 2),
    ("claylike, reflection, bottom", 2),
]


@functools.cache
def reference_after_30(case: str) -> ReferenceEngine:
    engine = SuspensionEngine if case in CLAY else ReferenceEngine
    reference = engine(CASES[case])
    reference.advance(FEWER.get(case, COLLISIONS))
    return reference


@pytest.mark.parametrize(("case", "ranks"), SERIAL + PARALLEL)
def test_every_particle_agrees_after_30_collisions(
    case: str, ranks: int, tmp_path: Path, command: Run
) -> None:
    reference = reference_after_30(case)
    scene = reference.scene
    mpc = run_mpc(scene, reference.collisions, tmp_path, command, ranks)

    assert largest_difference(mpc, reference, scene) < TOLERANCE
    if case == "colloids":
        moved = reference.colloid_velocities[:, 0].mean()
        assert moved > 0.4  # g t = 0.9 less friction: the forces were there

"""The compiled fluid against the reference's measured viscosities and slip.

    python -m pytest -m statistics -s tests/plugin/test_viscosity.py

The grid is that of tests/reference/test_viscosity.py, box by box: the fluid's viscosity depends on
its box. fix mpc itself is held to the reference particle by particle (test_against_reference.py).
"""

import math
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from analysis.run_directory import RunDirectory
from lammps_inputs.scenes.poiseuille import Poiseuille
from lammps_inputs.viscosity import viscosity
from srd_driver import Simulation
from tests.conftest import ROOT
from tests.reference.test_viscosity import FLUID, Point, bulk
from tests.reference.test_walls import fit_parabola

SEED = 1
ERROR = 0.003  # relative standard error that a run is made long enough for


@pytest.fixture(scope="session")
def core_viscosity(tmp_path_factory: pytest.TempPathFactory) -> Path:
    compiler = shutil.which("g++") or shutil.which("clang++")
    if compiler is None:
        pytest.skip("no C++ compiler")
    program = tmp_path_factory.mktemp("core") / "core_viscosity"
    options = "-std=c++17 -O3 -ffp-contract=off -fno-math-errno -fno-trapping-math -Wno-psabi"
    folder = ROOT / "lammps_plugin" / "core"
    source = [f"-I{folder}", str(Path(__file__).parent / "core_viscosity.cpp")]
    subprocess.run([compiler, *options.split(), *source, "-o", program], check=True)
    return program


def measured(program: Path, point: Point, duration: float) -> tuple[float, float]:
    """Viscosity over that of theory, and its standard error."""
    scene = bulk(point)
    theory = viscosity(
        scene.density, scene.collision_time, scene.angle, scene.dimension, scene.rotation
    )
    axis = scene.rotation.partition("_")[0]
    words: list[object] = [SEED, scene.dimension, axis, scene.density, scene.angle]
    words += [scene.collision_time, scene.length, scene.width, scene.shear_wave, theory, duration]
    done = subprocess.run([str(program), *map(str, words)], capture_output=True, check=True)
    value, error = map(float, done.stdout.split())
    return value / theory, error / theory


@pytest.mark.statistics
@pytest.mark.parametrize("point", FLUID, ids=str)
def test_viscosity(core_viscosity: Path, point: Point) -> None:
    duration = 4000.0  # [t0]
    ratio, error = measured(core_viscosity, point, duration)
    while error > ERROR:
        duration *= 1.3 * (error / ERROR) ** 2
        ratio, error = measured(core_viscosity, point, duration)
    print(f"\n{point}: {ratio:.4f} +- {error:.4f} of theory, reference {FLUID[point]}", flush=True)
    known, known_error = FLUID[point]
    # for all points together a false alarm in one of 600 changes of the numbers
    assert abs(ratio - known) < 4 * math.hypot(error, known_error)


@pytest.mark.statistics
@pytest.mark.parametrize(
    ("fields", "known", "known_error"),
    [
        ({"gravity": 0.01, "duration": 30000}, 0.203, 0.011),
        (
            {"length": 20, "width": 10, "density": 5, "gravity": 0.05, "duration": 80000},
            0.200,
            0.006,
        ),
    ],
    ids=["Fig 3.6", "Fig 3.7"],
)
def test_wall_slip(
    tmp_path: Path, fields: dict[str, float], known: float, known_error: float
) -> None:
    """The slip that the published rule (3.14) leaves, as the reference measures it."""
    scene = Poiseuille.make(seed=SEED, **fields)
    with Simulation(scene, "mpc", tmp_path / "run") as simulation:
        simulation.finish()
    fluid = RunDirectory(tmp_path / "run").profile()
    after = fluid.steps * scene.system.clock.time_step > scene.equilibration
    momentum, counts = (fluid.counts * fluid.velocity_x)[after], fluid.counts[after]
    blocks = zip(np.array_split(momentum, 20), np.array_split(counts, 20), strict=True)
    curvature, slip = fit_parabola(np.array([m.sum(0) / n.sum(0) for m, n in blocks]), scene.width)
    lengths = slip / (curvature * scene.width)
    length, error = lengths.mean(), lengths.std(ddof=1) / math.sqrt(len(lengths))
    print(f"\nslip length {length:.4f} +- {error:.4f}, reference {known} +- {known_error}")
    assert abs(length - known) < 4 * math.hypot(error, known_error)

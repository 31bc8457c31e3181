"""Virtual wall particles (3.14): by hand, their statistics, and the slip they remove."""

import numpy as np
import pytest
from numpy.typing import NDArray

from lammps_inputs.scenes.poiseuille import Poiseuille
from lammps_inputs.viscosity import viscosity
from srd_driver.reference import ReferenceEngine
from srd_driver.reference.collision import Cells
from srd_driver.reference.counter_random import CounterRandom, Stream
from srd_driver.reference.walls import cut_cells, mean_with_virtual_particles

SEED = 1


@pytest.mark.parametrize(
    ("width", "shift", "cut_rows"),
    [
        (3.0, 0.25, [True, False, False, True]),
        (3.0, 0.0, [False, False, False, True]),  # the last row is beyond the wall
        (3.5, 0.25, [True, False, False, True, True]),  # the last row is beyond the wall
        (3.5, 0.75, [True, False, False, False, True]),
    ],
)
def test_rows_cut_by_the_walls(width: float, shift: float, cut_rows: list[bool]) -> None:
    cells = Cells((2, len(cut_rows)), np.empty(0, dtype=np.intp))
    expected = np.repeat(cut_rows, 2).tolist()
    assert cut_cells(cells, np.array([0.5, shift]), width).tolist() == expected


def test_mean_with_virtual_particles_by_hand() -> None:
    # cell 0: one particle and 3 virtual ones; cell 1: not cut; cell 2: cut, but full
    numbers = np.array([0, 1, 1, 2, 2, 2, 2, 2])
    velocities = np.array([[4.0, 1, 3, 1, 1, 1, 1, 1], [0.0, 2, 2, 0, 0, 0, 0, 5]])
    random = CounterRandom(1, 0)
    mean = mean_with_virtual_particles(
        velocities, Cells((3, 1), numbers), np.array([True, False, True]), 4.0, random
    )
    zeta = np.sqrt(3) * random.normal(Stream.WALL, 3)[:2, 0]
    np.testing.assert_allclose(mean[:, 0], (np.array([4, 0]) + zeta) / 4, rtol=1e-15)
    np.testing.assert_allclose(mean[:, 1:], [[2, 1], [2, 1]], rtol=1e-15)


def test_zeta_has_the_variance_of_the_missing_particles() -> None:
    # 20 000 cells with 3 of 10 particles at rest: n_f v_cm is a normal of variance 7; the bound is
    # 4.5 standard errors, a false alarm once in 1e5 changes of the generator for each component
    cells = Cells((20_000, 1), np.repeat(np.arange(20_000), 3))
    mean = mean_with_virtual_particles(
        np.zeros((2, 60_000)), cells, np.ones(20_000, dtype=bool), 10.0, CounterRandom(2, 0)
    )
    np.testing.assert_allclose((10 * mean).var(axis=1), 7, rtol=4.5 * np.sqrt(2 / 20_000))


def test_fluid_stays_between_walls_that_are_no_whole_number_of_cells() -> None:
    engine = ReferenceEngine(Poiseuille.make(length=6, width=5.3, sampling_interval=1))
    engine.advance(200)
    y = engine.fluid_positions[:, 1]
    assert y.min() >= 0
    assert y.max() <= 5.3
    assert abs(engine.fluid_temperature() - 1) < 0.2


def fit_parabola(
    profiles: NDArray[np.float64], width: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Curvature and wall value of v_x = slip + curvature y (L_y - y) of each profile.

    Args:
        profiles: v_x in half-cell bins, (K, bins); the cell next to each wall is left out.
    """
    y = (np.arange(profiles.shape[1]) + 0.5) / 2
    basis = np.stack([y * (width - y), np.ones_like(y)]).T[2:-2]
    curvature, slip = np.linalg.lstsq(basis, profiles[:, 2:-2].T, rcond=None)[0]
    return curvature, slip


def parabola(scene: Poiseuille) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Curvature and slip from 20 blocks of time, (20,) each."""
    engine = ReferenceEngine(scene)
    engine.advance(round(scene.equilibration / scene.collision_time))
    bins = round(2 * scene.width)
    profiles = []
    for _ in range(20):
        momentum, count = np.zeros(bins), np.zeros(bins)
        for _ in range(round(scene.duration / scene.collision_time / 20)):
            engine.advance(1)
            bin_ = np.minimum((2 * engine.fluid_positions[:, 1]).astype(int), bins - 1)
            momentum += np.bincount(bin_, engine.fluid_velocities[:, 0], bins)
            count += np.bincount(bin_, minlength=bins)
        profiles.append(momentum / count)
    return fit_parabola(np.array(profiles), scene.width)


@pytest.mark.statistics
@pytest.mark.parametrize(
    ("scene", "paper"),
    [
        (Poiseuille.make(gravity=0.01, duration=6000, seed=SEED), 0.729),
        (
            Poiseuille.make(
                length=20, width=10, density=5, gravity=0.05, duration=16000, seed=SEED
            ),
            0.6179,
        ),
    ],
    ids=["Fig 3.6", "Fig 3.7"],
)
def test_poiseuille_flow_of_the_paper(scene: Poiseuille, paper: float) -> None:
    """The viscosity that (3.15) makes of the maximum, as the paper does, and the slip behind it.

    python -m pytest -m statistics -s tests/reference/test_walls.py
    """
    curvature, slip = parabola(scene)
    top = slip + curvature * scene.width**2 / 4
    theory = viscosity(scene.density, scene.collision_time, scene.angle)
    measured = {
        "nu of the maximum": scene.gravity * scene.width**2 / 8 / top,
        "nu of the curvature": scene.gravity / 2 / curvature,
        "slip / v_max": slip / top,
        "slip length": slip / (curvature * scene.width),
    }
    print(f"\npaper {paper}, theory {theory:.4f}")
    values = {}
    for name, blocks in measured.items():
        values[name] = mean, error = blocks.mean(), blocks.std(ddof=1) / np.sqrt(len(blocks))
        print(f"{name}: {mean:.4f} +- {error:.4f}", flush=True)
    # slip is most of what the paper's maxima have beyond theory; its Fig. 3.7 has 2.6 % more
    nu, error = values["nu of the maximum"]
    assert nu + 4 * error < theory
    assert abs(nu - paper) < (theory - paper) / 3
    # (3.14) leaves a slip length of a0 / 4, where momentum moves by collisions in full cells; less
    # where n fluctuates and some of it flies (docs/reference.md)
    length, error = values["slip length"]
    assert 0.1 < length < 0.25 + 4 * error

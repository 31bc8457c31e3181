"""Virtual wall particles (3.14): by hand, their statistics, and the slip they remove."""

import numpy as np
import pytest

from lammps_inputs import Poiseuille
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


def profile(scene: Poiseuille) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Fluid velocity v_x in half-cell bins, from 20 blocks of the run: y, mean, (20, bins)."""
    engine = ReferenceEngine(scene)
    engine.advance(round(scene.equilibration / scene.collision_time))
    bins = round(2 * scene.width)
    blocks = np.zeros((20, bins))
    collisions = round(scene.duration / scene.collision_time / 20)
    for block in blocks:
        count = np.zeros(bins)
        for _ in range(collisions):
            engine.advance(1)
            bin_ = np.minimum((2 * engine.fluid_positions[:, 1]).astype(int), bins - 1)
            block += np.bincount(bin_, engine.fluid_velocities[:, 0], bins)
            count += np.bincount(bin_, minlength=bins)
        block /= count
    return (np.arange(bins) + 0.5) / 2, blocks.mean(axis=0), blocks


@pytest.mark.statistics
def test_poiseuille_flow_sticks_to_the_walls() -> None:
    """Fig. 3.6: the parabola, its viscosity (3.15) and the slip at the wall.

    python -m pytest -m statistics -s tests/reference/test_walls.py
    """
    scene = Poiseuille.make(gravity=0.01, duration=6000, seed=SEED)
    y, mean, blocks = profile(scene)
    # velocity is measured after a flight of tau_c: half a kick later than the mean over the flight
    y, mean, blocks = y[2:-2], mean[2:-2], blocks[:, 2:-2]
    parabola = np.stack([y * (scene.width - y), np.ones_like(y)]).T
    curvature, slip = np.linalg.lstsq(parabola, mean, rcond=None)[0]
    fits = np.linalg.lstsq(parabola, blocks.T, rcond=None)[0]
    curvature_error, slip_error = fits.std(axis=1, ddof=1) / np.sqrt(len(blocks))
    top = curvature * scene.width**2 / 4
    nu, nu_error = (
        scene.gravity / (2 * curvature),
        curvature_error * scene.gravity / (2 * curvature**2),
    )
    print(
        f"\nv_max {top:.5f}, slip {slip:.5f} +- {slip_error:.5f} ({slip / top:.4f} of v_max), "
        f"nu {nu:.4f} +- {nu_error:.4f}, theory {viscosity(10, 0.1, 90):.4f}"
    )
    assert abs(slip) / top < 0.01
    assert abs(nu / viscosity(10, 0.1, 90) - 1) < 0.02

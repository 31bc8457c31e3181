"""What is known of hard spheres: equation of state, contact values, pressure, collision rate."""

import math
import os

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from srd_driver.events import HardSpheres, WallReactions

Array = NDArray[np.float64]


def carnahan_starling(packing: float) -> float:
    """Z = P V / (N kBT): N. F. Carnahan and K. E. Starling, J. Chem. Phys. 51, 635 (1969)."""
    x = packing
    return (1 + x + x**2 - x**3) / (1 - x) ** 3


def kolafa(packing: float) -> float:
    """Kolafa's correction of it (T. Boublik and I. Nezbeda, Coll. Czech. Chem. C. 51, 2301, 1986).

    At packing 0.35 it is 0.30 % above Carnahan and Starling.
    """
    x = packing
    return (1 + x + x**2 - 2 / 3 * x**3 * (1 + x)) / (1 - x) ** 3


def bulk(packing: float, count: int, seed: int = 1) -> HardSpheres:
    length = (count * math.pi / 6 / packing) ** (1 / 3)
    engine = HardSpheres.fluid(count, 3 * [length], seed=seed)
    engine.advance(20)
    return engine


def fitted_contact(distance: Array, density: Array, reach: float) -> float:
    """Value at distance 0 of a quadratic through the logarithms within `reach`."""
    near = distance < reach
    return float(np.exp(np.polyfit(distance[near], np.log(density[near]), 2)[2]))


@pytest.mark.parametrize("packing", [0.2, pytest.param(0.35, marks=pytest.mark.statistics)])
def test_equation_of_state_and_collision_rate(packing: float) -> None:
    """Blocks of the virial; the error is theirs."""
    engine, blocks = bulk(packing, 2000), []
    collisions, virial, time = engine.collisions, engine.virial, engine.time
    start = virial
    for _ in range(20):
        engine.advance(5.0)
        blocks.append((engine.virial - virial) / (3 * 2000 * 5.0) + 1)
        virial = engine.virial
    z, error = float(np.mean(blocks)), float(np.std(blocks, ddof=1)) / math.sqrt(20)
    assert error < 2e-3 * z
    assert z == pytest.approx(kolafa(packing), abs=3 * error + 5e-4 * z)
    assert z == pytest.approx(carnahan_starling(packing), rel=6e-3)

    # pairs approach with the Rayleigh distribution of twice the variance: mean sqrt(pi)
    count = engine.collisions - collisions
    assert (engine.virial - start) / count == pytest.approx(math.sqrt(math.pi), rel=2e-3)
    contact = (kolafa(packing) - 1) / (4 * packing)
    density = 6 * packing / math.pi
    rate = 4 * math.sqrt(math.pi) * density * contact  # of one particle, sigma = kBT = m = 1
    assert 2 * count / 2000 / (engine.time - time) == pytest.approx(rate, rel=4e-3)


@pytest.mark.parametrize("packing", [0.2, 0.35])
@pytest.mark.statistics
def test_contact_value_of_the_pair_correlation(packing: float) -> None:
    """g(sigma) from positions alone, with a quadratic through the first tenth."""
    engine = bulk(packing, 2000)
    length = engine.lengths[0]
    edges = np.linspace(1, 1.2, 21)
    counts = np.zeros(20)
    for _ in range(150):
        engine.advance(0.3)
        tree = cKDTree(engine.positions % length, boxsize=length)
        pairs = tree.count_neighbors(tree, edges)
        counts += np.diff(pairs)
    ideal = 150 * 2000 * 1999 / length**3 * 4 / 3 * np.pi * np.diff(edges**3)
    contact = fitted_contact((edges[1:] + edges[:-1]) / 2 - 1, counts / ideal, 0.15)
    assert contact == pytest.approx((kolafa(packing) - 1) / (4 * packing), rel=0.012)


@pytest.mark.statistics
def test_wall_pressure_is_the_contact_density() -> None:
    """P = kBT rho at contact (a sum rule): momentum on the walls against the binned density."""
    engine = HardSpheres.fluid(
        1000, [13.0, 13.0, 8.0], walls=(2,), reactions=WallReactions(()), seed=3
    )
    engine.advance(20)
    engine.take_profile()
    before, start = engine.wall_momentum[2], engine.time
    for _ in range(1500):
        engine.advance(0.1)
        engine.sample()
    pressure = (engine.wall_momentum[2] - before) / (engine.time - start) / 169
    assert pressure[0] == pytest.approx(pressure[1], rel=0.02)
    profile = engine.take_profile()
    density = profile.number / profile.samples / profile.width / 169
    density = (density + density[::-1]) / 2
    contact = fitted_contact(profile.positions - 0.5, density, 0.2)
    assert contact == pytest.approx(pressure.mean(), rel=0.02)


@pytest.mark.statistics
def test_energy_and_overlap_over_many_collisions() -> None:
    """NARROWS_COLLISIONS of them, 2e7 if it does not say; 1e9 take 14 minutes on one core."""
    engine = bulk(0.35, 2000)
    energy, done = engine.energy(), engine.collisions
    while engine.collisions - done < float(os.environ.get("NARROWS_COLLISIONS", "2e7")):
        engine.advance(50)
        assert engine.nearest() > 1 - 1e-9
        assert engine.energy() == pytest.approx(energy, rel=1e-10)
    drift = engine.energy() / energy - 1
    print(f"{engine.collisions - done} collisions: energy drifts by {drift:.1e}")


def test_two_disks_in_a_periodic_box_have_the_pressure_of_the_pair() -> None:
    """Exact for two: Z = 1 + V' / (V - V') of the relative disk of radius sigma, V' = pi sigma^2.

    The pair is one point that flies freely in the box outside of a disk (Sinai's billiard); the
    mean free time between its reflections is pi (V - V') / (2 pi sigma u) at the speed u (N.
    Chernov, J. Stat. Phys. 88, 1, 1997).
    """
    edge = 4.0  # the shortest that is allowed
    engine = HardSpheres([[0.4, 0.7], [2.0, 2.1]], [[0.61, -0.35], [-0.61, 0.35]], [edge, edge])
    speed = 2 * math.hypot(0.61, 0.35)
    engine.advance(2e5)
    free = math.pi * (edge**2 - math.pi) / (2 * math.pi * speed)
    rate = engine.collisions / engine.time
    assert rate * free == pytest.approx(1, abs=5e-3)


def test_three_spheres_in_a_narrow_tube_are_those_of_tonks() -> None:
    """Exact in a row: P = N kBT / (L - N sigma) on the ends (L. Tonks, Phys. Rev. 50, 955, 1936).

    Three spheres on one line: elastic collisions only exchange their velocities, so the pressure
    follows from the three speeds v and the length L - 3 sigma that points of no size would have:
    each gives a wall 2 v once in 2 (L - 3 sigma) / v.
    """
    length, speeds = 9.0, np.array([0.3, -1.1, 0.7])
    start = [[1.0, 2, 2], [4.0, 2, 2], [7.5, 2, 2]]
    velocities = np.zeros((3, 3))
    velocities[:, 0] = speeds
    engine = HardSpheres(start, velocities, [length, 4.0, 4.0], walls=(0,))
    engine.advance(5000.0)
    force = engine.wall_momentum[0] / engine.time
    assert force == pytest.approx(np.full(2, np.sum(speeds**2) / (length - 3)), rel=2e-3)
    assert sorted(abs(engine.velocities[:, 0])) == pytest.approx([0.3, 0.7, 1.1], abs=1e-12)

import numpy as np
import pytest
from numpy.typing import NDArray

from analysis.depletion import wall_depletion
from lammps_inputs.scenes.channel import Channel

Array = NDArray[np.float64]


def hard(r: Array) -> Array:
    return np.where(r < 2.0, 1e3, 0.0)


@pytest.mark.parametrize(("distance", "cap"), [(0.0, 2 * np.pi), (1.0, 4 * np.pi / 3 - np.sqrt(3))])
def test_hard_disc_by_hand(distance: float, cap: float) -> None:
    # the cap of a disc of radius 2 beyond the wall; half of it, and the segment of 120 degrees
    assert wall_depletion(hard, 2.0, distance, density=10.0) == pytest.approx(-10 * cap, rel=1e-4)


def test_none_out_of_reach() -> None:
    assert wall_depletion(hard, 2.0, 2.0, density=10.0) == 0.0


def test_colloid_of_the_thesis_against_a_sum_over_a_grid() -> None:
    colloid = Channel.make().colloid_fluid
    step = 0.01
    x, y = np.meshgrid(*2 * [np.arange(-3 + step / 2, 3, step)], indexing="ij")
    r = np.hypot(x, y)
    beyond = (y < -1.3) & (r < colloid.cutoff)
    kept_off = -np.expm1(-colloid.energy(r[beyond])).sum() * step**2
    found = wall_depletion(colloid.energy, colloid.cutoff, 1.3, density=10.0)
    assert found == pytest.approx(-10 * kept_off, rel=2e-3)  # the grid's edge


@pytest.mark.parametrize(("wall_sigma", "least", "most"), [(2.0, 0.0, 1.0), (1.2, 15.0, 30.0)])
def test_walls_of_the_thesis(wall_sigma: float, least: float, most: float) -> None:
    """sigma_w = 1.2 lets a colloid nearer than the colloid lets the fluid: it sticks."""
    scene = Channel.make(wall_sigma=wall_sigma)
    colloid, places = scene.colloid_fluid, np.linspace(0.8, 3.0, 100)
    drawn = [wall_depletion(colloid.energy, colloid.cutoff, y, scene.density) for y in places]
    depth = -(np.array(drawn) + scene.colloid_wall.energy(places)).min()
    assert least < depth < most

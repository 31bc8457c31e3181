"""Pair sums against finite differences of the energy, and against results by hand."""

from collections.abc import Callable

import numpy as np
import pytest

from lammps_inputs.potentials.soft_disk import SoftDisk
from lammps_inputs.potentials.weeks_chandler_andersen import WeeksChandlerAndersen
from srd_driver.reference.soft_pairs import SoftPairs

POTENTIALS = [SoftDisk(sigma=1.1, epsilon=0.8), WeeksChandlerAndersen(sigma=1.2, epsilon=1.3)]
LENGTHS = {2: [5.0, 6.0], 3: [5.0, 6.0, 5.5]}


def fluid(dimension: int, count: int = 40) -> np.ndarray:
    """Positions in the box, no two closer than 0.85, some outside of it."""
    random = np.random.default_rng(1)
    lengths = np.array(LENGTHS[dimension])
    points: list[np.ndarray] = []
    while len(points) < count // (4 - dimension):
        point = random.uniform(0, lengths)
        apart = [p - point - lengths * np.round((p - point) / lengths) for p in points]
        if all(np.linalg.norm(a) > 0.85 for a in apart):
            points.append(point)
    return np.array(points) + lengths * random.integers(-1, 2, (len(points), 1))


def derivative(
    function: Callable[[np.ndarray], float], positions: np.ndarray, step: float = 1e-5
) -> np.ndarray:
    """By central differences, (N, D)."""
    slope = np.zeros_like(positions)
    for index in np.ndindex(positions.shape):
        forth, back = positions.copy(), positions.copy()
        forth[index] += step
        back[index] -= step
        slope[index] = (function(forth) - function(back)) / (2 * step)
    return slope


@pytest.mark.parametrize("potential", POTENTIALS, ids=lambda p: type(p).__name__)
@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("offset", [0.0, 1.7])
def test_gradients_are_finite_differences(
    potential: SoftDisk | WeeksChandlerAndersen, dimension: int, offset: float
) -> None:
    pairs = SoftPairs(potential, LENGTHS[dimension])
    x = fluid(dimension)
    sums = pairs.sums(x, offset)
    scale = np.abs(sums.forces).max()
    forces = -derivative(lambda y: pairs.sums(y, offset).energy, x)
    assert np.abs(sums.forces - forces).max() < 1e-6 * scale
    divergence = 0.0
    for index in np.ndindex(x.shape):
        shift = np.zeros_like(x)
        shift[index] = 1e-5
        difference = pairs.sums(x - shift, offset).forces - pairs.sums(x + shift, offset).forces
        divergence += float(difference[index]) / 2e-5
    assert sums.laplacian == pytest.approx(divergence, rel=1e-6)
    gradient = derivative(lambda y: pairs.sums(y, offset).laplacian, x)
    assert sums.laplacian_gradient == pytest.approx(gradient, abs=1e-6 * np.abs(gradient).max())
    gradient = derivative(lambda y: pairs.sums(y, offset).temperature, x)
    assert sums.temperature_gradient == pytest.approx(gradient, abs=1e-6 * np.abs(gradient).max())
    assert sums.temperature_gradient.sum(axis=0) == pytest.approx(0, abs=1e-9 * scale)


def test_two_soft_disks_by_hand() -> None:
    # r = 1 along x: u = 1, force 12, phi'' = 156; Laplacian of each 156 - 12 = 144
    sums = SoftPairs(SoftDisk(shifted=False), [10.0, 10.0]).sums(np.array([[0.5, 0], [-0.5, 0]]))
    assert sums.energy == 1
    assert sums.forces.tolist() == [[12, 0], [-12, 0]]
    assert sums.virial.tolist() == [[12, 0], [0, 0]]
    assert sums.laplacian == 288
    assert sums.temperature == 1
    # T_conf = 144 r^-26 / (144 r^-14): slope -12 of r, which is x_1 - x_2
    assert sums.temperature_gradient == pytest.approx(np.array([[-12, 0], [12, 0]]))


def test_a_sheared_cell_moves_the_upper_image() -> None:
    pairs = SoftPairs(SoftDisk(), [5.0, 5.0])
    x = np.array([[1.0, 0.1], [3.0, 4.9]])
    assert pairs.sums(x).energy == 0
    assert len(pairs.separations(x, 3.0)[0]) == 1  # the upper image of the first is at 4.0, 5.1
    assert pairs.separations(x, 3.0)[2] == pytest.approx(np.array([[1.0, 0.2]]))


def test_a_cell_in_which_pairs_would_meet_twice_is_refused() -> None:
    with pytest.raises(ValueError, match=r"less than twice 2\.0"):
        SoftPairs(SoftDisk(), [10.0, 3.9])

"""Second virial coefficients against closed forms."""

import math

import numpy as np
import pytest
from scipy import integrate

from analysis.second_virial import effective_diameter, reduced_second_virial, second_virial
from lammps_inputs.potentials.weeks_chandler_andersen import WeeksChandlerAndersen


def test_hard_spheres() -> None:
    distance = np.linspace(1.3, 3.0, 100)
    energy = np.zeros(100)
    assert second_virial(distance, energy) == pytest.approx(2 * math.pi / 3 * 1.3**3)
    assert effective_diameter(distance, energy) == pytest.approx(1.3)
    assert reduced_second_virial(distance, energy) == pytest.approx(1.0)


@pytest.mark.parametrize(("depth", "reach"), [(0.5, 1.5), (3.0, 1.05), (-1.0, 1.2)])
def test_a_square_well_has_its_closed_form(depth: float, reach: float) -> None:
    """B2 = (2 pi sigma^3 / 3) [1 - (lambda^3 - 1)(e^eps - 1)]."""
    distance = np.linspace(1.0, 2.0, 2_000_001)
    energy = np.where(distance < reach, -depth, 0.0)
    closed = 1 - (reach**3 - 1) * (math.exp(depth) - 1)
    hard = 2 * math.pi / 3
    assert second_virial(distance, energy) / hard == pytest.approx(closed, rel=1e-4)
    if depth > 0:
        assert reduced_second_virial(distance, energy) == pytest.approx(closed, rel=1e-4)


def test_soft_repulsion_has_the_diameter_of_barker_and_henderson() -> None:
    pair = WeeksChandlerAndersen()
    cut = 2 ** (1 / 6)
    distance = np.linspace(0.5, cut, 200_001)

    def repelled(r: float) -> float:
        return 1 - math.exp(-(4 * (r**-12 - r**-6) + 1))

    expected = integrate.quad(repelled, 0.0001, cut)[0]
    energy = np.asarray(pair.energy(distance))
    assert effective_diameter(distance, energy) == pytest.approx(expected, rel=1e-4)

import math

import pytest

from analysis.theory import kinematic_viscosity


@pytest.mark.parametrize(
    ("density", "printed", "tolerance"),
    [(10, 0.755, 1e-3), (5, 0.6802, 5e-5)],  # tabatabaei-2009, Figs. 3.6 (0.7556, cut) and 3.7
)
def test_values_the_thesis_prints(density, printed, tolerance):
    assert kinematic_viscosity(density, 0.1, 90, 2) == pytest.approx(printed, abs=tolerance)


def test_3d_by_hand():
    # M = ln 2 has e^-M = 1/2, so q = 1 / (2 ln 2)
    q = 1 / (2 * math.log(2))
    expected = (1 - q) / (18 * 0.5) + 0.5 * (1 + 2 * q) / (4 * (1 - q))
    assert kinematic_viscosity(math.log(2), 0.5, 90, 3) == pytest.approx(expected, rel=1e-14)


def test_3d_is_hechts_equation_28_for_many_particles():
    many, tau = 1e4, 0.7
    printed = (1 - 1 / many) / (18 * tau) + tau * (many + 2) / (4 * (many - 1))
    assert kinematic_viscosity(many, tau, 90, 3) == pytest.approx(printed, rel=1e-6)


def test_where_there_is_no_equation():
    with pytest.raises(ValueError, match="3D rotation by 120 degrees"):
        kinematic_viscosity(10, 0.1, 120, 3)
    with pytest.raises(ValueError, match="diverges at 180"):
        kinematic_viscosity(10, 0.1, 180, 2)

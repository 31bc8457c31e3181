import numpy as np
import pytest

from analysis.configurational_temperature import configurational_temperature, ratio_of_means
from analysis.pair_sums import pair_sums
from lammps_inputs.potentials.soft_disk import SoftDisk
from lammps_inputs.potentials.weeks_chandler_andersen import WeeksChandlerAndersen
from srd_driver.reference.soft_pairs import SoftPairs


@pytest.mark.parametrize("potential", [SoftDisk(cutoff=1.9), WeeksChandlerAndersen()])
@pytest.mark.parametrize("dimension", [2, 3])
def test_brute_force(potential: SoftDisk | WeeksChandlerAndersen, dimension: int) -> None:
    """Against the reference, which looks at every pair."""
    random = np.random.default_rng(4)
    lengths = np.array([5.0, 6.0, 4.5])[:dimension]
    positions = random.uniform(-9, 9, (3, 25, dimension))
    series = pair_sums(positions, lengths, potential.derivatives, potential.cutoff)
    for t, frame in enumerate(positions):
        sums = SoftPairs(potential, lengths).sums(frame)
        assert series.potential_energy[t] == pytest.approx(sums.energy / 25)
        pressure = sums.virial.trace() / dimension / lengths.prod()
        assert series.pressure[t] == pytest.approx(pressure)
        assert series.force_squares[t] == pytest.approx((sums.forces**2).sum())
        assert series.laplacians[t] == pytest.approx(sums.laplacian)


def test_two_soft_disks_by_hand() -> None:
    # at r = 1: phi = 1, force 12, virial 12 over 2 x 100, Laplacian of each 144
    positions = np.array([[[0.5, 3.0], [9.5, 3.0]]])
    potential = SoftDisk(shifted=False)
    series = pair_sums(positions, [10.0, 10.0], potential.derivatives, 2.0)
    assert series.potential_energy.tolist() == [0.5]
    assert series.pressure == pytest.approx([12 / 200])
    assert series.force_squares == pytest.approx([288])
    assert series.laplacians == pytest.approx([288])


def test_a_box_in_which_pairs_would_meet_twice_is_refused() -> None:
    with pytest.raises(ValueError, match="more than half the box"):
        pair_sums(np.zeros((1, 2, 2)), [3.0, 10.0], SoftDisk().derivatives, 2.0)


def test_a_ratio_of_means_is_not_the_mean_ratio() -> None:
    estimate = ratio_of_means(np.array([1.0, 3.0]), np.array([1.0, 7.0]))
    assert estimate.value == 0.5
    with pytest.raises(ValueError, match="denominator is zero"):
        ratio_of_means(np.ones(3), np.zeros(3))


def test_the_error_of_a_ratio_covers_it() -> None:
    """Particles in a harmonic trap of stiffness k: sum F^2 = k^2 r^2, Laplacian k D."""
    random = np.random.default_rng(5)
    off = []
    for _ in range(200):
        r = random.normal(0, np.sqrt(0.7 / 3), (1000, 4, 2))
        noise = random.normal(0, 2, 1000)  # of a potential that is not quite harmonic
        squares = 9 * (r**2).sum(axis=(1, 2)) + 0.7 * noise
        estimate = configurational_temperature(squares, 3 * 2 * 4 + noise)
        assert estimate.value is not None
        assert estimate.error is not None
        off.append((estimate.value - 0.7) / estimate.error)
    assert np.std(off) == pytest.approx(1, abs=0.2)  # 4 deviations of 1/sqrt(400)
    assert np.mean(off) == pytest.approx(0, abs=0.3)

"""Both couplings of hecht-2005, walls on any axis and rotation, in cases done by hand."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from srd_driver.reference import cell_coupling
from srd_driver.reference.boundaries import Boundaries, cut_cells, stream, virtual_particles
from srd_driver.reference.collision import Cells
from srd_driver.reference.counter_random import CounterRandom
from srd_driver.reference.faults import SimulationFault
from srd_driver.reference.reflection import (
    Contacts,
    Spheres,
    find_contacts,
    reflect,
    surfaces,
    thermal_velocities,
)
from srd_driver.reference.rotation import cross, torque, turn

OPEN = Boundaries((20.0, 20.0, 20.0), (True, True, True))
STILL = np.zeros((3, 1))


def sphere(velocity: float = 0.0, spin: float = 0.0, mass: float = 50.0) -> Spheres:
    """Of radius 2 at (10, 10, 10)."""
    one = np.ones(1)
    return Spheres(
        *(np.full((3, 1), 10.0), np.array([[velocity], [0], [0]]), np.array([[0], [0], [spin]])),
        *(2 * one, mass * one, 0.4 * mass * 4 * one),
    )


@pytest.mark.parametrize(
    ("start", "velocity", "contact", "left"),
    [
        ((7.0, 10, 10), (4.0, 0, 0), (-2.0, 0, 0), 0.25),  # ends inside
        ((7.0, 11.99, 10), (12.0, 0, 0), None, None),  # grazes, and ends outside
        ((7.0, 12.01, 10), (12.0, 0, 0), (), None),  # passes by
        ((7.0, 10, 10), (1.0, 0, 0), (), None),  # does not get there
        ((13.0, 10, 10), (4.0, 0, 0), (), None),  # leaves
    ],
)
def test_the_point_and_time_of_entry(
    start: tuple[float, ...],
    velocity: tuple[float, ...],
    contact: tuple[float, ...] | None,
    left: float | None,
) -> None:
    interval = 0.5
    x, v = np.array(start)[:, None], np.array(velocity)[:, None]
    contacts = find_contacts(
        x + interval * v, v, np.array([interval]), sphere(), "entry", interval, STILL, OPEN
    )
    if contact == ():
        assert not contacts.particles.size
        return
    # by hand: from the first distance of 2
    times = np.linspace(0, interval, 200_001)
    distance = np.sqrt(((x + times * v - 10) ** 2).sum(axis=0))
    first = times[np.flatnonzero(distance < 2)[0]]
    assert contacts.left[0] == pytest.approx(interval - first, abs=1e-5)
    assert_allclose(contacts.arms[:, 0], (x + first * v - 10)[:, 0], atol=1e-3)
    if contact:
        assert_allclose(contacts.arms[:, 0], contact, atol=1e-12)
        assert contacts.left[0] == pytest.approx(left)


def test_the_nearest_point_needs_an_end_inside() -> None:
    ends = np.array([[8.5, 11.0], [10.0, 11.9], [10.0, 10.0]])
    v = np.array([[4.0, 12.0], [0.0, 0.0], [0.0, 0.0]])
    contacts = find_contacts(ends, v, np.full(2, 0.5), sphere(), "nearest", 0.5, STILL, OPEN)
    assert list(contacts.particles) == [0]
    assert_allclose(contacts.arms[:, 0], [-2, 0, 0])
    assert contacts.left[0] == 0.25


def test_velocities_that_leave_have_the_printed_distributions() -> None:
    """(13): mean sqrt(pi kBT / 2), mean square 2 kBT; (14): kBT in each tangent. 4 errors."""
    count, temperature = 200_000, 1.7
    arms = np.tile(np.array([[0.6], [0.0], [0.8]]), count)
    index = np.arange(count)
    contacts = Contacts(index, 0 * index, arms, np.zeros((3, count)), np.zeros(count))
    v = thermal_velocities(contacts, temperature, 0, CounterRandom(5, 3), count)
    normal = (v * arms).sum(axis=0)
    assert (normal > 0).all()
    error = 4 / math.sqrt(count)
    assert normal.mean() == pytest.approx(math.sqrt(math.pi * temperature / 2), abs=error)
    assert (normal**2).mean() == pytest.approx(2 * temperature, abs=2 * temperature * error)
    tangents = [v[1], -0.8 * v[0] + 0.6 * v[2]]
    for tangent in tangents:
        assert tangent.mean() == pytest.approx(0, abs=1.4 * error)
        assert (tangent**2).mean() == pytest.approx(temperature, abs=1.5 * temperature * error)
    assert (tangents[0] * tangents[1]).mean() == pytest.approx(0, abs=temperature * error)


def test_the_surface_has_the_velocity_that_its_contacts_leave() -> None:
    """V_s = V + share (V' - V) and omega_s = (omega + omega') / 2 hold after `reflect`."""
    random = np.random.default_rng(3)
    spheres = sphere(velocity=0.3, spin=0.2, mass=5.0)
    direction = random.normal(size=(3, 40))
    direction /= np.sqrt((direction**2).sum(axis=0))
    x = 10 + 2.05 * direction
    v = -2 * direction + 0.3 * random.normal(size=direction.shape)
    x = x + 0.1 * v
    contacts = find_contacts(x, v, np.full(40, 0.1), spheres, "entry", 0.1, STILL, OPEN)
    leaving = thermal_velocities(contacts, 1.0, 0, CounterRandom(9, 0), 40)
    velocity, spin = surfaces(spheres, contacts, leaving)
    given = (
        contacts.velocities - leaving - velocity - cross(spin + 0 * contacts.arms, contacts.arms)
    )
    after = spheres.velocities[:, 0] + given.sum(axis=1) / 5.0
    after_spin = spheres.spins[:, 0] + torque(contacts.arms, given).sum(axis=1) / (0.4 * 5 * 4)
    share = (4 / 3 + math.pi / 6) / 2
    assert contacts.particles.size > 20
    assert_allclose(velocity[:, 0], (1 - share) * spheres.velocities[:, 0] + share * after)
    assert_allclose(spin[:, 0], 0.5 * (spheres.spins[:, 0] + after_spin))


def test_a_contact_keeps_angular_momentum_about_the_centre() -> None:
    """What the sphere gains in spin, the particle loses about the centre."""
    x, v = np.array([[7.9], [10.5], [10.2]]), np.array([[3.0], [0.4], [-0.2]])
    end, after = x + 0.1 * v, v.copy()
    momentum, angular = reflect(
        end, after, sphere(), "entry", 0.1, 1.0, STILL, OPEN, CounterRandom(1, 0)
    )
    assert_allclose(momentum, v - after, atol=1e-14)
    arm = end - 10  # free flight does not change r x v
    assert_allclose(angular, torque(x - 10, v) - torque(arm, after), atol=1e-13)
    assert np.sqrt((arm**2).sum()) > 2


def test_mean_velocity_is_weighted_by_mass() -> None:
    cells = Cells((2, 1), np.array([0, 0, 1]))
    velocities = np.array([[1.0, -2.0, 5.0], [0.0, 4.0, 0.0]])
    mean = cell_coupling.mean_velocity(velocities, np.array([1.0, 9.0, 1.0]), cells)
    assert_allclose(mean, [[-1.7, 5.0], [3.6, 0.0]])


def test_the_thermostat_holds_both_masses_at_its_temperature() -> None:
    """(33) in one cell of 5 fluid particles and one of mass 30: m v^2 of each about the mean."""
    temperature, steps = 2.0, 30_000
    masses = np.array([1.0, 1, 1, 1, 1, 30])
    velocities = np.random.default_rng(2).normal(size=(3, 6))
    cells = Cells((1, 1, 1), np.zeros(6, dtype=np.intp))
    velocities -= (masses * velocities).sum(axis=1, keepdims=True) / masses.sum()
    energies = np.empty(steps)
    for step in range(steps):
        cell_coupling.monte_carlo(velocities, masses, cells, temperature, CounterRandom(1, step))
        energies[step] = 0.5 * (masses * velocities**2).sum()
    assert_allclose((masses * velocities).sum(axis=1), 0, atol=1e-10)
    mean = 0.5 * 3 * 5 * temperature
    blocks = energies[2000:].reshape(20, -1).mean(axis=1)
    assert blocks.mean() == pytest.approx(mean, abs=4 * blocks.std(ddof=1) / math.sqrt(20))


def test_two_pairs_of_walls() -> None:
    """In a tube a particle meets a wall after 0.1; in its frame it goes back as it came."""
    tube = Boundaries((4.0, 4.0, 4.0), (True, False, False), {(1, True): (3.0, 0.0, 0.0)})
    x, v = np.array([[1.0], [3.9], [3.7]]), np.array([[0.0], [1.0], [1.0]])
    stream(x, v, STILL, 0.4, tube)
    assert_allclose(x[:, 0], [1 + 0.3 * 6, 3.7 - 0.1 + 0.1, 3.5], atol=1e-12)
    assert_allclose(v[:, 0], [6, -1, -1])
    with pytest.raises(SimulationFault, match="fluid particle 0 meets the walls"):
        stream(np.array([[1.0], [1.0], [1.0]]), np.array([[0.0], [1e6], [0.0]]), STILL, 1.0, tube)


def test_in_a_corner_fluid_goes_to_and_fro() -> None:
    """Along a chord of 0.001, crossed in 0.0005, from its middle: there again after 1.2."""
    tube = Boundaries((4.0, 4.0, 4.0), (True, False, False))
    half = 0.0005 / math.sqrt(2)
    x, v = np.array([[1.0], [half], [half]]), math.sqrt(2) * np.array([[0.0], [1.0], [-1.0]])
    stream(x, v, STILL, 1.2, tube)
    assert_allclose(x[:, 0], [1, half, half], atol=1e-11)
    assert_allclose(np.abs(v[:, 0]), [0, math.sqrt(2), math.sqrt(2)])


def test_virtual_particles_move_with_their_walls() -> None:
    tube = Boundaries((4.0, 4.0), (True, False), {(1, True): (3.0, 0.0)}, density=10)
    cells = Cells((4, 5), np.zeros(0, dtype=np.intp))
    fluid = np.zeros(20)
    fluid[16:] = 4
    cut = cut_cells(tube, cells, np.array([0.2, 0.3]))
    numbers, momenta = [], []
    for step in range(2000):
        number, momentum = virtual_particles(tube, cut, fluid, 2.0, CounterRandom(4, step))
        numbers.append(number)
        momenta.append(momentum)
    assert_allclose(numbers[0], [10] * 4 + [0] * 12 + [6] * 4)
    sample = np.array(momenta)[:, :, 16:]
    assert sample[:, 0].mean() == pytest.approx(18, abs=4 * math.sqrt(12 / 8000))
    assert sample.var(axis=0).mean() == pytest.approx(12, rel=4 * math.sqrt(2 / 16000))


def test_orientations_turn_with_the_spin() -> None:
    """A quarter turn about z in many small steps brings x to y; the norm stays 1."""
    orientation = np.array([[1.0], [0.0], [0.0], [0.0]])
    spin = np.array([[0.0], [0.0], [math.pi / 2]])
    for _ in range(100):
        orientation = turn(orientation, spin, 0.01)
    assert_allclose(orientation[:, 0], [math.cos(math.pi / 4), 0, 0, math.sin(math.pi / 4)])
    free = turn(np.array([[0.5], [0.5], [0.5], [0.5]]), np.array([[0.3], [-2.0], [5.0]]), 0.7)
    assert (free**2).sum() == pytest.approx(1, rel=1e-14)

"""Cells and rotations: small cases by hand, conservation for any state, Galilean invariance."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from lammps_inputs import InitialState
from lammps_inputs.scenes.bulk import Bulk
from lammps_inputs.system import Rotation
from srd_driver.reference import ReferenceEngine
from srd_driver.reference.collision import (
    Cells,
    collide,
    coordinate_axes,
    grid_shape,
    random_axes,
    rotate,
    signs,
)
from srd_driver.reference.counter_random import CounterRandom, Stream, uniform
from tests.parts import solvent_of

Array = NDArray[np.float64]

KINDS: list[tuple[int, float, Rotation]] = [
    (2, 90.0, "coordinate_axes"),
    (2, 130.0, "coordinate_axes"),
    (3, 90.0, "coordinate_axes"),
    (3, 130.0, "random_axis"),
]


def test_cell_numbers_by_hand() -> None:
    positions = np.array([[0.2, 3.9, 1.5], [0.2, 0.4, 2.7]])
    shift = np.array([0.3, 0.5])
    periodic = Cells.sort(positions, shift, (4, 3), (True, True))
    assert periodic.numbers.tolist() == [0, 0, 1 + 4 * 0]  # 4.2 wraps to 0; 3.2 wraps to 0
    slit = Cells.sort(positions, shift, (4, 4), (True, False))
    assert slit.numbers.tolist() == [0, 0, 1 + 4 * 3]


def test_numbers_run_along_x_then_y_then_z() -> None:
    cells = Cells.sort(np.array([[1.5], [2.5], [3.5]]), np.zeros(3), (5, 6, 7), (True,) * 3)
    assert cells.numbers.tolist() == [1 + 5 * (2 + 6 * 3)]
    assert cells.rows[cells.numbers[0]] == 2


@pytest.mark.parametrize(
    ("box", "periodic", "shape"),
    [
        ((4.0, 10.0), (True, True), (4, 10)),
        ((4.0, 10.0), (True, False), (4, 11)),
        ((4.0, 10.5), (True, False), (4, 12)),
        ((4.0, 5.0, 6.0), (True, True, True), (4, 5, 6)),
    ],
)
def test_grid_has_one_more_row_between_walls(
    box: tuple[float, ...], periodic: tuple[bool, ...], shape: tuple[int, ...]
) -> None:
    assert grid_shape(box, periodic) == shape


def test_particle_at_the_wall_with_the_largest_shift_has_a_cell() -> None:
    largest = 1 - 2.0**-53
    cells = Cells.sort(np.array([[0.5], [10.0]]), np.array([0.0, largest]), (4, 11), (True, False))
    assert cells.numbers[0] // 4 == 10


def test_two_particles_turned_by_ninety_degrees() -> None:
    velocities = np.array([[1.0, 3.0], [0.0, 0.0]])
    cells = Cells((1, 1), np.zeros(2, dtype=np.intp))
    random = CounterRandom(1, 0)
    sign = signs(random, 1)[0]
    collide(velocities, cells, cells.mean_velocity(velocities), 90, "coordinate_axes", random)
    np.testing.assert_allclose(velocities, [[2, 2], [-sign, sign]], atol=1e-15)


def test_rotations_are_right_handed() -> None:
    x, z = np.array([[1.0], [0], [0]]), np.array([[0], [0], [1.0]])
    np.testing.assert_allclose(rotate(x, z, np.pi / 2)[:, 0], [0, 1, 0], atol=1e-15)


def test_axes_and_signs_are_uniform() -> None:
    # 4.5 standard errors: a false alarm once in 1e5 changes of the generator for each number
    n, random = 60_000, CounterRandom(3, 5)
    assert abs(signs(random, n).mean()) < 4.5 / np.sqrt(n)
    axes = random_axes(random, n)
    np.testing.assert_allclose((axes**2).sum(axis=0), 1, rtol=1e-14)
    assert (abs(axes.mean(axis=1)) < 4.5 * np.sqrt(1 / 3 / n)).all()
    np.testing.assert_allclose((axes**2).mean(axis=1), 1 / 3, atol=4.5 * np.sqrt(4 / 45 / n))
    six, counts = np.unique(coordinate_axes(random, n), axis=1, return_counts=True)
    assert six.shape == (3, 6)
    np.testing.assert_allclose(counts, n / 6, atol=4.5 * np.sqrt(n * 5 / 36))


def test_coordinate_axes_are_listed_in_the_documented_order() -> None:
    axes = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
    random = CounterRandom(3, 5)
    drawn = coordinate_axes(random, 50).T
    for axis, u in zip(drawn, uniform(random.mixed(Stream.ROTATION, 50))[0], strict=True):
        assert tuple(axis) == axes[int(6 * u)]


@st.composite
def states(draw: st.DrawFn) -> tuple[Bulk, InitialState]:
    """Any periodic fluid: crowded or empty cells, slow and fast particles, a mean flow."""
    dimension, angle, rotation = draw(st.sampled_from(KINDS))
    size = draw(st.integers(2, 5))
    density = draw(st.sampled_from([0.5, 3.0, 20.0]))
    scene = Bulk.make(
        dimension=dimension,
        length=size,
        width=draw(st.integers(2, 5)),
        density=density,
        angle=angle,
        rotation=rotation,
        collision_time=draw(st.sampled_from([0.01, 0.3, 4.0])),
        thermostat="none",
        seed=draw(st.integers(1, 2**31 - 1)),
    )
    random = np.random.default_rng(draw(st.integers(0, 2**32)))
    particles = solvent_of(scene).particles
    spread = draw(st.sampled_from([1.0, 0.02]))
    none = np.empty((0, dimension))
    return scene, InitialState(
        random.random((particles, dimension)) * scene.system.box.sizes * spread,
        random.normal(size=(particles, dimension)) * draw(st.sampled_from([1e-3, 1.0, 30.0]))
        + draw(st.sampled_from([0.0, 5.0])),
        none,
        none,
    )


@given(states())
@settings(deadline=None)
def test_momentum_and_energy_are_conserved(case: tuple[Bulk, InitialState]) -> None:
    scene, state = case
    engine = ReferenceEngine(scene, state)
    scale = np.sqrt(np.mean(state.fluid_velocities**2))
    for _ in range(3):
        momentum, energy = engine.mean_velocity(), engine.energy()
        engine.advance(1)
        assert abs(engine.mean_velocity() - momentum).max() <= 1e-12 * scale
        assert abs(engine.energy() - energy) <= 1e-12 * energy


@given(states())
@settings(deadline=None)
def test_collision_conserves_every_cell(case: tuple[Bulk, InitialState]) -> None:
    scene, state = case
    box = scene.system.box
    shape = grid_shape(box.sizes, box.periodic)
    velocities = state.fluid_velocities.T.copy()
    cells = Cells.sort(state.fluid_positions.T, np.full(len(shape), 0.3), shape, box.periodic)
    before, energy = cells.sum(velocities), cells.sum((velocities**2).sum(axis=0))
    random = CounterRandom(scene.seed, 0)
    collide(velocities, cells, cells.mean_velocity(velocities), scene.angle, scene.rotation, random)
    scale = abs(velocities).max() * max(1, cells.occupation.max())
    np.testing.assert_allclose(cells.sum(velocities), before, atol=1e-12 * scale)
    np.testing.assert_allclose(cells.sum((velocities**2).sum(axis=0)), energy, rtol=1e-12)


class TestGalileanInvariance:
    """With the grid shift a uniform flow changes nothing on average; without it, it does.

    Ihle and Kroll's case: at a small mean free path particles stay in the cell of a fixed grid and
    collide with the same partners, so that the velocity of one is remembered for longer than in a
    frame in which the particles are carried across cells.
    """

    steps = 6

    def correlation(self, flow: float, shifted: bool, monkeypatch: pytest.MonkeyPatch) -> float:
        """Velocity autocorrelation, in the frame of the flow, after some collisions."""
        if not shifted:
            monkeypatch.setattr(
                "srd_driver.reference.engine.grid_shift", lambda random, dimensions: np.zeros(2)
            )
        scene = Bulk.make(
            length=60, width=60, density=5, collision_time=0.02, angle=120, thermostat="none"
        )
        engine = ReferenceEngine(scene)
        engine.advance(20)
        engine.fluid_velocities[:, 0] += flow / scene.collision_time
        start = engine.fluid_velocities - [flow / scene.collision_time, 0]
        engine.advance(self.steps)
        end = engine.fluid_velocities - [flow / scene.collision_time, 0]
        return float(np.mean(start * end))

    def test_with_and_without_shift(self, monkeypatch: pytest.MonkeyPatch) -> None:
        # each correlation has a standard error below sqrt(1 / (2 N)) = 0.005; flow of half a cell
        # a collision. Bounds at 6 errors of a difference: a false alarm below once in 1e8
        shifted = [self.correlation(flow, True, monkeypatch) for flow in (0.0, 0.5)]
        fixed = [self.correlation(flow, False, monkeypatch) for flow in (0.0, 0.5)]
        bound = 6 * np.sqrt(2) / np.sqrt(2 * 18000)
        assert abs(shifted[1] - shifted[0]) < bound
        assert abs(fixed[1] - fixed[0]) > bound

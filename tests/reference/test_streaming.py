"""Streaming and bounce-back: by hand, against brute force, and the paper's printed forms."""

import functools

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from srd_driver.reference import SimulationFault
from srd_driver.reference.streaming import contact_time, stream

Array = NDArray[np.float64]


def column(*components: float) -> Array:
    return np.array(components, dtype=float)[:, None]


def streamed(
    position: Array, velocity: Array, acceleration: Array, time: float, width: float
) -> tuple[Array, Array]:
    r, v = position.copy(), velocity.copy()
    stream(r, v, acceleration, time, width)
    return r, v


def brute_force(
    position: Array, velocity: Array, acceleration: Array, time: float, width: float, steps: int
) -> tuple[Array, Array]:
    """Tiny exact flights, the velocity reversed at the end of one that leaves the slit."""
    r, v, dt = position.copy(), velocity.copy(), time / steps
    for _ in range(steps):
        end = r + dt * v + 0.5 * dt**2 * acceleration
        if not 0 <= end[1, 0] <= width:
            v = -v
            end = r + dt * v + 0.5 * dt**2 * acceleration
        r, v = end, v + dt * acceleration
    return r, v


def test_free_flight_in_three_dimensions() -> None:
    r, v = column(1, 2, 3), column(1, -1, 0.5)
    stream(r, v, column(2, 0, 0), 0.5)
    np.testing.assert_array_equal(r[:, 0], [1.75, 1.5, 3.25])
    np.testing.assert_array_equal(v[:, 0], [2, -1, 0.5])


def test_bounce_by_hand() -> None:
    # meets y = 0 half-way, at x = 1 + 0.5 + 0.125 with v_x = 1.5, and flies on from there
    r, v = streamed(column(1, 0.5), column(1, -1), column(1, 0), 1.0, 10.0)
    np.testing.assert_allclose(r[:, 0], [1.625 - 0.75 + 0.125, 0.5], rtol=1e-15)
    np.testing.assert_allclose(v[:, 0], [-1.5 + 0.5, 1], rtol=1e-15)


def test_two_walls_in_one_step() -> None:
    r, v = streamed(column(0, 1), column(0, 3), column(0, 0), 2.0, 2.0)
    np.testing.assert_allclose(r[1, 0], 1.0, rtol=1e-14)  # 1 up, 2 down, 2 up, 1 down: 6 in all
    np.testing.assert_allclose(v[1, 0], -3.0 * (-1) ** 2, rtol=1e-14)


@given(
    y=st.floats(0.001, 1.999),  # on a wall, a subnormal velocity decides who bounces
    v_x=st.floats(-3, 3),
    v_y=st.floats(-3, 3),
    a_x=st.floats(-2, 2),
    a_y=st.floats(0, 2),
)
@settings(deadline=None, max_examples=50)
def test_against_brute_force(y: float, v_x: float, v_y: float, a_x: float, a_y: float) -> None:
    # a_y pushes to the upper wall: towards the lower one no particle turns back on its own, unless
    # it would dip through it and come back within the step, which streaming says it does not see
    r, v, a, time, steps = column(0.0, y), column(v_x, v_y), column(a_x, a_y), 1.0, 4000
    dips = v_y < 0 and a_y > 0 and -v_y / a_y < time and v_y**2 / (2 * a_y) > y
    pressed = a_y > 0 and v_y**2 + 2 * a_y * (2.0 - y) < 0.1  # bounces without end at the wall
    assume(not dips and not pressed)
    exact_r, exact_v = streamed(r, v, a, time, 2.0)
    rough_r, rough_v = brute_force(r, v, a, time, 2.0, steps)
    bound = 60 * time / steps  # each of at most 5 bounces is late by at most one tiny flight
    np.testing.assert_allclose(exact_r, rough_r, atol=bound)
    assert min(abs(exact_v - rough_v).max(), abs(exact_v + rough_v).max()) < bound


@given(
    y=st.floats(0.0, 10.0),
    v_y=st.floats(0.05, 5) | st.floats(-5, -0.05),
    a_y=st.floats(-5, 5),
    time=st.floats(0.001, 0.5),
)
@settings(deadline=None)
def test_ends_between_the_walls(y: float, v_y: float, a_y: float, time: float) -> None:
    # the speed at a contact is at least 0.05: fewer than time a_y / (2 x 0.05) = 25 bounces
    r, v = streamed(column(0, y), column(0.3, v_y), column(0.1, a_y), time, 10.0)
    assert 0 <= r[1, 0] <= 10
    assert np.isfinite(v).all()


def test_reversal_in_time() -> None:
    # bounce-back without a field retraces its path when the final velocity is reversed
    random = np.random.default_rng(1)
    r = random.random((2, 1000)) * [[10], [2]]
    v = random.normal(size=(2, 1000)) * 5
    start, none = r.copy(), column(0, 0)
    stream(r, v, none, 1.0, 2.0)
    v *= -1
    stream(r, v, none, 1.0, 2.0)
    np.testing.assert_allclose(r, start, atol=1e-12)


def test_pressed_against_a_wall_is_a_fault() -> None:
    with pytest.raises(SimulationFault, match="fluid particle 0 meets the walls more than 100"):
        streamed(column(0, 1e-9), column(0, -1e-6), column(0, -1e6), 1.0, 10.0)


class TestErrata:
    """(3.12), (3.13) and (3.44) as printed fail against brute force; the corrected forms hold."""

    x, y, v_x, v_y, g, time = 0.4, 0.3, 0.8, -1.0, 2.0, 1.0

    steps = 100_000  # the brute-force bounce is late by at most 1e-5: x and v_x by less than 1e-4

    @classmethod
    @functools.cache
    def truth(cls) -> tuple[float, float]:
        r, v = brute_force(
            column(cls.x, cls.y),
            column(cls.v_x, cls.v_y),
            column(cls.g, 0),
            cls.time,
            10.0,
            cls.steps,
        )
        return r[0, 0], v[0, 0]

    def test_engine(self) -> None:
        r, v = streamed(
            column(self.x, self.y), column(self.v_x, self.v_y), column(self.g, 0), self.time, 10.0
        )
        np.testing.assert_allclose((r[0, 0], v[0, 0]), self.truth(), atol=1e-4)

    def test_printed_3_12_and_3_13(self) -> None:
        v_contact = self.v_x + self.g * self.time
        printed = self.x - self.v_x * self.time - 2 * self.y * v_contact / self.v_y
        assert abs(printed - self.truth()[0]) > 0.5

    def test_corrected_3_12_and_3_13(self) -> None:
        t_c = -self.y / self.v_y
        v_contact = self.v_x + self.g * t_c
        x = (
            self.x
            - self.v_x * self.time
            + 2 * self.v_x * t_c
            + self.g * (self.time - 2 * t_c) ** 2 / 2
        )
        v = -v_contact + self.g * (self.time - t_c)
        np.testing.assert_allclose((x, v), self.truth(), atol=1e-4)

    def test_3_44(self) -> None:
        # y + v t + F t^2 / (2 m) = 0 with F = -1.5 towards the wall at y = 0
        distance, towards, force = 0.3, 0.5, 1.5
        exact = contact_time(*(np.array([value]) for value in (distance, towards, force)))[0]
        printed = (-towards + np.sqrt(towards**2 + 4 * force * distance)) / (2 * force)
        steps = 100_000
        t = np.arange(1, steps + 1) / steps
        reached = t[np.argmax(np.cumsum((towards + force * (t - 0.5 / steps)) / steps) > distance)]
        assert abs(exact - reached) < 2 / steps
        assert abs(printed - reached) > 0.05

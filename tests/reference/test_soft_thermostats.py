"""The thermostats of lane formation: constraint, reversibility, order of the error."""

from collections.abc import Callable
from typing import Any, Literal

import numpy as np
import pytest

from srd_driver.reference.configurational import Configurational
from srd_driver.reference.gear import Gear
from srd_driver.reference.isokinetic import Isokinetic, friction, kick
from srd_driver.reference.isothermal import Isothermal
from tests.plugin.lanes import mixture

START = mixture(2)
STATE = (START.pairs, START.positions, START.velocities, START.masses, START.field, 0.9)


def squares(run: Isokinetic) -> float:
    return float((run.masses[:, None] * run.velocities[:, run.held] ** 2).sum())


@pytest.mark.parametrize(("held", "rate"), [((0, 1), 0.0), ((0,), 0.0), ((1,), 0.0), ((0, 1), 2.0)])
def test_the_kinetic_energy_of_what_is_held_is_constant_to_rounding(
    held: tuple[int, ...], rate: float
) -> None:
    run = Isokinetic(*STATE, held, rate)
    for _ in range(200):
        run.step(0.002)
        assert squares(run) == pytest.approx(run.squares, rel=1e-14)
    assert run.squares == pytest.approx((len(held) * 119 - 1) * 0.9)


@pytest.mark.parametrize("held", [(0, 1), (1,)])
def test_the_isokinetic_step_is_reversible(held: tuple[int, ...]) -> None:
    run = Isokinetic(*STATE, held)
    run.step(1e-9)  # onto the constraint
    positions, velocities = run.positions.copy(), run.velocities.copy()
    for _ in range(100):
        run.step(0.002)
    assert np.abs(run.positions - positions).max() > 0.1
    run.velocities *= -1
    for _ in range(100):
        run.step(0.002)
    assert run.positions == pytest.approx(positions, abs=1e-10)
    assert run.velocities == pytest.approx(-velocities, abs=1e-10)


def test_a_kick_solves_its_equation() -> None:
    """Against (2) and (3) with constant forces in 2000 small steps."""
    random = np.random.default_rng(3)
    v, f, m = random.normal(size=(5, 2)), random.normal(size=(5, 2)), random.uniform(1, 2, 5)
    total = float((m[:, None] * v**2).sum())
    once = kick(v, f, m, 0.7, total)
    u = v.copy()
    for _ in range(2000):
        half = u + 0.7 / 4000 * (f / m[:, None] - friction(u, f, m) * u)
        u = u + 0.7 / 2000 * (f / m[:, None] - friction(half, f, m) * half)
    assert once == pytest.approx(u, abs=1e-7)
    assert kick(v, 0 * f, m, 0.7, total) == pytest.approx(v)


@pytest.mark.parametrize("kind", ["kinetic", "configurational"])
@pytest.mark.parametrize("rate", [0.0, 1.5])
def test_splitting_and_gear_converge_to_one_trajectory(
    kind: Literal["kinetic", "configurational"], rate: float
) -> None:
    """The splitting with the square of the step, Gear's method faster; both to the same end."""
    equations = Isothermal(kind, *STATE, rate)
    time = 0.032
    exact = equations.gear(0.000125, time)

    def error(method: Callable[..., Any], dt: float) -> float:
        return float(np.abs(method(dt, time) - exact).max())

    assert 3.3 < error(equations.split, 0.0005) / error(equations.split, 0.00025) < 4.7
    coarse, fine = error(equations.gear, 0.002), error(equations.gear, 0.001)
    assert coarse / fine > 8
    assert fine < 0.2 * error(equations.split, 0.001)


def test_gear_is_exact_for_a_polynomial_of_its_order() -> None:
    """dy/dt = 4 t^3 with t as a second unknown: y = t^4."""
    run = Gear(lambda y: np.array([4 * y[1] ** 3, 1.0]), np.zeros(2), 0.1)
    for _ in range(10):
        run.step()
    assert run.y == pytest.approx([1, 1], abs=1e-12)


def test_the_configurational_thermostat_leaves_momentum_alone() -> None:
    run = Configurational(*STATE)
    momentum = (run.masses[:, None] * run.velocities).sum(axis=0)
    for _ in range(100):
        run.step(0.001)
    assert (run.masses[:, None] * run.velocities).sum(axis=0) == pytest.approx(momentum, abs=1e-10)
    assert abs(run.multiplier) > 0.01

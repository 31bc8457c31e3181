"""Two conservation laws: exact Riemann solutions, diffusion of pressure, what is conserved."""

import numpy as np
import pytest
from numpy.typing import NDArray

from analysis.two_fluid import TwoFluid

Array = NDArray[np.float64]

CELL = 1.0
C, C0 = 5.0, 0.02  # J = rho (C0 + C rho): convex, as in the channel


def points_in_a_fluid_at_rest() -> TwoFluid:
    """Colloids without area that drag no fluid: one conservation law is left."""
    return TwoFluid(lambda r: C0 + C * r, np.zeros_like, 0.0, 12.0, 0.0, 10.0)


def block(
    density: float, left: int = 100, right: int = 300, cells: int = 600, outside: float = 0.0
) -> Array:
    rho = np.full(cells, outside)
    rho[left:right] = density
    return rho


def test_shock_moves_at_the_rankine_hugoniot_velocity() -> None:
    high, low, times = 0.02, 0.005, np.array([200.0, 400.0])
    rho, fluid = points_in_a_fluid_at_rest().solve(block(high, outside=low), CELL, times)
    velocity = C0 + C * (high + low)  # (J(high) - J(low)) / (high - low)
    ahead = rho[:, 310:]  # behind it is the fan
    jump = 310 + np.count_nonzero(ahead > (high + low) / 2, axis=1)
    assert jump * CELL == pytest.approx(300 + velocity * times, abs=1.0)
    width = np.count_nonzero((ahead > 1.05 * low) & (ahead < 0.95 * high), axis=1)
    assert width.max() <= 6
    assert abs(width[1] - width[0]) <= 1  # it does not spread
    assert fluid == pytest.approx(1.0, abs=1e-12)


def test_rarefaction_fan_behind_the_block_and_convergence() -> None:
    high, time = 0.02, 800.0
    errors = []
    for refined in (1, 2, 4):
        rho, _ = points_in_a_fluid_at_rest().solve(
            np.repeat(block(high), refined), CELL / refined, [time]
        )
        x = (np.arange(rho.shape[1]) + 0.5) * CELL / refined
        exact = np.clip(((x - 100) / time - C0) / (2 * C), 0, high)  # x / t = J'(rho)
        errors.append(np.abs(rho[0] - exact)[x < 300].mean() / high)
    assert errors[0] < 0.01
    assert errors[1] < errors[0] / 1.5
    assert errors[2] < errors[1] / 1.5


def test_concave_current_turns_the_ends_round() -> None:
    law = TwoFluid(lambda r: 0.2 * (1 - r / 0.04), np.zeros_like, 0.0, 12.0, 0.0, 10.0)
    rho, _ = law.solve(block(0.02), CELL, [800.0])
    rising, falling = (
        np.count_nonzero((part > 1e-3) & (part < 0.019)) for part in (rho[0][:300], rho[0][300:])
    )
    assert rising < 12 < 60 < falling  # J' = 0.2 (1 - 50 rho): shock at the tail, fan at the head


def test_pressure_diffuses_to_balance_colloids_that_are_held() -> None:
    pull, permeability, n_f, cells = 0.3, 0.2, 10.0, 100
    law = TwoFluid(np.zeros_like, lambda r: np.full_like(r, pull), permeability, 12.0, 0.0, n_f)
    k = 2 * np.pi / (cells * CELL)
    x = (np.arange(cells) + 0.5) * CELL
    small, times = 1e-4, np.array([50.0, 150.0])
    _, fluid = law.solve(small * (1 + np.cos(k * x)), CELL, times)
    rate = n_f * permeability * k**2
    final = small * 12.0 * pull / (permeability * n_f * k)  # K d_x p = the uneven part of the pull
    amplitude = 2 / cells * (fluid - 1) @ np.sin(k * x)
    assert amplitude == pytest.approx(final * (1 - np.exp(-rate * times)), rel=0.003)


def test_both_contents_are_conserved_and_fluid_piles_up_at_the_head() -> None:
    law = TwoFluid(
        lambda r: 0.02 + 5.7 * r, lambda r: np.full_like(r, 0.3), 0.19, 12.57, 12.57, 10.0
    )
    start = block(0.02, cells=500)
    rho, fluid = law.solve(start, CELL, [0.0, 50.0, 300.0])
    fraction = 12.57 * rho
    mass = fluid * (1 - fraction) + fraction
    assert rho.sum(axis=1) == pytest.approx(start.sum(), rel=1e-12)
    assert mass.sum(axis=1) == pytest.approx(len(start), rel=1e-12)
    assert fluid[0] == pytest.approx(1.0)
    assert fluid[-1][320:350].max() > 1.2  # ahead
    assert fluid[-1][80:110].min() < 0.9  # behind
    assert rho.min() > -1e-12


def test_uniform_state_stays_and_moves_with_the_measured_speed() -> None:
    law = TwoFluid(lambda r: 0.02 + 5.7 * r, lambda r: np.full_like(r, 0.3), 0.19, 12.57, 12.57, 10)
    rho, fluid = law.solve(np.full(50, 0.015), CELL, [200.0])
    assert rho == pytest.approx(0.015)
    assert fluid == pytest.approx(1.0)

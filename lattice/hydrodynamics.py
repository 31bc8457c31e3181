"""Hydrodynamics on the Euler scale: d sigma/dt + d j(sigma)/dx = 0 (2.60), and what it predicts.

Coordinates: x = k/L in [0, 1], time t' = t/L (2.55), so that speeds are in sites per unit of time.
The conserved density u is the charge sigma or the particle density rho; every other local average
has its stationary value at that u, which for the charge family is rho*(sigma) (2.59).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from lattice.generator import require_time
from lattice.models import LatticeGas, RateError, Vector
from lattice.shocks import ShockWalk

_GRID = 4001  # densities at which extrema of j are bracketed: extrema closer than 1/4000 merge


def stationary_particle_density(sigma: Vector, r: float) -> Vector:
    """rho*(sigma): the solution in [|sigma|, 1] of rho^2 - sigma^2 = 4 r (1 - rho)^2 (2.59).

    Takes and returns arrays of one shape; written without the 0/0 of the textbook root at r = 1/4.
    """
    sigma = np.asarray(sigma, dtype=float)
    return np.asarray(
        (4 * r + sigma**2) / (4 * r + np.sqrt(4 * r + (1 - 4 * r) * sigma**2))
        if r > 0
        else np.abs(sigma)
    )


@dataclass(frozen=True)
class CurrentRelation:
    """Stationary current j(u) of a conserved density u in [low, high], with its derivative.

    `flux` and `speed` (the characteristic speed j'(u)) map arrays to arrays of the same shape.
    """

    flux: Callable[[Vector], Vector]
    speed: Callable[[Vector], Vector]
    low: float
    high: float

    @cached_property
    def extrema(self) -> Vector:
        """Densities inside (low, high) where j'(u) = 0, shape (number of extrema,)."""
        grid = np.linspace(self.low, self.high, _GRID)
        slope = self.speed(grid)
        roots = [float(u) for u in grid[1:-1][slope[1:-1] == 0]]
        for i in np.flatnonzero(slope[:-1] * slope[1:] < 0):
            roots.append(brentq(lambda u: float(self.speed(np.array(u))), grid[i], grid[i + 1]))
        return np.array(sorted(roots))

    def godunov_flux(self, left: Vector, right: Vector) -> Vector:
        """Flux at x = 0 of the Riemann problem left | right, arrays of one shape.

        The minimum of j on [left, right] if left <= right, else its maximum.  With reservoirs for
        `left` and `right` it is the current of the open chain (extremal-current principle).
        """
        rising = left <= right
        ends = self.flux(left), self.flux(right)
        result = np.where(rising, np.minimum(*ends), np.maximum(*ends))
        for u, j in zip(self.extrema, self.flux(self.extrema), strict=True):
            inside = (np.minimum(left, right) < u) & (u < np.maximum(left, right))
            extreme = np.where(rising, np.minimum(result, j), np.maximum(result, j))
            result = np.where(inside, extreme, result)
        return np.asarray(result)

    def rankine_hugoniot(self, left: float, right: float) -> float:
        """Velocity (j_R - j_L)/(u_R - u_L) of a jump, positive to the right."""
        if left == right:
            raise RateError("equal densities on both sides: no jump")
        jump = self.flux(np.array([left, right]))
        return float((jump[1] - jump[0]) / (right - left))


def current_relation(model: LatticeGas) -> CurrentRelation:
    """j(u) of a model whose product measures are stationary.

    Charge family: (2.48) on rho*(sigma) (2.59); internal-state family: (2.126), which is (2.128) on
    the shock manifold; ASEP: (p - q) rho (1 - rho), also the charge family without B.
    """
    if model.family == "charge" and model.ratio > 0:
        a, b, r = model.w(4, 2) - model.w(2, 4), model.w(8, 6) - model.w(6, 8), model.ratio

        def flux(sigma: Vector) -> Vector:
            rho = stationary_particle_density(sigma, r)
            return np.asarray(
                a / 2 * (rho + sigma) * (1 - sigma) + b / 2 * (rho - sigma) * (1 + sigma)
            )

        def speed(sigma: Vector) -> Vector:
            rho = stationary_particle_density(sigma, r)
            slope = sigma / (rho + 4 * r * (1 - rho))  # d rho*/d sigma, from (2.59)
            return np.asarray(
                a / 2 * ((slope + 1) * (1 - sigma) - rho - sigma)
                + b / 2 * ((slope - 1) * (1 + sigma) + rho - sigma)
            )

        return CurrentRelation(flux, speed, -1.0, 1.0)
    # one density only: j = drive * u (1 - u), read off at u = 1/2 where (1 + c) z = 1
    drive = 4 * model.current(1 / (1 + model.ratio))
    return CurrentRelation(lambda u: drive * u * (1 - u), lambda u: drive * (1 - 2 * u), 0.0, 1.0)


def solve(
    relation: CurrentRelation,
    initial: Vector,
    times: Vector,
    reservoirs: tuple[float, float] | None = None,
) -> Vector:
    """Entropy solution of (2.60) at increasing `times` from cell averages, shape (T, N).

    First-order Godunov scheme on N equal cells of [0, 1] at Courant number 0.9: monotone, so shocks
    carry no oscillation, move at the Rankine-Hugoniot velocity, and rarefactions are no expansion
    shocks.  `reservoirs` are the densities outside x = 0 and x = 1; without them the chain is a
    ring.  Raises `RateError` for densities outside the range of the relation.
    """
    u = np.array(initial, dtype=float)
    outside = np.concatenate([u, np.array(reservoirs or ())])
    if outside.min() < relation.low - 1e-12 or outside.max() > relation.high + 1e-12:
        raise RateError(f"densities must lie in [{relation.low}, {relation.high}]")
    fastest = float(np.abs(relation.speed(np.linspace(relation.low, relation.high, _GRID))).max())
    width = 1 / u.size
    result = np.empty((len(times), u.size))
    last = float(max(times, default=0.0))
    require_time(last * fastest * u.size**2, 1e7, f"{u.size} cells to time {last:g}")
    now = 0.0
    for row, time in enumerate(times):
        steps = int(np.ceil((time - now) * fastest / (0.9 * width)))
        for _ in range(steps):
            ghosts = (u[-1], u[0]) if reservoirs is None else reservoirs
            padded = np.concatenate([[ghosts[0]], u, [ghosts[1]]])
            flux = relation.godunov_flux(padded[:-1], padded[1:])
            u = u - (time - now) / steps / width * np.diff(flux)
        now = float(time)
        result[row] = u
    return result


def riemann(relation: CurrentRelation, left: float, right: float, velocity: Vector) -> Vector:
    """Exact entropy solution u(x/t) of the step left | right at x/t = `velocity`, same shape.

    u minimises j(u) - v u over [left, right] if left < right, maximises it over [right, left]
    otherwise: shocks and rarefactions of any j, convex or not.  Resolved to 1/4000 of the jump.
    """
    density = np.linspace(left, right, _GRID)
    sign = 1.0 if left < right else -1.0
    cost = sign * (relation.flux(density) - np.asarray(velocity)[..., None] * density)
    return np.asarray(density[cost.argmin(axis=-1)])


def characteristics(relation: CurrentRelation, x: Vector, u: Vector, time: float) -> Vector:
    """Positions at `time` of the densities `u` that start at `x`, same shape: x + j'(u) t.

    The solution of (2.60) up to `breaking_time`, where they first cross.
    """
    return np.asarray(x + relation.speed(u) * time)


def breaking_time(relation: CurrentRelation, x: Vector, u: Vector) -> float:
    """Time at which a shock first forms from the smooth profile u(x); infinite if none does."""
    steepest = float(np.gradient(relation.speed(u), x).min())
    return -1 / steepest if steepest < 0 else float("inf")


PHASES = ("left", "right", "maximal current", "minimal current")


def phase(relation: CurrentRelation, left: Vector, right: Vector) -> NDArray[np.int64]:
    """Boundary-induced phase of the open chain between two reservoirs, index into `PHASES`.

    The bulk takes the density of the left or of the right reservoir, or the one at an extremum
    of j, whichever carries the Godunov flux.  Takes and returns arrays of one shape.
    """
    current = relation.godunov_flux(left, right)
    result = np.where(left > right, 2, 3)
    result = np.where(np.isclose(current, relation.flux(right), rtol=0, atol=1e-12), 1, result)
    return np.asarray(
        np.where(np.isclose(current, relation.flux(left), rtol=0, atol=1e-12), 0, result)
    )


def coexistence_density(relation: CurrentRelation, left: float) -> float:
    """Right reservoir density that puts `left` on the first-order line.

    It carries the same current, so that the shock between them has no bias.  Raises `RateError`
    where no other density does.
    """
    grid = np.linspace(relation.low, relation.high, _GRID)
    excess = relation.flux(grid) - float(relation.flux(np.array(left)))
    roots = [
        brentq(
            lambda u: float(relation.flux(np.array(u)) - relation.flux(np.array(left))),
            grid[i],
            grid[i + 1],
        )
        for i in np.flatnonzero(excess[:-1] * excess[1:] < 0)
    ]
    others = [u for u in roots if abs(u - left) > 1e-3]
    if not others:
        raise RateError(f"no other density carries the current of {left}")
    return float(min(others, key=lambda u: abs(u - left)))


def domain_wall(model: LatticeGas, sites: int, z1: float, z2: float) -> ShockWalk:
    """Domain-wall picture: the shock as a walk with rates j_i / (density jump), ends included.

    d1 = j_1/(u_2 - u_1) to the left, d2 = j_2/(u_2 - u_1) to the right.  Exact for the one-sided
    and the internal-state shock; for the two-sided charge shock only d2 - d1 is, and off the shock
    manifold it is an approximation.  Raises `RateError` where the rates would be negative.
    """
    jump = model.density(z2) - model.density(z1)
    if jump == 0:
        raise RateError("equal densities on both sides: no domain wall")
    d1, d2 = model.current(z1) / jump, model.current(z2) / jump
    if min(d1, d2) < -1e-14 * model.scale:
        raise RateError(f"domain-wall rates d1 = {d1:.6g}, d2 = {d2:.6g}: no stable shock")
    d1, d2 = max(d1, 0.0), max(d2, 0.0)
    return ShockWalk(sites, d1, d2, d2, d1)


def domain_wall_profile(model: LatticeGas, walk: ShockWalk, z1: float, z2: float) -> Vector:
    """Stationary profile of C in the mixture of shock measures of `walk`, shape (L,)."""
    right_of_shock = np.cumsum(walk.stationary_mixture())[:-1]  # site k + 1 lies right of 0..k
    left, right = model.density(z1), model.density(z2)
    return np.asarray(left + (right - left) * right_of_shock)

"""Everything exact about one model at once: what `narrows lattice check` reports."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from lattice import generator, shocks
from lattice.hydrodynamics import domain_wall_profile
from lattice.models import LatticeGas, RateError, Vector


@dataclass(frozen=True)
class Report:
    """Findings on a model at L = `sites` with fugacities z1 left and z2 right of the shock.

    Residuals are 1-norms on the full generator as fractions of the largest rate, 0 up to rounding
    where the statement holds.  Pairs are (left, right); rates and currents in inverse units of
    time, velocity in sites per unit of time, positive to the right.  Fields that need a shock are
    None if z1 = z2, those that need ends on a ring too; the hopping rates are the nonnegative
    least-squares solution where `random_walk_residual` does not vanish.  `stationary_profile`, by
    site, `stationary_currents`, over each bond, and `stationary_correlation`, the largest connected
    correlation of C at two sites, are None if more than one stationary state can be reached, which
    `remarks` then says.  `domain_wall_profile` is rho_C by site in the mixture of shock measures
    that the random walk leads to: where the shock does not close, an approximation.
    """

    stationarity_residual: float
    random_walk_residual: float | None
    closes_at_ends: bool | None
    d1: float | None
    d2: float | None
    end_rates: tuple[float, float] | None
    shock_velocity: float | None
    shock_diffusion: float | None
    currents: tuple[float, float]
    densities: dict[str, tuple[float, float]]
    stationary_profile: dict[str, list[float]] | None
    stationary_currents: dict[str, list[float]] | None
    stationary_correlation: float | None
    domain_wall_profile: list[float] | None
    conditions: list[shocks.Condition]
    inconsistent_ends: list[shocks.Condition]
    remarks: list[str]
    mean_shock_position: list[float] | None = None

    def as_json(self) -> dict[str, Any]:
        """The report as plain JSON data; `mean_shock_position` only where it was asked for."""
        data = asdict(self)
        if self.mean_shock_position is None:
            del data["mean_shock_position"]
        return data


def check(
    model: LatticeGas,
    sites: int,
    z1: float,
    z2: float,
    start: int | None = None,
    times: list[float] | None = None,
) -> Report:
    """Examine a model on the full generator of `sites` sites.

    With `start`, a shock position in 0..L, and `times`, the mean position after these times: of the
    random walk (2.62) where the shock closes at the ends, else the equimolar position of the
    evolved state.  Raises `RateError` or `ValueError` on bad arguments, `generator.TooLarge`.
    """
    if (start is None) != (times is None):
        raise ValueError("a start position and times are given together")
    stationarity = shocks.stationarity_residual(model, sites, z1, z2)
    ends = shocks.stationarity_conditions(model, z1, z2)
    walk, walk_residual, closed, conditions = None, None, None, list(ends)
    if z1 != z2:
        conditions += shocks.random_walk_conditions(model, z1, z2)
    if z1 != z2 and not model.periodic:
        residuals = shocks.random_walk_residuals(model, sites, z1, z2)
        walk_residual, closed = float(residuals[1:-1].max()), shocks.closes(residuals)
        walk = shocks.ShockWalk(
            sites, *shocks.hopping_rates(model, z1, z2), *shocks.end_rates(model, z1, z2)
        )
    remarks: list[str] = []
    marginals = np.array([model.marginal(z1), model.marginal(z2)])
    densities = {
        f"rho_{name}": (float(marginals[0, n]), float(marginals[1, n]))
        for n, name in enumerate(model.states)
        if name != "0"
    }
    if start is None or times is None:
        positions = None
    elif walk is None:
        raise RateError("no shock position: z1 = z2, or the chain is a ring")
    else:
        exact = closed and walk_residual is not None and walk_residual < shocks.HOLDS
        positions = _mean_positions(model, walk, z1, z2, start, times, exact=bool(exact))
    stationary = _stationary_state(model, sites, z1, z2, remarks)
    return Report(
        stationarity_residual=stationarity,
        random_walk_residual=walk_residual,
        closes_at_ends=closed,
        d1=None if walk is None else walk.hop_left,
        d2=None if walk is None else walk.hop_right,
        end_rates=None if walk is None else (walk.enter, walk.leave),
        shock_velocity=None if walk is None else walk.velocity,
        shock_diffusion=None if walk is None else walk.diffusion,
        currents=(model.current(z1), model.current(z2)),
        densities=densities,
        stationary_profile=None if stationary is None else _profile(model, sites, stationary),
        stationary_currents=None if stationary is None else _currents(model, sites, stationary),
        stationary_correlation=(
            None if stationary is None else _largest_correlation(model, sites, stationary)
        ),
        domain_wall_profile=(
            None if walk is None else domain_wall_profile(model, walk, z1, z2).tolist()
        ),
        conditions=conditions,
        inconsistent_ends=_contradictions(model, z1, z2, ends),
        remarks=remarks,
        mean_shock_position=positions,
    )


def _stationary_state(
    model: LatticeGas, sites: int, z1: float, z2: float, remarks: list[str]
) -> Vector | None:
    """The stationary state that the shock measures lead to."""
    start = shocks.shock_vector(model, sites, sites // 2, z1, z2)
    try:
        return generator.stationary_state(model, sites, start)
    except generator.NoUniqueState as error:
        remarks.append(str(error))
        return None


def _currents(model: LatticeGas, sites: int, state: Vector) -> dict[str, list[float]]:
    """Currents of C and of each species over the bonds, by name."""
    currents = {"C": generator.bond_currents(model, sites, state)}
    currents |= generator.species_currents(model, sites, state)
    return {name: current.tolist() for name, current in currents.items()}


def _largest_correlation(model: LatticeGas, sites: int, state: Vector) -> float:
    correlation = generator.connected_correlation(model, sites, state)
    return float(np.abs(correlation - np.diag(np.diag(correlation))).max())


def _profile(model: LatticeGas, sites: int, state: Vector) -> dict[str, list[float]]:
    """rho_A and rho_B by site."""
    single = generator.site_probabilities(model, sites, state)
    return {
        f"rho_{name}": single[:, n].tolist() for n, name in enumerate(model.states) if name != "0"
    }


def _contradictions(
    model: LatticeGas, z1: float, z2: float, conditions: list[shocks.Condition]
) -> list[shocks.Condition]:
    """Conditions of the ends that fail although the bulk has the product measures of z1 and z2."""
    bulk = max(float(np.abs(shocks.bond_residual(model, z)).max()) for z in (z1, z2))
    if bulk > shocks.HOLDS * model.scale:
        return []
    return [c for c in conditions if abs(c.residual) > shocks.CONTRADICTS * model.scale]


def _mean_positions(
    model: LatticeGas,
    walk: shocks.ShockWalk,
    z1: float,
    z2: float,
    start: int,
    times: list[float],
    *,
    exact: bool,
) -> list[float]:
    sites = walk.sites
    initial: Vector = shocks.shock_vector(model, sites, start, z1, z2)
    if exact:
        if min(times) < 0:
            raise ValueError(f"times {times}: must not be negative")
        return [walk.mean_position(start, time) for time in times]
    moments = sorted(times)
    states = generator.evolve(model, sites, initial, moments)
    return [
        shocks.equimolar_position(model, sites, states[moments.index(time)], z1, z2)
        for time in times
    ]

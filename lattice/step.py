"""The step z1 | z2 on the Euler scale: Godunov, exact solution and Monte Carlo side by side."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from lattice import hydrodynamics as hydro
from lattice import monte_carlo, shocks
from lattice.models import LatticeGas, RateError, Vector


@dataclass(frozen=True)
class StepEvolution:
    """A step in the middle of an open chain between reservoirs z1 and z2.

    `wave` is "shock", "rarefaction" or "compound"; pairs are (left, right); speeds in sites per
    unit of time, positive to the right.  Profiles of the conserved density have shape (T, N) at the
    macroscopic `times` t/L and the cell centres `x`; `monte_carlo` has standard errors beside it.
    `domain_wall_rates` and `hopping_rates` are (left, right), None where they do not exist.
    """

    wave: str
    densities: tuple[float, float]
    currents: tuple[float, float]
    characteristic_speeds: tuple[float, float]
    rankine_hugoniot: float
    phase: str
    open_chain_current: float
    coexistence_density: float | None
    domain_wall_rates: tuple[float, float] | None
    hopping_rates: tuple[float, float]
    times: Vector
    x: Vector
    godunov: Vector
    exact: Vector
    monte_carlo: Vector | None
    monte_carlo_error: Vector | None

    def as_json(self) -> dict[str, Any]:
        """The fields as plain JSON data."""
        return {
            name: value.tolist() if isinstance(value, np.ndarray) else value
            for name, value in asdict(self).items()
        }


def wave(relation: hydro.CurrentRelation, left: float, right: float) -> str:
    """What a step becomes.

    "shock" where j lies on the stable side of its chord all along (Oleinik), "rarefaction" where
    characteristics fan out all along, "compound" otherwise.
    """
    u = np.linspace(left, right, 2001)
    ends = relation.flux(np.array([left, right]))
    chord = np.linspace(ends[0], ends[1], u.size)
    excess = (relation.flux(u) - chord) * np.sign(right - left)
    if excess.min() > -1e-12:
        return "shock"
    return "rarefaction" if np.diff(relation.speed(u)).min() > 0 else "compound"


def evolve_step(
    model: LatticeGas,
    z1: float,
    z2: float,
    times: list[float],
    cells: int = 400,
    sites: int = 2000,
    replicas: int = 0,
    seed: int = 1,
) -> StepEvolution:
    """Solve (2.60) from the step z1 | z2 at x = 1/2 to macroscopic `times`.

    With `replicas` > 1, Monte Carlo runs of `sites` sites from the shock measure |L/2> with the
    model's own ends are averaged over the sites of each cell.  The exact Riemann solution is that
    of the infinite line.  Raises `RateError` for z1 = z2 or a ring, `ValueError`.
    """
    if model.periodic or z1 == z2:
        raise RateError("the step z1 | z2 needs an open chain and z1 different from z2")
    if replicas == 1 or (replicas and sites < cells):
        raise ValueError("Monte Carlo needs at least 2 replicas and as many sites as cells")
    relation = hydro.current_relation(model)
    left, right = model.density(z1), model.density(z2)
    ends = np.array([left, right])
    x = (np.arange(cells) + 0.5) / cells
    moments = np.array(times)
    try:
        dw = hydro.domain_wall(model, sites, z1, z2)
    except RateError:
        dw = None
    try:
        coexistence = hydro.coexistence_density(relation, left)
    except RateError:
        coexistence = None
    safe = np.maximum(moments, 1e-12)[:, None]
    simulated, error = None, None
    if replicas:
        simulated, error = _monte_carlo(model, z1, z2, moments, cells, sites, replicas, seed)
    open_current = relation.godunov_flux(ends[:1], ends[1:])
    return StepEvolution(
        wave=wave(relation, left, right),
        densities=(left, right),
        currents=(model.current(z1), model.current(z2)),
        characteristic_speeds=tuple(relation.speed(ends).tolist()),
        rankine_hugoniot=relation.rankine_hugoniot(left, right),
        phase=hydro.PHASES[int(hydro.phase(relation, ends[:1], ends[1:])[0])],
        open_chain_current=float(open_current[0]),
        coexistence_density=coexistence,
        domain_wall_rates=None if dw is None else (dw.hop_left, dw.hop_right),
        hopping_rates=shocks.hopping_rates(model, z1, z2),
        times=moments,
        x=x,
        godunov=hydro.solve(relation, np.where(x < 0.5, left, right), moments, (left, right)),
        exact=hydro.riemann(relation, left, right, (x - 0.5) / safe),
        monte_carlo=simulated,
        monte_carlo_error=error,
    )


def _monte_carlo(
    model: LatticeGas,
    z1: float,
    z2: float,
    times: Vector,
    cells: int,
    sites: int,
    replicas: int,
    seed: int,
) -> tuple[Vector, Vector]:
    """Cell averages of C over replicas and their standard error, each (T, N)."""
    initial = shocks.shock_marginals(model, sites, sites // 2, z1, z2)
    ensemble = monte_carlo.simulate(model, initial, times * sites, replicas, seed)
    profile = ensemble.occupation @ model.conserved
    variance = ensemble.occupation @ model.conserved**2 - profile**2
    groups = np.array_split(np.arange(sites), cells)
    mean = np.stack([profile[:, g].mean(axis=1) for g in groups], axis=1)
    # sites are nearly independent inside a cell: product measures on either side of a shock
    spread = np.stack([np.sqrt(variance[:, g].sum(axis=1)) / g.size for g in groups], axis=1)
    return mean, spread / np.sqrt(replicas)

"""Figs. 2.1 and 2.2 with a running shock: kinetic Monte Carlo beside the exact random walk."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from matplotlib.figure import Figure
from scipy.stats import poisson, skellam

from analysis.estimate import Estimate
from lattice.completion import ShockModel, complete_shock
from lattice.models import Vector
from lattice.monte_carlo import Ensemble, estimate_walk, shock_evidence, simulate
from lattice.shocks import hopping_rates, shock_marginals
from narrows.papers.drawing import PAPER, shades
from narrows.papers.figure import Directories, Outcome, PaperFigure, Quality
from narrows.papers.results import PaperNumber, compared

SITES, SEED = 1000, 1
SHOWN = 4  # profiles


@dataclass(frozen=True)
class RunningShock:
    """A model on the shock manifold; the thesis' v_s and D_s at its rates, right-positive."""

    number: str
    caption: str
    density: str
    model: Callable[[], ShockModel]
    walk: Callable[[ShockModel], tuple[float, float]]
    equations: tuple[str, str]
    start: int


def _two_phases() -> ShockModel:
    """Internal states, p/q = z2/z1 = 4 (2.109)-(2.111)."""
    given = {"h1": 0.2, "h3": 1.1, "r1": 0.3, "r2": 0.2, "r4": 0.2, "c": 0.5}
    return complete_shock("internal-state", 0.1, 0.4, given)


def _walk_of_two_phases(model: ShockModel) -> tuple[float, float]:
    """(2.115) with its sign turned to right-positive, and (2.116)."""
    rates, c = model.rates, model.rates["c"]
    p, q = rates["h3"] + c * rates["r4"], rates["h1"] + c * rates["r2"]
    nu = [1 + (1 + c) * z for z in (model.z1, model.z2)]
    right, left = p * nu[0] / nu[1], q * nu[1] / nu[0]
    return right - left, (right + left) / 2


def _one_sided() -> ShockModel:
    """Charges, z2 = 0: the right phase is full of A (2.72)-(2.75)."""
    given = {"w42": 1.0, "w73": 0.6, "w53": 1.0, "w35": 0.3, "w75": 0.2}
    return complete_shock("charge", 0.8, 0.0, given, ratio=0.5)


def _walk_of_one_sided(model: ShockModel) -> tuple[float, float]:
    """(2.76): v_s = 2 D_s = w42 rho_A, to the left."""
    speed = model.rates["w42"] * float(model.gas().marginal(model.z1)[0])
    return -speed, speed / 2


SHOCKS = (
    RunningShock(
        "2.1",
        "A shock between two fugacities random-walks; internal-state family, p/q = z2/z1 = 4.",
        r"particle density $\rho$",
        _two_phases,
        _walk_of_two_phases,
        ("(2.115)", "(2.116)"),
        300,
    ),
    RunningShock(
        "2.2",
        "The one-sided shock, z2 = 0: the right phase is full of A, and the shock only moves left.",
        r"charge density $\sigma$",
        _one_sided,
        _walk_of_one_sided,
        ("(2.76)", "(2.76)"),
        800,
    ),
)


def _make(shock: RunningShock, directories: Directories, quality: Quality) -> Outcome:
    model = shock.model()
    gas = model.gas()
    replicas, end = (400, 800.0) if quality == "full" else (100, 400.0)
    times = np.linspace(0, end, 41)
    ensemble = simulate(
        gas,
        shock_marginals(gas, SITES, shock.start, model.z1, model.z2),
        times,
        replicas,
        SEED,
        evidence=shock_evidence(gas, model.z1, model.z2),
    )
    assert ensemble.positions is not None
    walk = estimate_walk(ensemble.times, ensemble.positions)
    velocity, diffusion = shock.walk(model)
    figure = _draw(shock, model, ensemble, velocity)
    results = [
        compared(
            shock.number,
            "v_s of the shock, positive to the right [sites/time]",
            Estimate(walk.velocity, walk.velocity_error),
            PaperNumber(velocity),
            f"the thesis' {shock.equations[0]} at these rates; printed positive to the left",
        ),
        compared(
            shock.number,
            "D_s of the shock [sites^2/time]",
            Estimate(walk.diffusion, walk.diffusion_error),
            PaperNumber(diffusion),
            f"the thesis' {shock.equations[1]} at these rates",
        ),
    ]
    sites = np.arange(1, SITES + 1)
    table = {"site": sites.tolist()}
    for sample in _samples(ensemble):
        profile = ensemble.occupation[sample] @ gas.conserved
        table[f"density_t_{ensemble.times[sample]:g}"] = profile.tolist()
    return Outcome(figure, table, results)


def _samples(ensemble: Ensemble) -> list[int]:
    return [round(i * (len(ensemble.times) - 1) / (SHOWN - 1)) for i in range(SHOWN)]


def _draw(shock: RunningShock, model: ShockModel, ensemble: Ensemble, velocity: float) -> Figure:
    gas = model.gas()
    hops = hopping_rates(gas, model.z1, model.z2)
    figure = Figure(figsize=(9.4, 4.2), layout="constrained")
    profiles, space_time = figure.subplots(1, 2)
    sites = np.arange(1, SITES + 1)
    width = 20
    coarse = sites.reshape(-1, width).mean(axis=1)
    samples = _samples(ensemble)
    for colour, sample in zip(shades(len(samples)), samples, strict=True):
        time = float(ensemble.times[sample])
        density = (ensemble.occupation[sample] @ gas.conserved).reshape(-1, width).mean(axis=1)
        profiles.plot(coarse, density, ".", markersize=4, color=colour, label=f"$t$ = {time:g}")
        right = _right_of_shock(shock.start, hops, time)
        step = gas.density(model.z1) * (1 - right) + gas.density(model.z2) * right
        exact = "exact mixture of shock measures" if sample == samples[-1] else "_"
        profiles.plot(sites, step, color="0.2", linewidth=0.9, label=exact)
    for number, z in ((1, model.z1), (2, model.z2)):
        label = f"thesis: phase $z_{number}$ = {z:g}"
        style = {"color": PAPER, "linestyle": "--" if number == 1 else ":", "linewidth": 1.2}
        profiles.axhline(gas.density(z), label=label, **style)
    profiles.set(xlabel="site $k$", ylabel=shock.density, xlim=(0, SITES))
    profiles.legend(fontsize=8, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3)

    block = 20
    history = gas.conserved[ensemble.history].reshape(len(ensemble.times), -1, block).mean(axis=2)
    image = space_time.imshow(
        history,
        origin="lower",
        aspect="auto",
        cmap="cividis",
        interpolation="nearest",
        extent=(0.5, SITES + 0.5, 0, float(ensemble.times[-1])),
    )
    figure.colorbar(image, ax=space_time, label=shock.density)
    assert ensemble.positions is not None
    space_time.plot(
        ensemble.positions[0], ensemble.times, "w-", lw=1.6, label="shock of one replica"
    )
    expected = shock.start + velocity * ensemble.times
    label = f"thesis: $v_s$ = {velocity:.3f}"
    space_time.plot(expected, ensemble.times, "--", color=PAPER, lw=1.6, label=label)
    space_time.set(xlabel="site $k$", ylabel="time $t$")
    space_time.legend(loc="upper right", frameon=True, framealpha=0.8, facecolor="0.75")
    return figure


def _right_of_shock(start: int, hops: tuple[float, float], time: float) -> Vector:
    """Probability that each site lies right of the shock, of a walk far from the ends, (SITES,)."""
    moved = np.arange(SITES) - start
    left, right = hops[0] * time, hops[1] * time
    if time == 0:
        return (moved >= 0).astype(float)
    if right == 0:
        return np.asarray(poisson.sf(-moved - 1, left))
    return np.asarray(skellam.cdf(moved, right, left))


FIGURES = tuple(
    PaperFigure(
        shock.number,
        shock.caption,
        partial(_make, shock),
        origin="Kinetic Monte Carlo of the lattice gas.",
    )
    for shock in SHOCKS
)

"""Figures of the lattice gases, written as PNG files without a display."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from lattice import hydrodynamics as hydro
from lattice import shocks
from lattice.models import LatticeGas, Vector
from lattice.monte_carlo import Ensemble
from lattice.step import StepEvolution

_PHASE_COLOURS = ("#dce6f0", "#f3dfd3", "#dfeadb", "#efe9c8")


def _save(figure: Figure, path: Path) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    FigureCanvasAgg(figure)
    figure.savefig(path, dpi=110)


def _c_label(model: LatticeGas) -> str:
    return "charge density σ" if model.family == "charge" else "particle density ρ"


def space_time(model: LatticeGas, ensemble: Ensemble, path: Path) -> None:
    """Configurations of one replica, time upwards, with its fitted shock position if any."""
    figure = Figure(figsize=(6, 4), layout="constrained")
    axes = figure.subplots()
    sites, times = ensemble.history.shape[1], ensemble.times
    width = max(1, sites // 500)  # average C over blocks, or single sites would alias on the page
    blocks = ensemble.history[:, : sites // width * width].reshape(len(times), -1, width)
    image = axes.imshow(
        model.conserved[blocks].mean(axis=2),
        origin="lower",
        aspect="auto",
        cmap="RdBu_r",
        interpolation="nearest",
        extent=(0.5, sites + 0.5, times[0], times[-1]),
    )
    figure.colorbar(image, label=_c_label(model))
    if ensemble.positions is not None:
        axes.plot(ensemble.positions[0], times, "k-", lw=1.2, label="fitted shock position")
        axes.legend(loc="upper right", fontsize=8)
    axes.set(xlabel="site k", ylabel="time t")
    _save(figure, path)


def simulation(
    model: LatticeGas, ensemble: Ensemble, z1: float, z2: float, start: int, folder: Path
) -> None:
    """space_time.png, profile.png and, with a tracked shock, position.png."""
    space_time(model, ensemble, folder / "space_time.png")
    sites = ensemble.occupation.shape[1]
    k = np.arange(1, sites + 1)
    figure = Figure(figsize=(6, 4), layout="constrained")
    axes = figure.subplots()
    width = max(1, sites // 200)
    kept = sites // width * width
    profile = (ensemble.occupation[-1] @ model.conserved)[:kept].reshape(-1, width).mean(axis=1)
    axes.plot(k[:kept].reshape(-1, width).mean(axis=1), profile, ".", ms=3, label="Monte Carlo")
    if ensemble.positions is not None:
        d1, d2 = shocks.hopping_rates(model, z1, z2)
        walked = _walk_profile(model, sites, z1, z2, start, d1, d2, float(ensemble.times[-1]))
        axes.plot(k, walked, "k-", lw=1, label="mixture of shock measures (2.62)")
    axes.set(xlabel="site k", ylabel=_c_label(model), title=f"t = {ensemble.times[-1]:g}")
    axes.legend(fontsize=8)
    _save(figure, folder / "profile.png")
    if ensemble.positions is None:
        return
    figure = Figure(figsize=(7, 3.2), layout="constrained")
    mean_axes, variance_axes = figure.subplots(1, 2)
    times = ensemble.times
    count = len(ensemble.positions)
    spread = ensemble.positions.std(axis=0, ddof=1)
    mean_axes.errorbar(
        times, ensemble.positions.mean(axis=0), spread / np.sqrt(count), fmt=".", ms=3
    )
    mean_axes.plot(times, start + (d2 - d1) * times, "k-", lw=1)
    mean_axes.set(xlabel="time t", ylabel="mean shock position")
    variance = spread**2
    variance_axes.errorbar(times, variance, variance * np.sqrt(2 / (count - 1)), fmt=".", ms=3)
    variance_axes.plot(times, variance[0] + (d1 + d2) * times, "k-", lw=1)
    variance_axes.set(xlabel="time t", ylabel="variance of position")
    _save(figure, folder / "position.png")


def _walk_profile(
    model: LatticeGas,
    sites: int,
    z1: float,
    z2: float,
    start: int,
    d1: float,
    d2: float,
    time: float,
) -> Vector:
    """Profile of C after a walk that has not met the ends: a Skellam displacement of the step."""
    from scipy.stats import poisson, skellam

    displacement = np.arange(1, sites + 1) - 1 - start  # site k is right of the shock if K <= k - 1
    if d1 > 0 and d2 > 0:
        right = skellam.cdf(displacement, d2 * time, d1 * time)
    elif d2 > 0:
        right = poisson.cdf(displacement, d2 * time)
    else:
        right = poisson.sf(-displacement - 1, d1 * time)
    left_density, right_density = model.density(z1), model.density(z2)
    return np.asarray(left_density + (right_density - left_density) * right)


def hydrodynamics(
    model: LatticeGas, result: StepEvolution, z1: float, z2: float, folder: Path
) -> None:
    """current.png (j(u) with the chord), step.png (profiles) and phase_diagram.png."""
    relation = hydro.current_relation(model)
    u = np.linspace(relation.low, relation.high, 401)
    figure = Figure(figsize=(5, 3.5), layout="constrained")
    axes = figure.subplots()
    axes.plot(u, relation.flux(u), "k-", lw=1, label="j(u)")
    axes.plot(result.densities, result.currents, "o--", ms=4, label="step z1 | z2")
    axes.set(xlabel=_c_label(model), ylabel="current j")
    axes.legend(fontsize=8)
    _save(figure, folder / "current.png")

    figure = Figure(figsize=(6, 4), layout="constrained")
    axes = figure.subplots()
    for row, time in enumerate(result.times):
        (line,) = axes.plot(result.x, result.godunov[row], lw=1, label=f"Godunov, t' = {time:g}")
        axes.plot(result.x, result.exact[row], "--", lw=0.8, color=line.get_color())
        if result.monte_carlo is not None:
            axes.plot(
                result.x,
                result.monte_carlo[row],
                ".",
                ms=3,
                color=line.get_color(),
                label="Monte Carlo",
            )
    axes.set(xlabel="x = k/L", ylabel=_c_label(model), title="dashed: exact Riemann solution")
    axes.legend(fontsize=8)
    _save(figure, folder / "step.png")
    phase_diagram(relation, folder / "phase_diagram.png", result.densities, _c_label(model))


def phase_diagram(
    relation: hydro.CurrentRelation,
    path: Path,
    mark: tuple[float, float] | None = None,
    label: str = "density",
) -> None:
    """Boundary-induced phases over the reservoir densities, with the first-order line."""
    u = np.linspace(relation.low, relation.high, 301)
    left, right = np.meshgrid(u, u)
    phases = hydro.phase(relation, left, right)
    figure = Figure(figsize=(5.2, 4.4), layout="constrained")
    axes = figure.subplots()
    axes.imshow(
        phases,
        origin="lower",
        extent=(u[0], u[-1], u[0], u[-1]),
        aspect="auto",
        cmap=ListedColormap(_PHASE_COLOURS),
        vmin=-0.5,
        vmax=3.5,
        interpolation="nearest",
    )
    for number, name in enumerate(hydro.PHASES):
        where = phases == number
        if where.mean() > 0.02:
            text = f"{name} reservoir" if number < 2 else name
            axes.text(
                float(left[where].mean()),
                float(right[where].mean()),
                text,
                ha="center",
                va="center",
                fontsize=8,
            )
    # first-order line: the two reservoirs change places where both carry the Godunov flux
    tie = relation.flux(left) - relation.flux(right)
    border = np.isin(phases, (0, 1)) & (np.abs(left - right) > 2 * (u[1] - u[0]))
    axes.contour(u, u, np.where(border, tie, np.nan), levels=[0.0], colors="k", linewidths=1.5)
    if mark is not None:
        axes.plot(*mark, "k*", ms=9)
    axes.set(xlabel=f"left reservoir: {label}", ylabel=f"right reservoir: {label}")
    _save(figure, path)

"""Diffusivity profile from the steady state of colour reactions: (2), and (3) corrected."""

from functools import partial

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from analysis.arrays import Array
from analysis.colors import Colors, block_mean, colors_of, estimate
from analysis.diffusivity.blocks import quantile_95
from analysis.diffusivity.color import color_diffusivity
from analysis.findings import Findings
from analysis.run_directory import RunDirectory

QUANTITIES = (
    "diffusivity.*.middle",
    "diffusivity.*.surface",
    "color_flux.*.reactions",
    "color_flux.*.currents",
)

REACH = 0.2  # half width of the window of the local cubic fit [a0]
NEAR = 0.1  # what is called at the surface [a0]
STEADY = 0.05  # the rates at the two surfaces differ by less


def measure(run: RunDirectory) -> Findings:
    """D by bins for every reaction probability, flux by reactions and by currents."""
    colors = colors_of(run)
    axis = colors.reactions.axis
    middle = 0.0 if axis is None else run.box.sizes[axis] / 2
    place = colors.positions - middle
    density = _density(colors, run)
    entries, warnings, table = dict[str, dict[str, object]](), list[str](), _Table(place, density)
    blocks = len(colors.number)
    for k, p in enumerate(colors.reactions.probabilities):
        name = f"p={p:g}"
        rate = colors.through(colors.chance_rates[..., k])
        d, error = color_diffusivity(
            colors.positions, colors.width, colors.number, colors.chances[..., k], rate, REACH
        )
        by_lot = color_diffusivity(
            colors.positions,
            colors.width,
            colors.number,
            colors.labels[..., k],
            colors.through(colors.label_rates[..., k]),
            REACH,
        )
        table.add(p, d, error)
        inner = _middle(colors)
        entries[name] = {
            "middle": estimate(
                partial(_mean, colors, inner), colors.number, colors.chances[..., k], rate
            ).as_json(),
            "surface": estimate(
                partial(_mean, colors, _surface(colors)),
                colors.number,
                colors.chances[..., k],
                rate,
            ).as_json(),
            "error_of_labels": float(np.median(by_lot[1][inner] / error[inner])),
        }
        warnings += _unsteady(colors, k, p)
    flux = {
        f"p={p:g}": {
            "reactions": block_mean(colors.through(colors.chance_rates[..., k])).as_json(),
            "currents": block_mean(-colors.current[..., k].mean(axis=1) / colors.width).as_json(),
        }
        for k, p in enumerate(colors.reactions.probabilities)
    }
    return Findings(
        {"diffusivity": entries, "color_flux": flux},
        {"diffusivity.png": draw(table, colors.at_walls, quantile_95(blocks))},
        {"diffusivity.csv": table.columns("z" if colors.at_walls else "r")},
        tuple(warnings),
    )


class _Table:
    """The rows of diffusivity.csv."""

    def __init__(self, place: Array, density: Array) -> None:
        self.place, self.density = place, density
        self.profiles: dict[float, tuple[Array, Array]] = {}

    def add(self, probability: float, diffusivity: Array, error: Array) -> None:
        self.profiles[probability] = diffusivity, error

    def columns(self, coordinate: str) -> dict[str, list[float]]:
        """By name; bins of which nothing is known are left out."""
        rows = [
            row
            for p, (d, error) in self.profiles.items()
            for row in zip(np.full(len(d), p), self.place, self.density, d, error, strict=True)
            if np.isfinite(row).all()
        ]
        names = ("reaction_probability", coordinate, "density", "diffusivity", "error")
        return {name: [float(row[n]) for row in rows] for n, name in enumerate(names)}


def _density(colors: Colors, run: RunDirectory) -> Array:
    """Number density in each bin, (B,) [1/a0^3]."""
    number = colors.number.mean(axis=0) / colors.references
    axis = colors.reactions.axis
    if axis is not None:
        return np.asarray(number / (colors.width * np.prod(np.delete(run.box.sizes, axis))))
    edges = colors.positions[:, None] + colors.width * np.array([-0.5, 0.5])
    return np.asarray(number / (4 / 3 * np.pi * (edges[:, 1] ** 3 - edges[:, 0] ** 3)))


def _middle(colors: Colors) -> NDArray[np.bool_]:
    """The middle third of a pore; of pairs, distances between 0.6 and 0.9 of the outer surface."""
    place = colors.positions
    low, high = place[0], place[-1]
    if colors.at_walls:
        return np.asarray(np.abs(place - (low + high) / 2) < (high - low) / 6)
    return np.asarray((place > 0.6 * colors.reactions.cutoff) & (place < 0.9 * high))


def _surface(colors: Colors) -> NDArray[np.bool_]:
    """Bins at the walls, or at contact."""
    place = colors.positions
    near = place - place[0] < NEAR
    return np.asarray(near | (place[-1] - place < NEAR) if colors.at_walls else near)


def _mean(
    colors: Colors, chosen: NDArray[np.bool_], number: Array, colored: Array, rate: Array
) -> Array:
    """Mean of D over the chosen bins."""
    d, _ = color_diffusivity(
        colors.positions,
        colors.width,
        number[np.newaxis],
        colored[np.newaxis],
        np.atleast_1d(rate),
        REACH,
    )
    return np.asarray(np.nanmean(d[chosen]))


def _unsteady(colors: Colors, k: int, p: float) -> list[str]:
    """A line when the two walls do not react at the same rate."""
    if not colors.at_walls:
        return []
    first, second = colors.chance_rates[..., k].mean(axis=0)
    if abs(first - second) <= STEADY * (first + second) / 2:
        return []
    return [
        f"reaction probability {p:g}: {first:.3g} reactions per time at one wall, {second:.3g} at "
        "the other: the colours are not steady, equilibrate longer"
    ]


def draw(table: _Table, at_walls: bool, quantile: float) -> Figure:
    """D with 95 % bands above, density below."""
    figure = Figure(figsize=(7, 6), layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(2, 1))
    for number, (p, (d, error)) in enumerate(table.profiles.items()):
        band = quantile * error
        above.plot(table.place, d, color=f"C{number}", label=f"reaction probability {p:g}")
        above.fill_between(
            table.place, d - band, d + band, color=f"C{number}", alpha=0.25, linewidth=0
        )
    largest = [float(np.nanquantile(d, 0.98)) for d, _ in table.profiles.values()]
    above.set(ylim=(0, 1.4 * max(largest)), ylabel="diffusivity $D$ [$a_0^2/t_0$]")
    above.legend()
    below.plot(table.place, table.density, color="0.3")
    label = "from the middle $z$ [$a_0$]" if at_walls else "distance $r$ [$a_0$]"
    below.set(xlabel=label, ylabel=r"density $\rho$ [$a_0^{-3}$]", ylim=(0, None))
    return figure

"""Beyond the paper: where in Fig. 9 clusters begin, as a curve with an error.

A suspension is called clustered from one bond per colloid on: as many as connect all of them. The
paper has the boundary at 14 % of colloids between pictures; here bonds fall with the surface
potential as a power of it, and a line through their logarithms says where they are one.

What does not wait for any run is B2, that of hard spheres 1: by Noro and Frenkel suspensions with
such short attractions part into gas and liquid at about -1.5.
"""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure
from scipy.optimize import brentq

from analysis import RunDirectory, correlated_mean
from analysis.arrays import Array
from analysis.clusters import BOND, cluster_series
from analysis.estimate import Estimate
from analysis.line_fit import fit_polynomial
from analysis.second_virial import CRITICAL, reduced_second_virial
from lammps_inputs import Scene
from lammps_inputs.scenes.claylike import Claylike
from narrows.papers.drawing import COLOURS, points
from narrows.papers.figure import Column, Directories, Outcome, PaperFigure, Quality
from narrows.papers.hecht_2005.structure import production
from narrows.papers.results import Result, claimed, measured

NUMBER = "beyond-boundary"
KAPPAS = (1.4e8, 1.6e8, 2.0e8)  # of Fig. 9; at 1e8 / m no surface potential makes clusters [1/m]
SURFACE_POTENTIALS = {  # by volume fraction and KAPPAS, on either side of the boundary [mV]
    0.07: ((20, 25, 35), (20, 25, 35), (20, 25, 35)),
    0.14: ((20, 35, 50), (20, 35, 50), (20, 35, 50)),
    0.28: ((20, 35), (20, 35, 50), (80, 120)),
}
START, DOWN = 25, 11  # where the way out of clusters begins [mV], and its seed
ANEW = (1.6e8, 2.0e8)  # screening at which it is gone
CLUSTERED = 1.0  # bonds per colloid
WIDER = 1.15  # distance of bonded centres over the diameter, to see what it matters
FARTHEST = 1.25  # from the measured surface potentials to the boundary, as a factor
CHANGING = 0.1  # of the bonds, from which on a state is not yet what it will be
SHORT = "a lower bound: runs are short beside the slow motion in their bonds"
CROSSED = 5.0  # a lower barrier is crossed, and the primary minimum counts too [kBT]
WEAKEST, STRONGEST = 0.01, 0.2  # surface potentials: no barrier, and close to all repulsion [V]
INNERMOST, OUTERMOST = 0.9, 2.5  # distances of the integrals over the diameter


def scenes_at(fraction: float, kappa: float, quality: Quality) -> dict[int, Claylike]:
    """From a lattice, by surface potential [mV]."""
    chosen = SURFACE_POTENTIALS[fraction][KAPPAS.index(kappa)]
    return {psi: production(psi / 1e3, kappa, fraction, quality) for psi in chosen}


def way_out(kappa: float, quality: Quality) -> dict[int, Claylike]:
    """14 %, each run but the first from the end of the one before, by surface potential [mV]."""
    return {psi: production(psi / 1e3, kappa, 0.14, quality, seed=DOWN) for psi in (START, 35, 50)}


def ladders(quality: Quality) -> list[list[Scene]]:
    """From clusters towards the suspension."""
    return [list(way_out(kappa, quality).values()) for kappa in ANEW]


def from_lattice(quality: Quality) -> list[Scene]:
    """All states, each from a lattice."""
    return [
        scene
        for fraction in SURFACE_POTENTIALS
        for kappa in KAPPAS
        for scene in scenes_at(fraction, kappa, quality).values()
    ]


@dataclass(frozen=True)
class Attraction:
    """What the potential of a scene says of itself.

    Attributes:
        depth: of the minimum that colloids reach [kBT].
        virial: B2 over that of hard spheres.
    """

    depth: float
    virial: float


def attraction(surface_potential: float, kappa: float) -> Attraction:
    """Of what is outside the barrier, or of all where there is little of it.

    Args:
        surface_potential: [V].
        kappa: [1/m].
    """
    between = Claylike.make(surface_potential=surface_potential, kappa=kappa).between
    assert between is not None
    d = between.diameter
    distance = np.linspace(INNERMOST * d, OUTERMOST * d, 8_001)
    energy = between.energy(distance)
    outside = distance > between.joint
    if between.barrier > CROSSED:
        top = int(np.argmax(np.where(outside, energy, -np.inf)))
        distance, energy = distance[top:], energy[top:]
    return Attraction(-float(energy.min()), reduced_second_virial(distance, energy))


def theory(kappa: float) -> float | None:
    """Surface potential at which B2 is critical, or the barrier opens, whichever is higher [V].

    None where none up to `STRONGEST` is enough.

    Args:
        kappa: [1/m].
    """

    def excess(psi: float) -> float:
        return attraction(psi, kappa).virial - CRITICAL

    if excess(STRONGEST) < 0:
        return None
    return float(brentq(excess, WEAKEST, STRONGEST, xtol=1e-5))


@dataclass(frozen=True)
class State:
    """Of a run.

    Attributes:
        bonds, wider: per colloid in its second half, of `BOND` and of `WIDER` diameters.
        share: of the colloids in the largest cluster there.
        last: bonds in the last quarter.
        drift: bonds in the last quarter less in the third.
    """

    bonds: Estimate
    wider: Estimate
    share: Estimate
    last: Estimate
    drift: Estimate

    @property
    def settled(self) -> bool:
        """Whether bonds change by less than `CHANGING` from the third quarter to the last."""
        return abs(self.drift.number) < CHANGING * self.bonds.number


def state(run: RunDirectory) -> State:
    """Bonds in the second half of a run, and whether they still grow."""
    frames, box = run.particles().positions, run.box
    frames = frames[len(frames) // 2 :]
    diameter = 2 * run.species().radius
    series = cluster_series(frames, box.sizes, box.periodic, BOND * diameter)
    wider = cluster_series(frames, box.sizes, box.periodic, WIDER * diameter)
    third, last = np.array_split(series.bonds_per_colloid, 2)

    def mean(values: Array) -> Estimate:
        return correlated_mean.mean(values, run.interval)

    return State(
        mean(series.bonds_per_colloid),
        mean(wider.bonds_per_colloid),
        mean(series.largest / frames.shape[1]),
        mean(last),
        mean(last) - mean(third),
    )


def _short(used: Iterable[Estimate]) -> str | None:
    """That errors of some are lower bounds, if so."""
    return SHORT if any(each.reason for each in used) else None


def crossing(
    surface_potentials: Sequence[float], bonds: Sequence[Estimate], level: float = CLUSTERED
) -> Estimate:
    """Where bonds fall to a level: ln(bonds) against ln(Psi_0) is a line there.

    Weighted least squares; the error is that of the line at the crossing over its slope. Where
    points lie about the line beyond their errors, it is enlarged by as much. None where bonds do
    not fall, or that is farther than a factor `FARTHEST` from all points.

    Args:
        surface_potentials: Psi_0, (n,).
        bonds: per colloid, positive with errors, (n,).
        level: of bonds.
    """
    places = np.log(np.asarray(surface_potentials, dtype=float))
    logarithms = [
        Estimate(math.log(each.number / level), each.standard_error / each.number) for each in bonds
    ]
    line = fit_polynomial(places, logarithms)
    if not line.slope.number < 0:
        return Estimate(None, None, "bonds do not fall with the surface potential")
    root = -line.intercept.number / line.slope.number
    beyond = max(root - places.max(), places.min() - root)
    if beyond > math.log(FARTHEST):
        side = "below" if root < places.min() else "above"
        return Estimate(None, None, f"{side} all surface potentials of the runs")
    there = fit_polynomial(places - root, logarithms)
    value = math.exp(root)
    error = value * there.intercept.standard_error / abs(there.slope.number)
    return Estimate(value, error, _short(bonds))


def through(function: Callable[[float], float], at: Estimate) -> Estimate:
    """A function of a measured number, to first order in its error."""
    if at.value is None:
        return at
    step = 1e-3 * at.value
    slope = (function(at.value + step) - function(at.value - step)) / (2 * step)
    return Estimate(function(at.value), abs(slope) * at.standard_error, at.reason)


def boundary_of(
    states: dict[tuple[float, float, int], State], of: Callable[[State], Estimate]
) -> dict[tuple[float, float], Estimate]:
    """Crossings by volume fraction and screening [mV]."""
    keys = dict.fromkeys((fraction, kappa) for fraction, kappa, _ in states)
    found = {}
    for fraction, kappa in keys:
        row = {p: each for (f, k, p), each in states.items() if (f, k) == (fraction, kappa)}
        known = {psi: of(each) for psi, each in row.items() if of(each).number > 0}
        found[fraction, kappa] = crossing(list(known), list(known.values()))
    return found


def _make(directories: Directories, quality: Quality) -> Outcome:
    states = {
        (fraction, kappa, psi): state(directories[scene])
        for fraction in SURFACE_POTENTIALS
        for kappa in KAPPAS
        for psi, scene in scenes_at(fraction, kappa, quality).items()
    }
    boundary = boundary_of(states, lambda each: each.bonds)
    again = {
        (kappa, psi): state(directories[scene])
        for kappa in ANEW
        for psi, scene in way_out(kappa, quality).items()
    }
    results: list[Result] = []
    for (fraction, kappa), place in boundary.items():
        results += _boundary(fraction, kappa, place)
    results += _shifts(states, boundary)
    results += _ways(states, again)
    return Outcome(_draw(states, boundary, again), _table(states, again), results)


def _boundary(fraction: float, kappa: float, place: Estimate) -> list[Result]:
    """The place, and what the potential says of itself there."""
    where = f"{fraction:.0%}, {kappa:.2g} / m"
    results = [measured(NUMBER, f"boundary at {where} [mV]", place)]
    if place.value is not None:
        depth = through(lambda psi: attraction(psi / 1e3, kappa).depth, place)
        virial = through(lambda psi: attraction(psi / 1e3, kappa).virial, place)
        results.append(measured(NUMBER, f"depth of the minimum there [kBT], {where}", depth))
        results.append(measured(NUMBER, f"B2 over hard spheres' there, {where}", virial))
    return results


def _shifts(
    states: dict[tuple[float, float, int], State], boundary: dict[tuple[float, float], Estimate]
) -> list[Result]:
    """The claim of the paper, and what the boundary owes to its definition and to time."""
    results = []
    for fraction in SURFACE_POTENTIALS:
        rise = boundary[fraction, KAPPAS[-1]] - boundary[fraction, KAPPAS[-2]]
        results.append(
            claimed(
                NUMBER,
                f"boundary at {KAPPAS[-1]:.2g} less at {KAPPAS[-2]:.2g} / m, {fraction:.0%} [mV]",
                rise,
                "the transition depends on both the screening length and the surface potential",
                "positive",
            )
        )
    wider = boundary_of(states, lambda each: each.wider)
    last = boundary_of(states, lambda each: each.last)
    for key, place in boundary.items():
        fraction, kappa = key
        where = f"{fraction:.0%}, {kappa:.2g} / m"
        for other, words in (
            (wider, f"with bonds of {WIDER:g} diameters less of {BOND:g}"),
            (last, "in the last quarter of the runs less in the last half"),
        ):
            if place.value is not None and other[key].value is not None:
                shift = Estimate(other[key].number - place.number, None, "of the same runs")
                results.append(measured(NUMBER, f"boundary {words}, {where} [mV]", shift))
    unsettled = sum(not each.settled for each in states.values())
    told = f"of {len(states)} states from a lattice, those whose bonds still change"
    results.append(measured(NUMBER, told, Estimate(float(unsettled), 0.0)))
    return results


def left_over(out: Estimate, anew: Estimate, before: Estimate) -> Estimate:
    """(out - anew) / (before - anew) of three independent numbers, to first order in their errors.

    Args:
        out: of a run that began with another's end.
        anew: of one from a lattice.
        before: of that other.
    """
    ahead = before.number - anew.number
    share = (out.number - anew.number) / ahead
    parts = (out.standard_error, (1 - share) * anew.standard_error, share * before.standard_error)
    return Estimate(share, math.hypot(*parts) / abs(ahead), _short((out, anew, before)))


def _ways(
    states: dict[tuple[float, float, int], State], again: dict[tuple[float, int], State]
) -> list[Result]:
    """From clusters less from a lattice: what is left of the start."""
    results, before = [], Estimate(None, None)
    for (kappa, psi), out in again.items():
        if (0.14, kappa, psi) in states:
            anew = states[0.14, kappa, psi].last
            where = f"{psi} mV, {kappa:.2g} / m"
            told = f"bonds in the last quarter, from clusters less from a lattice, {where}"
            same = "the state does not depend on the start"
            results.append(claimed(NUMBER, told, out.last - anew, same, "zero"))
            told = f"the same over those by which the start was ahead, {where}"
            results.append(measured(NUMBER, told, left_over(out.last, anew, before)))
        before = out.last
    return results


def _draw(
    states: dict[tuple[float, float, int], State],
    boundary: dict[tuple[float, float], Estimate],
    again: dict[tuple[float, int], State],
) -> Figure:
    figure = Figure(figsize=(12.0, 4.2), layout="constrained")
    left, right = figure.subplots(1, 2)
    for number, fraction in enumerate(SURFACE_POTENTIALS):
        for kappa, style in zip(KAPPAS, (":", "--", "-"), strict=True):
            row = {p: s for (f, k, p), s in states.items() if (f, k) == (fraction, kappa)}
            label = f"{fraction:.0%}, {kappa:.2g} / m"
            bonds = [each.bonds for each in row.values()]
            points(left, list(row), bonds, number, label=label, linestyle=style, linewidth=0.8)
            growing = [(p, s.bonds.number) for p, s in row.items() if not s.settled]
            if growing:
                left.plot(*zip(*growing, strict=True), "o", mfc="w", mec=COLOURS[number], zorder=3)
        places = [boundary[fraction, kappa] for kappa in KAPPAS]
        known = [(k / 1e8, e) for k, e in zip(KAPPAS, places, strict=True) if e.value is not None]
        if known:
            x, y = zip(*known, strict=True)
            points(right, x, y, number, label=f"{fraction:.0%}", linestyle="-")
    out = [(psi, each.last.number) for (_, psi), each in again.items() if psi != START]
    left.plot(*zip(*out, strict=True), "x", color="0.3", label="14 %, from clusters")
    left.axhline(CLUSTERED, color="0.6", linewidth=0.8)
    left.set(xlabel=r"surface potential $\Psi_0$ [mV]", ylabel="bonds per colloid")
    left.set(xscale="log", yscale="log")
    left.minorticks_off()
    left.set_xticks([20, 30, 50, 80, 120], ["20", "30", "50", "80", "120"])
    left.set_yticks([0.2, 0.5, 1, 2], ["0.2", "0.5", "1", "2"])
    left.legend(loc="upper left", bbox_to_anchor=(1, 1))
    line = [(kappa, theory(kappa)) for kappa in np.linspace(1.3e8, 2.1e8, 9)]
    drawn = [(kappa / 1e8, 1e3 * psi) for kappa, psi in line if psi is not None]
    right.plot(
        *zip(*drawn, strict=True), color="0.3", label=f"$B_2$ = {CRITICAL:g} of hard spheres'"
    )
    right.set(xlabel=r"$\kappa$ [$10^8$ / m]", ylabel=r"$\Psi_0$ at the boundary [mV]")
    right.text(0.45, 0.85, "suspended", color="0.4", transform=right.transAxes)
    right.text(0.8, 0.05, "clustered", color="0.4", transform=right.transAxes)
    right.legend()
    return figure


def _table(
    states: dict[tuple[float, float, int], State], again: dict[tuple[float, int], State]
) -> dict[str, Column]:
    rows = [(f, k, p, "lattice", each) for (f, k, p), each in states.items()]
    rows += [
        (0.14, k, p, "lattice" if p == START else "clusters", each)
        for (k, p), each in again.items()
    ]
    table: dict[str, Column] = {
        "volume_fraction": [row[0] for row in rows],
        "kappa": [f"{row[1]:.2g}" for row in rows],
        "surface_potential_mV": [row[2] for row in rows],
        "start": [row[3] for row in rows],
    }
    for name in ("bonds", "share", "last", "drift"):
        values = [getattr(row[-1], name) for row in rows]
        table[name] = [each.value for each in values]
        table[f"{name}_error"] = [each.error for each in values]
    return table


FIGURES = (
    PaperFigure(
        NUMBER,
        "Bonds per colloid by surface potential, and the boundary where there is one. Open: bonds "
        "still change. Above each line colloids are suspended, below it clustered.",
        _make,
        lambda quality: [
            *from_lattice(quality),
            *(scene for ladder in ladders(quality) for scene in ladder),
        ],
    ),
)

"""Ends of a long released chain, measured and predicted: fronts and outermost spacings in time.

One law: rho alone, d_t rho + d_x J(rho) = 0 with the J of homogeneous channels. Two laws: rho and
the fluid it drags along, `analysis.two_fluid`. Neither has a parameter fitted to these runs. All in
the frame at rest, in which the runs conserve colloids and fluid, but not momentum: walls take it.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from analysis import RunDirectory
from analysis.arrays import Array
from analysis.estimate import Estimate, mean_of_independent
from analysis.front import Front, coarse_density, fit_front, places
from analysis.two_fluid import TwoFluid
from lammps_inputs.scenes.channel import Channel
from lattice.hydrodynamics import CurrentRelation, solve
from narrows.papers.figure import Directories
from narrows.papers.tabatabaei_2009.beyond_flux import Constants, Law

SPACING, GROUP = 5.0, 20  # of the chain at the start [a0]; spacings in a group at an end
BIN, CELL = 10.0, 2.0  # of densities, and of the solvers [a0]
MARGIN = 400.0  # of the solvers' grid behind the chain [a0]
REACH = 500.0  # of the tail, that is fitted [a0]
STEP, SETTLED = 30.0, 120.0  # between two fits; from when on rates are fitted [t0]
REPLICAS = 6  # of the measured law, for the errors of what it predicts


@dataclass(frozen=True)
class Ends:
    """Fronts and outermost spacings of a chain in time.

    Attributes:
        times: (T,) [t0].
        tail, head: positions, (T,) [a0].
        tail_width, head_width: (T,) [a0].
        tail_spacing, head_spacing: means of the outermost `GROUP` spacings, (T,) [a0].
        edges, density: bins, (B + 1,) [a0], and the density in them, (T, B) [1/a0^2].
    """

    times: Array
    tail: Array
    head: Array
    tail_width: Array
    head_width: Array
    tail_spacing: Array
    head_spacing: Array
    edges: Array
    density: Array


MEASURES = ("tail", "head", "tail_width", "head_width", "tail_spacing", "head_spacing")


def _times(scene: Channel) -> Array:
    return np.arange(0.0, scene.duration + 1e-9, STEP)


def _edges(scene: Channel) -> Array:
    return np.arange(-BIN * 5, scene.colloids * SPACING + 30 * BIN + 1e-9, BIN)


def _ends(scene: Channel, density: Array, outermost: Array) -> Ends:
    """Fits to binned densities; outermost places: (T, 4), of both ends of both groups."""
    edges = _edges(scene)
    x = (edges[1:] + edges[:-1]) / 2
    length = scene.colloids * SPACING
    at_tail, tails, heads = x < min(REACH, length / 2), list[Front](), list[Front]()
    for row, foremost in zip(density, outermost[:, 3], strict=True):
        at_head = (x > foremost - 5 * BIN) & (x < foremost + 10 * BIN)
        tails.append(fit_front(x[at_tail], row[at_tail], side=1))
        heads.append(fit_front(x[at_head], row[at_head], side=-1))
    return Ends(
        _times(scene),
        np.array([front.position for front in tails]),
        np.array([front.position for front in heads]),
        np.array([front.width for front in tails]),
        np.array([front.width for front in heads]),
        (outermost[:, 1] - outermost[:, 0]) / GROUP,
        (outermost[:, 3] - outermost[:, 2]) / GROUP,
        edges,
        density,
    )


def measured_ends(run: RunDirectory, scene: Channel) -> Ends:
    """Fits to a run of the scene."""
    x = run.particles().positions[:, :, 0]
    frames = np.round(_times(scene) / run.interval).astype(int)
    chosen = np.sort(x[frames], axis=1)
    density = np.array([coarse_density(row, _edges(scene), scene.width) for row in chosen])
    return _ends(scene, density, chosen[:, [0, GROUP, -1 - GROUP, -1]])


def _predicted_ends(scene: Channel, density: Array) -> Ends:
    """Of densities in the solvers' cells, (T, N)."""
    cells = CELL * np.arange(density.shape[1] + 1) - MARGIN
    numbers = np.array([0.5, GROUP + 0.5, scene.colloids - GROUP - 0.5, scene.colloids - 0.5])
    outermost = np.array([places(row, cells, scene.width, list(numbers)) for row in density])
    start, bins = round((_edges(scene)[0] + MARGIN) / CELL), len(_edges(scene)) - 1
    ratio = round(BIN / CELL)
    part = density[:, start : start + bins * ratio]
    return _ends(scene, part.reshape(len(part), bins, ratio).mean(axis=2), outermost)


def _start(scene: Channel) -> Array:
    """The chain as a block of even density in the solvers' cells."""
    rho = np.zeros(round(scene.length / CELL))
    first = round(MARGIN / CELL)
    rho[first : first + round(scene.colloids * SPACING / CELL)] = 1 / (SPACING * scene.width)
    return rho


def one_law(scene: Channel, of: Constants) -> Ends:
    """d_t rho + d_x [rho (c' + c rho)] = 0, the entropy solution."""
    relation = CurrentRelation(
        lambda rho: rho * (of.intercept + of.slope * rho),
        lambda rho: of.intercept + 2 * of.slope * rho,
        0.0,
        1 / (4 * scene.width),
    )
    return _predicted_ends(scene, solve(relation, _start(scene), _times(scene) / scene.length))


def two_laws(scene: Channel, of: Constants) -> Ends:
    """The same speeds, with the fluid that piles up ahead of the chain."""
    suspension = TwoFluid(
        lambda rho: of.intercept + of.slope * rho,
        lambda rho: np.full_like(rho, of.coupling),
        of.permeability,
        scene.colloid_mass * scene.gravity,
        np.pi * scene.colloid_radius**2,
        scene.density,
    )
    density, _ = suspension.solve(_start(scene), CELL, _times(scene))
    return _predicted_ends(scene, density)


LAWS: dict[str, Callable[[Channel, Constants], Ends]] = {"one law": one_law, "two laws": two_laws}


@dataclass(frozen=True)
class Comparison:
    """Chains of one kind beside what each law predicts.

    Attributes:
        runs: measured, by seed.
        predicted: by law, with the measured constants.
        replicas: by law, with constants within their errors.
    """

    runs: tuple[Ends, ...]
    predicted: dict[str, Ends]
    replicas: dict[str, tuple[Ends, ...]]

    def measured_rate(self, measure: str) -> Estimate:
        """Growth of a measure, mean over seeds."""
        return mean_of_independent([rate(run, measure) for run in self.runs])

    def predicted_rate(self, law: str, measure: str) -> Estimate:
        """The same as predicted."""
        error = float(np.std([rate(ends, measure) for ends in self.replicas[law]], ddof=1))
        return Estimate(rate(self.predicted[law], measure), error)

    def mean(self, measure: str) -> tuple[Array, Array]:
        """Over seeds, with its standard error."""
        values = np.array([getattr(run, measure) for run in self.runs])
        return values.mean(axis=0), values.std(axis=0, ddof=1) / np.sqrt(len(values))


def rate(ends: Ends, measure: str) -> float:
    """Slope of one of `MEASURES` in time, from `SETTLED` on [a0/t0]."""
    used = ends.times >= SETTLED
    return float(np.polyfit(ends.times[used], getattr(ends, measure)[used], 1)[0])


@cache
def _predict(law: Law, scene: Channel) -> tuple[dict[str, Ends], dict[str, tuple[Ends, ...]]]:
    rng = np.random.Generator(np.random.Philox(key=[scene.seed, 5]))
    others = [law.replica(rng) for _ in range(REPLICAS)]
    predicted = {name: predict(scene, law.constants) for name, predict in LAWS.items()}
    replicas = {
        name: tuple(predict(scene, each) for each in others) for name, predict in LAWS.items()
    }
    return predicted, replicas


def compare(directories: Directories, scenes: Sequence[Channel], law: Law) -> Comparison:
    """Runs of chains that differ in their seed, and what the laws say of them."""
    runs = tuple(measured_ends(directories[scene], scene) for scene in scenes)
    return Comparison(runs, *_predict(law, scenes[0]))

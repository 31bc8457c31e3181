"""Diffusivity from the steady state of a colour reaction (carmer-2012)."""

from typing import Any

import numpy as np
from MDAnalysis.analysis.base import AnalysisBase
from numpy.typing import ArrayLike

from analysis.arrays import Array
from analysis.diffusivity.blocks import jackknife
from analysis.diffusivity.coordinates import Coordinate
from analysis.diffusivity.errors import DiffusivityError
from analysis.diffusivity.local_fit import local_derivative

BLOCKS = 10
MIN_REACTIONS = 100


def color_diffusivity(
    positions: Array,
    width: float,
    number: ArrayLike,
    colored: ArrayLike,
    rate: ArrayLike,
    reach: float,
) -> tuple[Array, Array]:
    """D(q) = J / (lambda dx/dq): (2) of carmer-2012, and its corrected (3).

    lambda is the number of walkers per length of the coordinate and J the rate of reactions: with
    area A, lambda = A rho and J = A j, so that the area, constant in a slit and 4 pi r^2 about a
    particle, cancels. The printed (3) has 2x/r besides, which is wrong: docs/errata.md.

    Args:
        positions: middles of the bins, (B,).
        width: of a bin.
        number: walkers in each bin, averaged over time, by block (blocks, B).
        colored: of them A, (blocks, B).
        rate: A that flow from the upper to the lower surface per time, by block (blocks,).
        reach: half width of the window of the local cubic fit of x.

    Returns:
        D and its standard error (jackknife over blocks), (B,), NaN where nothing is known.
    """

    def profile(n: Array, a: Array, j: Array) -> Array:
        with np.errstate(divide="ignore", invalid="ignore"):
            x = np.where(n > 0, a / n, 0.0)
            return np.asarray(j * width / (n * local_derivative(positions, x, n, reach)))

    return jackknife(profile, *(np.asarray(each, dtype=float) for each in (number, colored, rate)))


class ColorDiffusivity(AnalysisBase):  # type: ignore[misc]
    """Colours laid on a trajectory: they react beyond two surfaces, D follows from their slope.

    In every frame a walker beyond the lower surface turns from A to B with probability p, one
    beyond the upper from B to A. Instead of a lottery each walker carries the probability q of
    being A, the exact mean over all lotteries. Between the surfaces D = J / (lambda dx/dq).

    Args:
        coordinate: `AlongAxis` or `PairDistance`.
        low, high: the two surfaces.
        probability: p, in each frame.
        bin_width: of the profiles; by default a hundredth of high - low.
        reach: half width of the window of the local cubic fit; by default ten bins.
        settle: fraction of the frames left out, in which the colours become steady.
        blocks: of time, for the errors.

    Attributes:
        results.positions: middles of the bins (B,).
        results.diffusivity, results.error: D and its standard error (B,) [length^2/time].
        results.density: walkers per length of the coordinate (B,).
        results.composition: x, fraction of A (B,).
        results.rate: reactions per time at the lower and at the upper surface; equal when steady.
    """

    def __init__(
        self,
        coordinate: Coordinate,
        low: float,
        high: float,
        *,
        probability: float = 0.1,
        bin_width: float | None = None,
        reach: float | None = None,
        settle: float = 0.2,
        blocks: int = BLOCKS,
        **options: Any,
    ) -> None:
        super().__init__(coordinate.trajectory, **options)
        if not low < high:
            raise DiffusivityError(f"low: {low:g}; it must be below high, {high:g}")
        if not 0 < probability <= 1:
            raise DiffusivityError(f"probability: {probability:g}; it must be in (0, 1]")
        if not 0 <= settle < 1:
            raise DiffusivityError(f"settle: {settle:g}; it must be in [0, 1)")
        if blocks < 3:
            raise DiffusivityError(f"blocks: {blocks}; at least 3 are needed")
        self._coordinate, self._low, self._high = coordinate, low, high
        self._probability, self._settle, self._blocks = probability, settle, blocks
        bins = max(round((high - low) / (bin_width or (high - low) / 100)), 1)
        self._width = (high - low) / bins
        self._positions = low + self._width * np.arange(0.5, bins)
        self._reach = reach or 10 * self._width

    def _prepare(self) -> None:
        bins = len(self._positions)
        self._skipped = round(self._settle * self.n_frames)
        if self.n_frames - self._skipped < self._blocks:
            raise DiffusivityError(
                f"{self.n_frames} frames; more are needed for {self._blocks} blocks"
            )
        self._number, self._colored = np.zeros((2, self._blocks, bins))
        self._reactions = np.zeros((self._blocks, 2))
        self._frames = np.zeros(self._blocks)
        self._chance = np.zeros(0)

    def _single_frame(self) -> None:
        value = self._coordinate.values()
        if self._frame_index == 0:
            self._chance = np.clip((value - self._low) / (self._high - self._low), 0, 1)
        q, p = self._chance, self._probability
        below, above = value <= self._low, value >= self._high
        lost, gained = p * q[below], p * (1 - q[above])
        q[below] -= lost
        q[above] += gained
        frame = self._frame_index - self._skipped
        if frame < 0:
            return
        block = frame * self._blocks // (self.n_frames - self._skipped)
        between = ~(below | above)
        place = ((value[between] - self._low) / self._width).astype(np.intp)
        bins = len(self._positions)
        place = np.minimum(place, bins - 1)
        self._number[block] += np.bincount(place, minlength=bins)
        self._colored[block] += np.bincount(place, q[between], bins)
        self._reactions[block] += lost.sum(), gained.sum()
        self._frames[block] += 1

    def _conclude(self) -> None:
        step = frame_time(self)
        expected = self._reactions.sum()
        if expected < MIN_REACTIONS:
            raise DiffusivityError(
                f"{expected:.3g} reactions; at least {MIN_REACTIONS} are needed: a longer "
                "trajectory, nearer surfaces or a higher probability"
            )
        frames = self._frames.sum()
        number, colored = self._number.sum(axis=0), self._colored.sum(axis=0)
        with np.errstate(divide="ignore", invalid="ignore"):
            self.results.composition = np.where(number > 0, colored / number, np.nan)
        self.results.positions = self._positions
        self.results.density = number / (frames * self._width)
        self.results.rate = self._reactions.sum(axis=0) / (frames * step)
        self.results.diffusivity, self.results.error = color_diffusivity(
            self._positions,
            self._width,
            self._number,
            self._colored,
            self._reactions.mean(axis=1) / step,
            self._reach,
        )


def frame_time(analysis: Any) -> float:
    """Time between the frames of a run, which must be uniform."""
    times = np.asarray(analysis.times)
    if len(times) < 2:
        raise DiffusivityError(f"{len(times)} frames; at least 2 are needed")
    steps = np.diff(times)
    if not np.allclose(steps, steps.mean(), rtol=1e-3) or steps.mean() <= 0:
        raise DiffusivityError("the frames are not equally spaced in time")
    return float(steps.mean())

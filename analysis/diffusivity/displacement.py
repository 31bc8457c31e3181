"""Diffusivity in the middle by the mean squared displacement: a check of the profiles."""

from typing import Any

import numpy as np
from MDAnalysis.analysis.base import AnalysisBase

from analysis.diffusivity.blocks import jackknife
from analysis.diffusivity.color import BLOCKS, frame_time
from analysis.diffusivity.coordinates import Coordinate
from analysis.diffusivity.errors import DiffusivityError

SHARE = 1 / 3  # of the width, in the middle: where a displacement begins
FARTHEST = 1 / 8  # of the width, rms: the ends then take 0.6 % off the slope, of 1 / 6 5 %
LONGEST = 64  # lag, in frames
MIN_DISPLACEMENTS = 100


class MiddleDiffusivity(AnalysisBase):  # type: ignore[misc]
    """D in the middle third, half the slope of the mean squared displacement from there.

    Displacements begin in the middle third and may end anywhere. The slope is that between half
    the longest lag and it, so that what happens before velocities are forgotten adds a constant
    and no more; the longest lag is that in which walkers move, rms, by an eighth of the width.
    Where D and the density depend on the coordinate it is a mean over what walkers reach in it.

    Args:
        coordinate: `AlongAxis`, or another with two ends.
        low, high: the ends.
        longest: lag that is looked at, in frames.
        blocks: of time, for the errors.

    Attributes:
        results.diffusivity, results.error: D and its standard error [length^2/time].
        results.lags, results.msd: times and mean squared displacements, (lags,).
        results.window: the two lags of the slope.
        results.freedom: degrees of freedom of the error.
    """

    def __init__(
        self,
        coordinate: Coordinate,
        low: float,
        high: float,
        *,
        longest: int = LONGEST,
        blocks: int = BLOCKS,
        **options: Any,
    ) -> None:
        super().__init__(coordinate.trajectory, **options)
        if not low < high:
            raise DiffusivityError(f"low: {low:g}; it must be below high, {high:g}")
        if longest < 2:
            raise DiffusivityError(f"longest: {longest}; a slope needs 2 lags")
        if blocks < 3:
            raise DiffusivityError(f"blocks: {blocks}; at least 3 are needed")
        self._coordinate, self._low, self._high = coordinate, low, high
        self._longest, self._blocks = longest, blocks

    def _prepare(self) -> None:
        self._longest = min(self._longest, (self.n_frames - 1) // 2)
        if self._longest < 2 or self.n_frames < self._blocks:
            raise DiffusivityError(
                f"{self.n_frames} frames; more are needed for {self._blocks} blocks"
            )
        self._squares, self._count = np.zeros((2, self._blocks, self._longest))
        self._past: list[Any] = []  # of the last frames: values, and who was in the middle

    def _single_frame(self) -> None:
        value = self._coordinate.values()
        block = self._frame_index * self._blocks // self.n_frames
        for lag, (before, inside) in enumerate(reversed(self._past)):
            moved = value[inside] - before
            self._squares[block, lag] += moved @ moved
            self._count[block, lag] += len(moved)
        middle, width = (self._low + self._high) / 2, self._high - self._low
        inside = np.flatnonzero(np.abs(value - middle) < SHARE * width / 2)
        self._past = [*self._past[-self._longest + 1 :], (value[inside], inside)]

    def _conclude(self) -> None:
        step = frame_time(self)
        total = self._count.sum(axis=0)
        if total.min() < MIN_DISPLACEMENTS:
            raise DiffusivityError(
                f"{int(total.min())} displacements begin in the middle third; at least "
                f"{MIN_DISPLACEMENTS} are needed: a longer trajectory"
            )
        msd = self._squares.sum(axis=0) / total
        farthest = (FARTHEST * (self._high - self._low)) ** 2
        last = int(np.sum(np.maximum.accumulate(msd) <= farthest))  # in frames
        if last < 2:
            raise DiffusivityError(
                f"walkers move by {np.sqrt(msd[1]):.3g} in two frames; at most "
                f"{np.sqrt(farthest):.3g}, an eighth of the width, is allowed: finer frames"
            )
        first = last // 2
        self.results.lags = step * np.arange(1, self._longest + 1)
        self.results.msd = msd
        self.results.window = step * first, step * last
        self.results.freedom = self._blocks - 1

        def half_slope(squares: Any, count: Any) -> Any:
            found = squares / count
            return np.atleast_1d(found[last - 1] - found[first - 1]) / (2 * step * (last - first))

        d, error = jackknife(half_slope, self._squares, self._count)
        self.results.diffusivity, self.results.error = float(d[0]), float(error[0])

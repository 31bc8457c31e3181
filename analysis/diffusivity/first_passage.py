"""Diffusivity from the times of round trips.

F. Sedlmeier et al., J. Stat. Phys. 145, 240 (2011): for diffusion with the equilibrium distribution
P(q) the mean time of a round trip from q to a target and back is the integral of 1/(P D) between
them, so D(q) = 1 / (P(q) |d tau / d q|). Round trips that are quicker than diffusion add a constant
to tau as long as q is not near the target, and constants leave the slope.
"""

from typing import Any

import numpy as np
from MDAnalysis.analysis.base import AnalysisBase

from analysis.arrays import Array
from analysis.diffusivity.blocks import jackknife
from analysis.diffusivity.color import BLOCKS, frame_time
from analysis.diffusivity.coordinates import Coordinate
from analysis.diffusivity.errors import DiffusivityError
from analysis.diffusivity.local_fit import local_derivative

MIN_TRIPS = 20


class FirstPassageDiffusivity(AnalysisBase):  # type: ignore[misc]
    """D from round trips between each level and the far one of two targets.

    Levels in the lower half have their round trips with the upper target, and the reverse. A walker
    makes a round trip to every level that it has reached between two visits to the target; in a
    total time T with n round trips tau = T / n. Trips that end in the first part of the trajectory
    are not counted: what was reached before it began is unknown.

    Args:
        coordinate: `AlongAxis` or `PairDistance`.
        low, high: the two targets; levels lie between them.
        bin_width: between levels; by default a hundredth of high - low.
        reach: half width of the window of the local cubic fit of tau; by default ten bins.
        settle: fraction of the frames in which no trip is counted; longer than tau, if possible.
        blocks: of time, for the errors.

    Attributes:
        results.positions: middles of the bins (B,).
        results.diffusivity, results.error: D and its standard error (B,) [length^2/time].
        results.density: walkers per length of the coordinate (B,).
        results.trips: round trips to each bin (B,).
    """

    def __init__(
        self,
        coordinate: Coordinate,
        low: float,
        high: float,
        *,
        bin_width: float | None = None,
        reach: float | None = None,
        settle: float = 0.2,
        blocks: int = BLOCKS,
        **options: Any,
    ) -> None:
        super().__init__(coordinate.trajectory, **options)
        if not low < high:
            raise DiffusivityError(f"low: {low:g}; it must be below high, {high:g}")
        if not 0 <= settle < 1:
            raise DiffusivityError(f"settle: {settle:g}; it must be in [0, 1)")
        if blocks < 3:
            raise DiffusivityError(f"blocks: {blocks}; at least 3 are needed")
        self._coordinate, self._low, self._high = coordinate, low, high
        self._settle, self._blocks = settle, blocks
        bins = max(2 * round((high - low) / (bin_width or (high - low) / 100) / 2), 2)
        self._width = (high - low) / bins
        self._positions = low + self._width * np.arange(0.5, bins)
        self._reach = reach or 10 * self._width

    def _prepare(self) -> None:
        self._skipped = round(self._settle * self.n_frames)
        if self.n_frames - self._skipped < self._blocks:
            raise DiffusivityError(
                f"{self.n_frames} frames; more are needed for {self._blocks} blocks"
            )
        bins = len(self._positions)
        self._number = np.zeros((self._blocks, bins))
        self._trips = np.zeros((self._blocks, 2, bins))  # from the upper, from the lower target
        self._frames = np.zeros(self._blocks)

    def _single_frame(self) -> None:
        bins = len(self._positions)
        place = np.floor((self._coordinate.values() - self._low) / self._width).astype(np.intp)
        if self._frame_index == 0:
            self._lowest = np.full(len(place), bins)
            self._highest = np.full(len(place), -1)
        # deepest bin since the last visit to the target: a trip to it and to all on the way
        frame = self._frame_index - self._skipped
        if frame >= 0:
            block = frame * self._blocks // (self.n_frames - self._skipped)
            inside = (place >= 0) & (place < bins)
            self._number[block] += np.bincount(place[inside], minlength=bins)
            self._frames[block] += 1
            down = (place >= bins) & (self._lowest < bins)
            up = (place < 0) & (self._highest >= 0)
            reached = np.bincount(self._lowest[down], minlength=bins)
            self._trips[block, 0] += np.cumsum(reached)
            reached = np.bincount(self._highest[up], minlength=bins)
            self._trips[block, 1] += np.cumsum(reached[::-1])[::-1]
        self._lowest = np.where(place >= bins, bins, np.minimum(self._lowest, np.maximum(place, 0)))
        self._highest = np.where(
            place < 0, -1, np.maximum(self._highest, np.minimum(place, bins - 1))
        )

    def _conclude(self) -> None:
        step = frame_time(self)
        half = len(self._positions) // 2
        trips = self._trips.sum(axis=0)
        self.results.trips = np.where(np.arange(2 * half) < half, trips[0], trips[1])
        if self.results.trips.min() < MIN_TRIPS:
            raise DiffusivityError(
                f"{int(self.results.trips.min())} round trips to a level; at least {MIN_TRIPS} are "
                "needed: a longer trajectory or nearer targets"
            )
        self.results.positions = self._positions
        frames = self._frames.sum()
        self.results.density = self._number.sum(axis=0) / (frames * self._width)

        def profile(number: Array, count: Array, frames: Array) -> Array:
            time = float(frames) * step
            with np.errstate(divide="ignore", invalid="ignore"):
                tau = np.where(count > 0, time / count, 0.0)
                slope = []
                for side, edge in enumerate((0.5, -0.5)):  # a bin is reached at its near edge
                    levels = self._positions + edge * self._width
                    weights = np.minimum(count[side], 1.0)
                    slope.append(
                        local_derivative(levels, tau[side], weights, self._reach, self._positions)
                    )
                density = number / (float(frames) * self._width)
                joined = np.concatenate([-slope[0][:half], slope[1][half:]])
                return np.asarray(1 / (density * joined))

        self.results.diffusivity, self.results.error = jackknife(
            profile, self._number, self._trips, self._frames
        )

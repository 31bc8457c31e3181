"""State points of the settling colloids: runs that differ in their seed, and their mean speed.

A run is the time from 100 to 1100 t0 after the release of an evenly spaced chain on the mid-line.
The window matters, because colloids leave the mid-line slowly and are slower off it: the thesis
equilibrates for 1e5 steps, which is 100 t0 with its tau_MD of 0.001.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from numpy.typing import ArrayLike

from analysis import RunDirectory, correlated_mean
from analysis.estimate import Estimate
from analysis.line_fit import fit_polynomial
from analysis.settling import SettlingSeries, settling_series
from lammps_inputs import Scene
from lammps_inputs.scenes.channel import Channel
from narrows.papers.figure import Directories

SAMPLING = 3.0  # [t0]


@dataclass(frozen=True)
class Point:
    """A state point: runs that differ in their seed only."""

    scenes: tuple[Channel, ...]

    @property
    def length(self) -> float:
        """L_x [a0]."""
        return self.scenes[0].length

    @property
    def colloids(self) -> int:
        """N_c."""
        return self.scenes[0].colloids

    @property
    def density(self) -> float:
        """Number density N_c / (L_x L_y) [1/a0^2]."""
        return self.colloids / (self.length * self.scenes[0].width)

    @property
    def fraction(self) -> float:
        """Volume fraction phi, of disks in the plane (4.2)."""
        return math.pi * self.scenes[0].colloid_radius ** 2 * self.density


def channel_point(
    length: int,
    colloids: int,
    seeds: int,
    duration: float = 1000.0,
    first_seed: int = 1,
    **fields: Any,
) -> Point:
    """The thesis' parameters (Table 3.1 and 4.4), in a channel of this length."""
    return Point(
        tuple(
            Channel.make(
                length=length,
                colloids=colloids,
                duration=duration,
                sampling_interval=SAMPLING,
                seed=seed,
                **fields,
            )
            for seed in range(first_seed, first_seed + seeds)
        )
    )


def _read(run: RunDirectory) -> tuple[SettlingSeries, float]:
    """Speeds, and the mean square distance from the mid-line [a0^2]."""
    series = settling_series(run)
    y = run.particles().positions[1:, :, 1][: len(series.used)]
    return series, float(((y[series.used] - run.width / 2) ** 2).mean())


@dataclass(frozen=True)
class Speed:
    """What the runs of a point tell.

    Attributes:
        co_moving, rest: settling speed in the co-moving frame (4.9), and in that at rest [a0/t0].
        off_mid_line: root mean square of the colloids' distance from the mid-line [a0].
    """

    point: Point
    co_moving: Estimate
    rest: Estimate
    off_mid_line: float


def speed(directories: Directories, point: Point) -> Speed:
    """Mean over time and seeds, with the error of all runs together."""
    runs = [_read(directories[scene]) for scene in point.scenes]
    moving = correlated_mean.mean([series.co_moving[series.used] for series, _ in runs])
    rest = correlated_mean.mean([series.rest[series.used] for series, _ in runs])
    off = math.sqrt(sum(square for _, square in runs) / len(runs))
    return Speed(point, moving, rest, off)


def scenes_of(all_points: Iterable[Point]) -> list[Scene]:
    """Every run of the points."""
    return [scene for point in all_points for scene in point.scenes]


def fit(x: ArrayLike, y: Sequence[Estimate], degree: int = 1) -> list[Estimate]:
    """Coefficients of 1, x, x^2, ... of a polynomial through measured points."""
    return list(fit_polynomial(x, y, degree).coefficients)

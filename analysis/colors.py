"""The colours of a run of hard spheres, in blocks of time: what `docs/run-directory.md` lists."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analysis.arrays import Array
from analysis.diffusivity.blocks import jackknife
from analysis.estimate import Estimate
from analysis.run_directory import RunDirectory
from run_files import RunDirectoryError
from run_files.manifest import Reactions

MIN_OUTPUTS = 6  # after the equilibration
BLOCKS = 20


@dataclass(frozen=True)
class Colors:
    """Averages over blocks of time, n of them, for K reaction probabilities.

    Attributes:
        reactions: of the manifest.
        positions, width: middles of the bins (B,), and their width [a0].
        number: particles in each bin, summed over central ones, (n, B).
        labels, chances: of them A, by lot and by probability, (n, B, K).
        current: sum of the velocities of A along the axis, or outwards, by probability, (n, B, K).
        label_rates, chance_rates: reactions per time at the first and the second surface,
            (n, 2, K) [1/t0].
    """

    reactions: Reactions
    positions: Array
    width: float
    number: Array
    labels: Array
    chances: Array
    current: Array
    label_rates: Array
    chance_rates: Array

    @property
    def at_walls(self) -> bool:
        """Whether the surfaces are walls, not those about central particles."""
        return self.reactions.axis is not None

    @property
    def references(self) -> int:
        """What the sums are over: 1, or the number of central particles."""
        return 1 if self.at_walls else self.reactions.centers

    def through(self, rates: Array) -> Array:
        """A that flow to the first surface, from the reactions there (and at the other wall).

        About central particles the inner surface alone counts: colours far away take long to
        become steady, and those between the surfaces follow them.
        """
        return np.asarray(rates.mean(axis=1) if self.at_walls else rates[:, 0])


def reactions_of(run: RunDirectory) -> Reactions:
    """The reactions of a run.

    Raises:
        RunDirectoryError: when it has none.
    """
    reactions = run.manifest.system.reactions
    if reactions is None:
        raise RunDirectoryError(f"{run.path}: the scene {run.manifest.scene} has no reactions")
    return reactions


def colors_of(run: RunDirectory) -> Colors:
    """The colours after the equilibration.

    Raises:
        RunDirectoryError: when there are none, or fewer than `MIN_OUTPUTS` outputs of them.
    """
    reactions = reactions_of(run)
    kinds = range(1, len(reactions.probabilities) + 1)
    bins, table = run.bins("colors"), run.table("reactions")
    blocks = blocks_of(run, min(len(bins.steps), len(table.steps)))

    def by_bin(name: str) -> Array:
        columns = np.stack([bins[f"{name}_{k}"] for k in kinds], axis=-1)
        return np.array([columns[block].mean(axis=0) for block in blocks])

    def rates(name: str) -> Array:
        columns = np.array(
            [[table[f"{side}_{name}_{k}"] for k in kinds] for side in ("first", "second")]
        )
        return np.array([columns[:, :, block].mean(axis=2) for block in blocks]) / run.interval

    return Colors(
        reactions=reactions,
        positions=bins.positions,
        width=float(np.diff(bins.positions).mean()),
        number=np.array([bins["Ncount"][block].mean(axis=0) for block in blocks]),
        labels=by_bin("labels"),
        chances=by_bin("chances"),
        current=by_bin("chance_current"),
        label_rates=rates("labels"),
        chance_rates=rates("chances"),
    )


def blocks_of(run: RunDirectory, outputs: int) -> list[NDArray[np.intp]]:
    """The outputs after the equilibration, in at most `BLOCKS` blocks of equal length.

    Raises:
        RunDirectoryError: for fewer than `MIN_OUTPUTS` of them.
    """
    steps = run.clock.sample_steps * np.arange(1, outputs + 1)
    used = np.flatnonzero(run.sampled(steps))
    if len(used) < MIN_OUTPUTS:
        raise RunDirectoryError(
            f"{run.path}: {len(used)} outputs after the equilibration; at least {MIN_OUTPUTS} are "
            "needed"
        )
    count = min(BLOCKS, len(used))
    length = len(used) // count
    return list(used[len(used) - count * length :].reshape(count, length))


def block_mean(values: Array) -> Estimate:
    """Mean of a value of each block, with its error."""
    return estimate(lambda total, count: total / count, values, np.ones(len(values)))


def estimate(statistic: Callable[..., Array], *sums: Array) -> Estimate:
    """A number from blocks, with its jackknife error."""
    value, error = jackknife(statistic, *sums)
    return Estimate(float(value), float(error), freedom=len(sums[0]) - 1)

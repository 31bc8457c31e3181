"""What the outputs of a run hold, as arrays."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analysis.arrays import Array

Steps = NDArray[np.int64]


@dataclass(frozen=True)
class Table:
    """Averages over each sampling interval.

    Attributes:
        steps: last engine step of each interval, (K,).
        columns: by name, each (K,).
    """

    steps: Steps
    columns: Mapping[str, Array]

    def __getitem__(self, name: str) -> Array:
        """The column of that name, (K,).

        Raises:
            KeyError: naming those that there are.
        """
        return _column(self.columns, name)


@dataclass(frozen=True)
class Bins:
    """Averages by bins over each sampling interval.

    Attributes:
        steps: last engine step of each interval, (K,).
        positions: bin centres, (bins,).
        columns: by name, each (K, bins).
    """

    steps: Steps
    positions: Array
    columns: Mapping[str, Array]

    def __getitem__(self, name: str) -> Array:
        """The column of that name, (K, bins).

        Raises:
            KeyError: naming those that there are.
        """
        return _column(self.columns, name)


def _column(columns: Mapping[str, Array], name: str) -> Array:
    if name not in columns:
        raise KeyError(f"{name}: there is {', '.join(columns)}")
    return columns[name]


@dataclass(frozen=True)
class Profile:
    """The fluid by bins of y, averages over each sampling interval.

    Attributes:
        steps: last engine step of each interval, (K,).
        y: bin centres, (bins,) [a0].
        counts: particles in each bin, (K, bins).
        velocity_x: their mean velocity along x, (K, bins) [a0/t0].
    """

    steps: Steps
    y: Array
    counts: Array
    velocity_x: Array


@dataclass(frozen=True)
class Particles:
    """The particles at every sampled step, the first at step 0.

    Attributes:
        steps: engine steps, (T,).
        positions: unwrapped, from the lower corner of the box, (T, N, d) [a0].
        velocities: (T, N, d) [a0/t0].
        species: name of the species of each particle, (N,).
        spins: angular velocities, (T, N, 3) [1/t0]; None where the run did not keep them.
    """

    steps: Steps
    positions: Array
    velocities: Array
    species: NDArray[np.str_]
    spins: Array | None = None

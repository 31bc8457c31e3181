"""Files of averages as LAMMPS and fix mpc write them: a last row or interval cut short is left out.

Comment lines name the columns. A table has a row for each interval; averages by bins have a line of
step, number of bins and particles, then a row for each bin.
"""

import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Self

import numpy as np

from analysis.arrays import Array
from run_files.reading import read_text, refuse

HEAD = 3  # numbers before the bins of an interval


@dataclass(frozen=True)
class AveragesFile:
    """The numbers of such a file.

    Attributes:
        path: of the file.
        names: of its columns; none where no comment names them.
        numbers: all in a row, (n,).
    """

    path: Path
    names: Sequence[str]
    numbers: Array

    @classmethod
    def read(cls, path: Path, mark: str) -> Self:
        """Read the file; the comment line that holds `mark` names the columns.

        Raises:
            RunDirectoryError: when it is missing or holds what is no finite number.
        """
        text = read_text(path, largest=math.inf)
        lines = text[: text.rfind("\n") + 1].splitlines()
        comments = [line[1:] for line in lines if line.startswith("#")]
        names = next((line.split() for line in comments if mark in line), [])
        data = "\n".join(line for line in lines if not line.startswith("#"))
        with warnings.catch_warnings():
            warnings.simplefilter("error", DeprecationWarning)
            try:
                numbers = np.fromstring(data, sep=" ") if data else np.empty(0)
            except (ValueError, DeprecationWarning):  # which one depends on numpy's version
                refuse(path, "holds text among numbers")
        if not np.all(np.isfinite(numbers)):
            refuse(path, "holds numbers that are not finite")
        return cls(path, names, numbers)

    def table(self, wanted: Sequence[str]) -> Array:
        """The columns of those names, a row for each interval, (K, columns).

        Raises:
            RunDirectoryError: when a column or a complete interval is missing.
        """
        columns = self._columns(wanted)
        return self._rows(len(self.names))[:, columns]

    def bins(self, wanted: Sequence[str]) -> tuple[Array, Array]:
        """Step of each interval, (K,), and the columns of those names, (K, bins, columns).

        Raises:
            RunDirectoryError: when a column or a complete interval is missing, or the number of
                bins is none or not the same in all intervals.
        """
        columns = self._columns(wanted)
        if len(self.numbers) < HEAD:
            refuse(self.path, "no complete sampling interval yet")
        bins = self.numbers[1]
        if not (1 <= bins <= len(self.numbers) and bins == int(bins)):
            refuse(self.path, f"{bins:g} bins")
        rows = self._rows(HEAD + int(bins) * len(self.names))
        if np.any(rows[:, 1] != bins):
            refuse(self.path, "the number of bins is not constant")
        table = rows[:, HEAD:].reshape(len(rows), int(bins), len(self.names))
        return rows[:, 0], table[..., columns]

    def _columns(self, wanted: Sequence[str]) -> list[int]:
        for name in wanted:
            if name not in self.names:
                refuse(self.path, f"no column {name}")
        return [self.names.index(name) for name in wanted]

    def _rows(self, width: int) -> Array:
        count = len(self.numbers) // width
        if count == 0:
            refuse(self.path, "no complete sampling interval yet")
        return self.numbers[: count * width].reshape(count, width)

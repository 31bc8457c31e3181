"""A figure of a paper as something to compute: the runs it needs, and what is made of them."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from matplotlib.figure import Figure

from lammps_inputs import Scene
from narrows.reproduce.results import Result

Quality = Literal["quick", "full"]
Folders = Mapping[Scene, Path]
Column = Sequence[float | int | str | None]


@dataclass(frozen=True)
class Outcome:
    """What came of a figure.

    Attributes:
        picture: ours, with the paper's numbers on it.
        table: the data in it, columns of equal length by name.
        results: numbers beside the paper's.
    """

    picture: Figure
    table: Mapping[str, Column]
    results: Sequence[Result]


def _no_scenes(quality: Quality) -> Sequence[Scene]:
    return ()


@dataclass(frozen=True)
class PaperFigure:
    """One figure.

    Attributes:
        number: as in the paper, `4.6`.
        caption: what it shows.
        make: from the finished run directories of its scenes, or none, to the outcome.
        scenes: to run, seeds and all; figures that share a scene share its run.
    """

    number: str
    caption: str
    make: Callable[[Folders, Quality], Outcome]
    scenes: Callable[[Quality], Sequence[Scene]] = field(default=_no_scenes)


@dataclass(frozen=True)
class Paper:
    """A paper to reproduce: its name on the command line, its title, its figures in order."""

    name: str
    title: str
    figures: tuple[PaperFigure, ...]

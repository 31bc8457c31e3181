"""A figure of a paper as something to compute: the runs it needs, and what is made of them."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

from matplotlib.figure import Figure

from analysis import RunDirectory
from lammps_inputs import Scene
from narrows.papers.results import Result

Quality = Literal["quick", "full"]
Directories = Mapping[Scene, RunDirectory]
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


def _no_ladders(quality: Quality) -> Sequence[Sequence[Scene]]:
    return ()


@dataclass(frozen=True)
class PaperFigure:
    """One figure.

    Attributes:
        number: as in the paper, `4.6`.
        caption: what it shows.
        make: from the finished run directories, by scene, to the outcome.
        scenes: to run, seeds and all; figures that share a scene share its run.
        origin: what the numbers come from where no scene is run.
        partial: made of the runs that there are, when some have stopped; else left out then.
    """

    number: str
    caption: str
    make: Callable[[Directories, Quality], Outcome]
    scenes: Callable[[Quality], Sequence[Scene]] = field(default=_no_scenes)
    origin: str = "No run."
    partial: bool = False


@dataclass(frozen=True)
class Paper:
    """A paper to reproduce.

    Attributes:
        name: on the command line.
        title: of the page.
        figures: in order.
        engine: of its runs; None: of each the first that can run it.
        units: of its numbers.
        ladders: chains of scenes that have a field `start`; each but the first begins as the one
            before it ended.
    """

    name: str
    title: str
    figures: tuple[PaperFigure, ...]
    engine: str | None
    units: str
    ladders: Callable[[Quality], Sequence[Sequence[Scene]]] = field(default=_no_ladders)

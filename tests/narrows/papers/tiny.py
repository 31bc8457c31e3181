"""A paper of two small figures that share a run, to try the machinery; run as a program, too."""

import sys
from pathlib import Path

from analysis.estimate import Estimate
from lammps_inputs.engines import DEFAULT
from lammps_inputs.scenes.channel import Channel
from narrows.papers.drawing import one_panel
from narrows.papers.figure import Directories, Outcome, Paper, PaperFigure, Quality
from narrows.papers.results import PaperNumber, compared
from narrows.papers.session import Plan, carry_out


def scene(seed: int, duration: float = 3.0) -> Channel:
    return Channel.make(
        length=20, colloids=1, duration=duration, equilibration=0, sampling_interval=0.3, seed=seed
    )


def place(number: str, seeds: tuple[int, ...], duration: float) -> PaperFigure:
    """A figure of the last place of the colloid in runs of these seeds."""

    def make(directories: Directories, quality: Quality) -> Outcome:
        last = [
            float(directories[scene(seed, duration)].particles().positions[-1, 0, 0])
            for seed in seeds
        ]
        figure, axes = one_panel("seed", "place")
        axes.plot(seeds, last, "o")
        result = compared(number, "place <of> seed", Estimate(last[0], 10.0), PaperNumber(10.0))
        return Outcome(figure, {"seed": list(seeds), "place": last}, [result])

    return PaperFigure(
        number, "Where it is & was.", make, lambda quality: [scene(s, duration) for s in seeds]
    )


def paper(duration: float = 3.0) -> Paper:
    figures = (place("1", (1, 2), duration), place("2", (2, 3), duration))
    return Paper("tiny", "A <tiny> paper", figures, engine=DEFAULT, units="those of a <tiny> world")


if __name__ == "__main__":
    whole = paper(float(sys.argv[2]))
    carry_out(Plan(whole, whole.figures, "quick", Path(sys.argv[1])), jobs=2)

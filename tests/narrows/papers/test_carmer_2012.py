"""The paper on diffusivity by colours: its runs can be done, its numbers by hand, a small pass."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lammps_inputs.deck import check_engine
from lammps_inputs.scenes.pore import Pore
from narrows.papers import paper_named
from narrows.papers.carmer_2012 import pores
from narrows.papers.carmer_2012.profiles import Profile
from narrows.papers.figure import Quality
from narrows.papers.session import Plan, carry_out

QUALITIES: tuple[Quality, Quality] = ("quick", "full")


@pytest.mark.parametrize("quality", QUALITIES)
def test_every_run_can_be_done(quality: Quality, tmp_path: Path) -> None:
    paper = paper_named("carmer-2012")
    numbers = [figure.number for figure in paper.figures]
    assert numbers == ["1", "2", "3", "beyond-channel", "beyond-clay"]
    plan = Plan(paper, paper.figures, quality, tmp_path)
    for run in plan.runs:
        check_engine(run.scene, run.engine)
    # Figs. 1 and 2 share the run at packing 0.35
    assert sum(run.engine == "events" for run in plan.runs) == 10
    assert sum(run.scene.name == "claylike" for run in plan.runs) == 4


def test_a_mean_and_its_error_by_hand() -> None:
    place = np.array([-2.0, -1, 0, 1, 2])
    profile = Profile(place, np.array([9.0, 1, 2, 3, 9]), np.array([1, 0.1, 0.2, 0.1, 1]))
    one = profile.mean(0, 1, spacing=1.0)
    resistance = (1 + 1 / 2 + 1 / 3) / 3
    assert one.number == pytest.approx(1 / resistance)
    of_resistance = (0.1**2 + (0.2 / 4) ** 2 + (0.1 / 9) ** 2) ** 0.5 / 3
    assert one.standard_error == pytest.approx(of_resistance / resistance**2)
    shared = profile.mean(0, 1, spacing=2.0)
    assert shared.standard_error == pytest.approx(one.standard_error * 2**0.5)
    assert profile.mean(2, 2, spacing=1.0).number == 9


@pytest.mark.statistics
def test_the_figure_of_reaction_probabilities(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A small pore: the bias at p_r 1 is seen, the page is written."""

    def small(packing: float, quality: Quality) -> Pore:
        return Pore.make(
            particles=300,
            packing_fraction=packing,
            reaction_probabilities=pores.PROBABILITIES,
            sampling_interval=10.0,
            duration=800.0,
            equilibration=100.0,
        )

    monkeypatch.setattr(pores, "colored", small)
    paper = paper_named("carmer-2012")
    figure = replace(paper.figures[1], scenes=lambda quality: [small(pores.DENSE, quality)])
    done = carry_out(Plan(paper, [figure], "quick", tmp_path), jobs=1)
    assert done.left_out == []
    told = {result.quantity: result for result in done.results}
    assert told["D within 0.2 of contact, p_r 1 over 0.01, less 1"].agrees
    assert told["mean normal speed of what reacted over Maxwell's, less 1, p_r 1"].agrees
    assert (tmp_path / "figure-2.csv").is_file()
    assert (tmp_path / "index.html").is_file()

"""The figures of the thesis: all there, and each names runs that can be run."""

import math
from pathlib import Path

import numpy as np
import pytest

from analysis.estimate import Estimate
from lammps_inputs.deck import check_engine
from lammps_inputs.engines import DEFAULT
from lattice.shocks import end_rates, hopping_rates, random_walk_residuals
from narrows.papers.figure import Quality
from narrows.papers.session import Plan, run_of, select
from narrows.papers.tabatabaei_2009 import PAPER
from narrows.papers.tabatabaei_2009.few_colloids import crowds
from narrows.papers.tabatabaei_2009.lattice_shocks import SHOCKS, RunningShock
from narrows.papers.tabatabaei_2009.state_points import (
    Speed,
    channel_point,
    fit,
    scenes_of,
)
from narrows.papers.tabatabaei_2009.volume_fraction import mean_above_line

FIGURES = [
    *("2.1", "2.2", "3.6", "3.7", "4.3", "4.4", "4.5", "4.6", "4.7", "4.8", "4.9", "4.10"),
    *("4.12", "4.13", "4.14", "5.1", "beyond-flux", "beyond-front"),
]


def test_every_figure_of_the_thesis_is_there() -> None:
    assert [figure.number for figure in PAPER.figures] == FIGURES
    assert all(figure.caption for figure in PAPER.figures)


@pytest.mark.parametrize("quality", ["quick", "full"])
def test_runs_can_be_run_and_are_shared(quality: Quality, tmp_path: Path) -> None:
    plan = Plan(PAPER, PAPER.figures, quality, tmp_path)
    for run in plan.runs:
        check_engine(run.scene, run.engine)
        assert run.scene.duration > 0
    named = [scene for figure in PAPER.figures for scene in figure.scenes(quality)]
    assert len(plan.runs) < len(named)
    folders = {run.folder for run in plan.runs}
    assert len(folders) == len(plan.runs) == len(set(named))
    work = [run.scene.system.work for run in plan.runs]
    assert work == sorted(work, reverse=True)


@pytest.mark.parametrize("quality", ["quick", "full"])
def test_crowds_of_4_8_cost_nothing_beside_5_1(quality: Quality) -> None:
    (figure,) = select(PAPER, ["5.1"])
    assert set(scenes_of(crowds(quality))) <= set(figure.scenes(quality))


def test_distance_from_the_line_of_4_6_where_it_was_fitted() -> None:
    def found(colloids: int, above: float, error: float) -> Speed:
        where = channel_point(100, colloids, seeds=1)
        line = Estimate(0.15 * where.fraction + 0.019 + above, error)
        return Speed(where, line, line, 0.0)

    dilute = found(1, 1.0, 1e-9)  # phi = 0.0126, below the fit
    distance = mean_above_line([dilute, found(5, 0.003, 0.001), found(10, 0.006, 0.002)])
    assert distance.value == pytest.approx((4 * 0.003 + 0.006) / 5)
    assert distance.error == pytest.approx(0.002 / math.sqrt(5))


def test_qualities_do_not_share_folders(tmp_path: Path) -> None:
    quick, full = (
        {run.folder for run in Plan(PAPER, PAPER.figures, quality, tmp_path).runs}
        for quality in ("quick", "full")
    )
    scenes = [scene for figure in PAPER.figures for scene in figure.scenes("quick")]
    same = {run_of(s, DEFAULT, tmp_path).folder for s in scenes} & full
    assert quick & full == same  # only runs that are the same to the last field


def test_select() -> None:
    assert [figure.number for figure in select(PAPER, ["5.1", "3.6"])] == ["3.6", "5.1"]
    with pytest.raises(ValueError, match=r"figure '4\.11': tabatabaei-2009 has 2\.1, 2\.2"):
        select(PAPER, ["4.11"])


def test_volume_fraction_of_the_thesis() -> None:
    # phi below 0.015 is a length above 84 for one colloid (the thesis says 100)
    where = channel_point(100, 1, seeds=2)
    assert where.fraction == pytest.approx(math.pi * 4 / 1000)
    assert where.density == pytest.approx(1e-3)
    assert [scene.seed for scene in where.scenes] == [1, 2]


def test_difference_and_fit_carry_errors() -> None:
    gap = Estimate(5.0, 0.3) - Estimate(2.0, 0.4)
    assert (gap.value, gap.error) == pytest.approx((3.0, 0.5))
    assert (Estimate(5.0, None, "why") - Estimate(2.0, 0.4)).error is None
    intercept, slope = fit([0.0, 2.0], [Estimate(3.0, 0.3), Estimate(5.0, 0.4)])
    assert (intercept.value, slope.value, slope.error) == pytest.approx((3.0, 1.0, 0.25))


@pytest.mark.parametrize("shock", SHOCKS, ids=lambda shock: shock.number)
def test_shocks_random_walk_at_the_rates_of_the_thesis(shock: RunningShock) -> None:
    model = shock.model()
    gas = model.gas()
    assert np.max(random_walk_residuals(gas, 4, model.z1, model.z2)) < 1e-10
    left, right = hopping_rates(gas, model.z1, model.z2)
    assert min(end_rates(gas, model.z1, model.z2)) >= 0
    velocity, diffusion = shock.walk(model)
    assert (velocity, diffusion) == pytest.approx((right - left, (right + left) / 2))

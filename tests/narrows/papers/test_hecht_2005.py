"""The figures of hecht-2005: runs can be run; the tables are the paper's but for one number."""

from pathlib import Path

import pytest

from lammps_inputs.deck import check_engine
from narrows.papers.figure import Quality
from narrows.papers.hecht_2005 import PAPER
from narrows.papers.session import Plan

BY_NUMBER = {figure.number: figure for figure in PAPER.figures}


@pytest.mark.parametrize(("quality", "runs"), [("quick", 61), ("full", 65)])
def test_runs_can_be_run(quality: Quality, runs: int, tmp_path: Path) -> None:
    plan = Plan(PAPER, PAPER.figures, quality, tmp_path)
    for run in plan.runs:
        check_engine(run.scene, run.engine)
    assert len(plan.runs) == runs


def test_every_printed_time_but_the_misprint_agrees() -> None:
    outcome = BY_NUMBER["tables"].make({}, "quick")
    disagree = [result for result in outcome.results if result.agrees is False]
    assert [(result.figure, result.quantity) for result in disagree] == [("Table III", "tau_F [s]")]
    assert disagree[0].measured.value == pytest.approx(23.9e-3, abs=1e-4)


def test_potentials_have_secondary_minima() -> None:
    """Deep at 50 mV and 3e8 / m, a fraction of kBT at 7.3e7 / m, as X A has it."""
    outcome = BY_NUMBER["1"].make({}, "quick")
    depths = {result.quantity: result.measured.number for result in outcome.results}
    assert depths["its depth at 50 mV, 3e+08 / m [kBT]"] > 5
    assert 0 < depths["its depth at 50 mV, 7.3e+07 / m [kBT]"] < 1

"""The figures of lane formation: all there, each from runs that can be run."""

from pathlib import Path

import numpy as np
import pytest

import lammps_plugin
from analysis import RunDirectory
from analysis.estimate import Estimate
from lammps_inputs import Scene, make_scene
from lammps_inputs.deck import check_engine
from narrows.papers.delhommelle_2005 import PAPER
from narrows.papers.delhommelle_2005.state_points import UP, largest
from narrows.papers.delhommelle_2005.three_dimensions import string_order
from narrows.papers.figure import Quality
from narrows.papers.session import Plan
from srd_driver import Simulation
from srd_driver.sweep import Run

HOURS = {"quick": 10 / 60, "full": 4.0}  # promised, on two cores
STEP = 55e-9  # seconds of a kinetic step, a particle; measured by benchmarks/lanes.py
DEARER = {"configurational": 2.3}


def test_every_figure_is_there() -> None:
    beyond = ["beyond-noise", "beyond-size", "beyond-hysteresis"]
    numbers = [*(str(n) for n in range(1, 12)), *beyond]
    assert [figure.number for figure in PAPER.figures] == numbers
    assert all(figure.caption for figure in PAPER.figures)


@pytest.mark.parametrize("quality", ["quick", "full"])
def test_runs_can_be_run_in_the_time_that_is_promised(quality: Quality, tmp_path: Path) -> None:
    plan = Plan(PAPER, PAPER.figures, quality, tmp_path)
    seconds = 0.0
    for run in plan.runs:
        check_engine(run.scene, run.engine)
        thermostat = run.scene.model_dump()["thermostat"]
        spheres = 1.5 if run.scene.system.box.dimensions == 3 else 1.0
        seconds += run.scene.system.work * STEP * DEARER.get(thermostat, 1.0) * spheres
    print(f"{quality}: {len(plan.runs)} runs, {seconds / 3600:.2f} hours of one core")
    assert seconds / 2 < HOURS[quality] * 3600
    named = [scene for figure in PAPER.figures for scene in figure.scenes(quality)]
    assert len(plan.runs) < len(named)  # figures share runs


@pytest.mark.parametrize("quality", ["quick", "full"])
def test_a_stopped_run_decides_nothing(quality: Quality) -> None:
    """A partial figure is drawn, and has no verdict, where runs are missing: here all of them."""
    for figure in PAPER.figures:
        if figure.partial:
            outcome = figure.make({}, quality)
            assert len({len(column) for column in outcome.table.values()}) == 1
            assert [result.agrees for result in outcome.results if result.agrees is not None] == []


def test_the_largest_of_some_is_a_lower_bound() -> None:
    low, high, stopped = Estimate(1.0, 0.1), Estimate(2.0, 0.2), Estimate(None, None, "stopped")
    assert largest([low, high]) == high
    assert largest([stopped, low, high]) == Estimate(
        2.0, None, "a lower bound: 1 of 3 runs stopped"
    )
    assert largest([stopped]) == stopped


def test_full_quality_goes_up_and_down_ladders(tmp_path: Path) -> None:
    plan = Plan(PAPER, PAPER.figures, "full", tmp_path)
    for scene, run in plan.run_by_scene.items():
        if run.after and "field" in scene.model_dump():
            higher = scene.model_dump()["field"] > run.after.scene.model_dump()["field"]
            assert higher == (scene.seed == UP)
    chains = [len(_chain(run)) for run in plan.runs]
    assert max(chains) > 20  # fields up, and down again
    quick = Plan(PAPER, PAPER.figures, "quick", tmp_path)
    assert max(len(_chain(run)) for run in quick.runs) > 4  # rates


def _chain(run: Run) -> list[Run]:
    return [run, *(_chain(run.after) if run.after else [])]


@pytest.mark.skipif(not lammps_plugin.folder(), reason="the plugin is not built")
def test_string_order_of_a_crystal_and_a_fluid(tmp_path: Path) -> None:
    """All 216 of a cubic lattice in one wave; a fluid has S(k) of a few."""

    def order(name: str, **fields: float) -> float:
        scene: Scene = make_scene(
            "shear",
            particles=216,
            rate=1e-3,
            time_step=1e-3,
            sampling_interval=0.01,
            **({"duration": 0.02, "equilibration": 0.0} | fields),
        )
        with Simulation(scene, "md", tmp_path / name) as simulation:
            simulation.finish()
        return string_order(RunDirectory(tmp_path / name)).number

    assert order("crystal", rest=0.0, temperature=1e-6) == pytest.approx(216, rel=0.01)
    assert 1 < order("fluid", rest=5.0) < 60
    assert np.isfinite(order("fluid_too", rest=5.0, seed=2))

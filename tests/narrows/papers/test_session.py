"""The machinery, on a paper of two small figures."""

import csv
import json
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Never

import numpy as np
import pytest

import lammps_plugin
from analysis import RunDirectory
from narrows.papers import session
from narrows.papers.drawing import one_panel
from narrows.papers.figure import Directories, Outcome, Paper, PaperFigure, Quality
from narrows.papers.session import Plan, carry_out
from srd_driver.sweep import Advance, Failure, Run, run_all
from tests.conftest import ROOT
from tests.narrows.papers.tiny import paper
from tests.soft_scenes import lanes


def plan_of(out: Path, duration: float = 3.0) -> Plan:
    whole = paper(duration)
    return Plan(whole, whole.figures, "quick", out)


def test_figures_data_results_and_page(tmp_path: Path) -> None:
    plan = plan_of(tmp_path / "out")
    assert [len(figure.scenes("quick")) for figure in plan.figures] == [2, 2]
    assert len(plan.runs) == 3  # one is shared
    done = carry_out(plan, jobs=2)
    assert done.left_out == []
    assert plan.finished() == 3
    entries = json.loads((plan.out / "results.json").read_text())
    assert [(entry["figure"], entry["paper"], entry["agrees"]) for entry in entries] == [
        ("1", 10.0, True),
        ("2", 10.0, True),
    ]
    rows = list(csv.reader((plan.out / "figure-1.csv").open()))
    assert [row[0] for row in rows] == ["seed", "1", "2"]
    assert float(rows[1][1]) == entries[0]["value"]
    assert (plan.out / "figure-2.png").read_bytes().startswith(b"\x89PNG")
    assert (plan.out / "figure-2.pdf").read_bytes().startswith(b"%PDF")
    page = (plan.out / "index.html").read_text()
    sources = re.findall(r'(?:src|href)="([^"]*)"', page)
    assert len([s for s in sources if s.startswith("data:image/png;base64,")]) == 3
    assert "scene channel, particles: 1, box 20 x 10; at the end of a run" in page
    assert page.index('id="system"') < page.index('id="figure-1"')
    beside = {source for source in sources if not source.startswith(("data:", "#"))}
    assert beside == {f"figure-{n}.{kind}" for n in (1, 2) for kind in ("csv", "pdf")}
    assert all((plan.out / name).is_file() for name in beside)
    assert page.index('id="verdicts"') < page.index('id="figure-1"')
    assert '<b>2 numbers</b></td><td class="verdict agrees">2</td>' in page
    assert 'alt="Fig. 1: Where it is &amp; was. place &lt;of&gt; seed 1' in page
    assert "prefers-color-scheme: dark" in page
    assert not re.search(r"https?://|@import|url\(|<script", page)
    assert "A &lt;tiny&gt; paper" in page
    assert "3 by the engine mpc" in page
    assert "those of a &lt;tiny&gt; world" in page


def test_finished_runs_are_skipped(tmp_path: Path) -> None:
    plan = plan_of(tmp_path)
    carry_out(plan, jobs=2)
    before = {run.folder: (run.folder / "progress.json").stat().st_mtime_ns for run in plan.runs}
    carry_out(plan_of(tmp_path), jobs=2)
    after = {run.folder: (run.folder / "progress.json").stat().st_mtime_ns for run in plan.runs}
    assert before == after


def test_a_failed_run_costs_its_own_figures_only(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plan = plan_of(tmp_path)
    lost = next(run for run in plan.runs if run.scene.seed == 3)  # of the second figure

    def one_fails(
        runs: Sequence[Run], jobs: int, report: Callable[[Advance], None] | None = None
    ) -> list[Failure]:
        others = [run for run in runs if run is not lost]
        return [*run_all(others, jobs, report), Failure(lost, "stopped")]

    monkeypatch.setattr(session, "run_all", one_fails)
    done = carry_out(plan, jobs=2)
    assert [result.figure for result in done.results] == ["1"]
    assert done.left_out == [f"figure 2 left out: {lost.folder}: stopped"]
    assert "figure 2 left out" in (tmp_path / "index.html").read_text()
    assert not (tmp_path / "figure-2.png").exists()


def test_a_partial_figure_is_made_without_the_run_that_failed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plan = plan_of(tmp_path)
    first, second = plan.figures[1].scenes("quick")
    failed = {plan.run_by_scene[first]}

    def some_fail(
        runs: Sequence[Run], jobs: int, report: Callable[[Advance], None] | None = None
    ) -> list[Failure]:
        others = [run for run in runs if run not in failed]
        return [*run_all(others, jobs, report), *(Failure(run, "stopped") for run in failed)]

    def make(directories: Directories, quality: Quality) -> Outcome:
        assert (first in directories, second in directories) == (False, True)
        return Outcome(one_panel("x", "y")[0], {"seed": [second.seed]}, [])

    monkeypatch.setattr(session, "run_all", some_fail)
    scenes = plan.figures[1].scenes
    plan.figures = [PaperFigure("2", "Some of it.", make, scenes, partial=True)]
    line = f"{plan.run_by_scene[first].folder}: stopped"
    assert carry_out(plan, jobs=2).left_out == [f"figure 2 is without {line}"]
    assert (tmp_path / "figure-2.png").exists()
    assert "figure 2 is without" in (tmp_path / "index.html").read_text()
    failed.add(plan.run_by_scene[second])
    assert carry_out(plan, jobs=2).left_out == [f"figure 2 left out: {line}"]


def test_a_figure_that_cannot_be_made_costs_itself_only(tmp_path: Path) -> None:
    def make(directories: Directories, quality: Quality) -> Never:
        raise ValueError("every point needs a positive error")

    plan = plan_of(tmp_path)
    plan.figures = [PaperFigure("0", "Broken.", make), *plan.figures]
    done = carry_out(plan, jobs=2)
    assert [result.figure for result in done.results] == ["1", "2"]
    assert done.left_out == ["figure 0 left out: every point needs a positive error"]


def test_a_damaged_trajectory_costs_no_page(tmp_path: Path) -> None:
    """Its figures are left out, each with the reason, and no system is drawn."""
    plan = plan_of(tmp_path)
    carry_out(plan, jobs=2)
    for run in plan.runs:
        path = run.folder / "trajectory.lammpsdump"
        path.write_bytes(b"x" + path.read_bytes()[1:])
    done = carry_out(plan, jobs=2)
    page = (tmp_path / "index.html").read_text()
    assert 'id="system"' not in page
    assert done.results == []
    assert len(done.left_out) == 2
    assert all("trajectory.lammpsdump: damaged" in line for line in done.left_out)
    assert "figure 2 left out" in page


def test_goes_on_after_kill_9(tmp_path: Path) -> None:
    words = [sys.executable, "-m", "tests.narrows.papers.tiny", str(tmp_path), "60"]
    process = subprocess.Popen(words, cwd=ROOT, env=os.environ | {"PYTHONPATH": str(ROOT)})
    plan = plan_of(tmp_path, duration=60.0)
    begun = [run.folder / "observables.dat" for run in plan.runs]
    for _ in range(600):
        if any(path.exists() for path in begun):
            break
        time.sleep(0.05)
    process.send_signal(signal.SIGKILL)
    process.wait()
    assert not (tmp_path / "results.json").exists()
    done = carry_out(plan, jobs=2)
    assert done.left_out == []
    undisturbed = plan_of(tmp_path / "again", duration=60.0)
    carry_out(undisturbed, jobs=2)
    killed, whole = (
        (p.out / "figure-1.csv").read_text().splitlines()[1:] for p in (plan, undisturbed)
    )
    np.testing.assert_array_equal(
        [float(line.split(",")[1]) for line in killed],
        [float(line.split(",")[1]) for line in whole],
    )


def a_ladder(out: Path, first: float = 0.5) -> Plan:
    """Three fields, the last of which is shown; a run does not outlive a first one of 50."""
    common = {"duration": 0.5, "equilibration": 0.0, "thermostat": "configurational"}
    fatal = {"time_step": 0.004, "duration": 50.0} if first == 50 else {}
    scenes = [lanes(**(common | {"field": first} | fatal))]
    scenes += [lanes(field=field, **common) for field in (1.0, 1.5)]

    def make(directories: Directories, quality: Quality) -> Outcome:
        assert directories[scenes[2]].path == out / "runs" / directories[scenes[2]].path.name
        return Outcome(one_panel("x", "y")[0], {"field": [1.5]}, [])

    figure = PaperFigure("1", "The last.", make, lambda quality: scenes[2:])
    whole = Paper("ladder", "A ladder", (figure,), None, "none", lambda quality: [scenes])
    return Plan(whole, whole.figures, "quick", out)


@pytest.mark.skipif(not lammps_plugin.folder(), reason="the plugin is not built")
def test_each_run_of_a_ladder_begins_as_the_one_before_ended(tmp_path: Path) -> None:
    plan = a_ladder(tmp_path)
    first, second, third = plan.run_by_scene.values()
    assert (second.after, third.after, first.after) == (first, second, None)
    assert carry_out(plan, jobs=2).left_out == []
    for before, run in ((first, second), (second, third)):
        told = RunDirectory(run.folder)
        assert told.manifest.fields["start"] == str(before.folder.resolve())
        ended = RunDirectory(before.folder).particles().velocities[-1]
        np.testing.assert_allclose(told.particles().velocities[0], ended, atol=1e-6)
    assert a_ladder(tmp_path).finished() == 3
    assert a_ladder(tmp_path, first=0.6).finished() == 0  # all begin otherwise


@pytest.mark.skipif(not lammps_plugin.folder(), reason="the plugin is not built")
def test_a_ladder_ends_with_a_run_that_fails(tmp_path: Path) -> None:
    plan = a_ladder(tmp_path, first=50.0)
    done = carry_out(plan, jobs=2)
    last = plan.run_by_scene[plan.figures[0].scenes("quick")[0]]
    reason = "the run that it begins from has failed"
    assert done.left_out == [f"figure 1 left out: {last.folder}: {reason}"]
    assert not last.folder.exists()

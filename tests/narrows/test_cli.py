"""What the command line says of itself: version, scenes, completion, progress of many runs."""

import re

import pytest
import typer
from typer.testing import CliRunner, Result

from lammps_inputs import all_scenes
from lammps_inputs.field_table import field_rows
from narrows.cli import app
from narrows.progress import Lines
from srd_driver.progress_bar import LINE_SECONDS
from srd_driver.sweep import Advance
from tests.conftest import ROOT

WIDE = {"COLUMNS": "300", "TERM": "dumb"}


def told(*words: str, environment: dict[str, str] | None = None) -> Result:
    return CliRunner().invoke(app, words, env=WIDE | (environment or {}), prog_name="narrows")


def test_version_names_ours_and_that_of_lammps() -> None:
    assert re.fullmatch(
        r"narrows \d+\.\d+\.\d+, LAMMPS 2025\.\S+, compiled styles (not )?built\n",
        told("--version").stdout,
    )


def test_scenes_lists_every_scene_with_the_engines_that_do_it() -> None:
    lines = told("scenes").stdout.splitlines()
    for name, scene in all_scenes().items():
        (line,) = (line for line in lines if line.startswith(f"│ {name} "))
        cells = [cell.strip() for cell in line.strip("│").split("│")]
        assert (scene.__doc__ or "").startswith(cells[1][:40])
        assert cells[2]
    (pore,) = (line for line in lines if line.startswith("│ pore "))
    assert pore.split("│")[3].strip() == "events"


@pytest.mark.parametrize("name", all_scenes())
def test_scenes_of_one_lists_its_fields_as_the_page_does(name: str) -> None:
    page = (ROOT / "docs" / "scenes.md").read_text(encoding="utf-8")
    lines = told("scenes", name).stdout.splitlines()
    rows = field_rows(all_scenes()[name])
    assert [row.name for row in rows] == list(all_scenes()[name].model_fields)
    for row in rows:
        (line,) = (line for line in lines if line.startswith(f"│ {row.name} "))
        cells = [cell.strip() for cell in line.removeprefix("│").split("│", 3)[:3]]
        assert cells == [row.name, row.unit, row.default]
        assert row.allowed in line
        assert row.meaning in line
        assert f"| `{row.name}` | {row.default} | " in page


def test_no_unit_is_taken_for_markup() -> None:
    """Square brackets in a help are markup, of which nothing is shown."""
    helped = [typer.main.get_command(app)]
    for group in helped:
        for command in getattr(group, "commands", {}).values():
            helped.append(command)
            helps = [getattr(option, "help", None) or "" for option in command.params]
            assert not [words for words in helps if "[" in words], command.name
    assert len(helped) > 17
    assert "two checkpoints, in t0" in told("run", "--help").stdout


def test_a_narrow_terminal_cuts_no_word_off() -> None:
    text = told("scenes", "channel", environment={"COLUMNS": "70"}).stdout
    assert "…" not in text
    assert "maxwell" in text


@pytest.mark.parametrize(
    ("scene", "field", "allowed"),
    [
        ("channel", "angle", "above 0, at most 180"),
        ("channel", "hydrodynamics", "on | shuffle | bath"),
        ("channel", "spacing", "above 0; or none"),
        ("channel", "gravity", "number"),
        ("channel", "colloids", "whole number, at least 1"),
        ("claylike", "radius", "at least 1e-10, at most 1"),
        ("claylike", "cell_edge", "at least 1e-10, at most 1; or none"),
        ("lanes", "dimension", "2 | 3"),
        ("pore", "reaction_probabilities", "list, each above 0, at most 1"),
        ("pore", "trajectory", "0 | 1"),
    ],
)
def test_bounds_are_those_of_the_models(scene: str, field: str, allowed: str) -> None:
    (row,) = (row for row in field_rows(all_scenes()[scene]) if row.name == field)
    assert row.allowed == allowed


def test_help_of_a_scene_lists_its_fields() -> None:
    text = all_scenes()["channel"].__doc__ or ""
    assert text.startswith("A 2D slit, periodic along x")
    assert "\n    gravity = 0.1 [a0/t0^2]: acceleration of the colloids along x" in text


def test_an_unknown_scene_is_one_line() -> None:
    done = told("scenes", "chanel")
    assert done.exit_code == 2
    assert done.stderr.startswith("narrows: scene = 'chanel': must be one of bulk, ")


@pytest.mark.parametrize(
    ("line", "choices"),
    [
        ("narrows run ch", ["channel"]),
        ("narrows scenes po", ["poiseuille", "pore"]),
        ("narrows run channel --set coll", ["collision_time=", "colloids=", "colloid_radius="]),
        ("narrows deck channel --set colloids=3 --set gr", ["gravity="]),
        ("narrows reproduce ta", ["tabatabaei-2009"]),
    ],
)
def test_the_shell_completes(line: str, choices: list[str]) -> None:
    asked = {
        "_NARROWS_COMPLETE": "complete_bash",
        "COMP_WORDS": line,
        "COMP_CWORD": str(len(line.split()) - 1),
    }
    assert told(environment=asked).stdout.split() == choices


def test_progress_of_runs_without_a_terminal_is_a_line_now_and_then() -> None:
    said: list[str] = []
    time = [0.0]
    lines = Lines(said.append, lambda: time[0])

    def pass_time(seconds: float, work: float, finished: int, failed: int = 0) -> None:
        time[0] += seconds
        lines.report_runs(Advance(work, finished, failed, running=2, runs=8))

    pass_time(0, 0.20, 1)
    pass_time(LINE_SECONDS / 2, 0.25, 2)
    assert said == []
    pass_time(LINE_SECONDS / 2, 0.30, 2)
    pass_time(1, 0.31, 3)
    # a tenth of the work in half a minute: seven more half minutes
    assert said == ["30.0 %: 2 of 8 runs finished, 2 running, about 4 min left"]
    pass_time(LINE_SECONDS, 0.99, 7, failed=1)
    assert said[1:] == ["99.0 %: 7 of 8 runs finished, 2 running, 1 failed, less than 1 min left"]
    time[0] += LINE_SECONDS
    lines.report_analysis(3, 7)
    assert said[2:] == ["3 of 7 runs analysed"]

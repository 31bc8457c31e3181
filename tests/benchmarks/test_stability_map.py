"""How the stability map judges, and that nothing that breaks may go without a word."""

from argparse import Namespace
from pathlib import Path
from typing import Any

import pytest

from analysis import Estimate
from stability_map import (
    COLLOID_TEMPERATURE,
    FLUID_TEMPERATURE,
    Axis,
    Criterion,
    Point,
    draw_map,
    map_table,
    over,
    points,
    state_of,
)

SHORT = {"length": 8, "width": 8, "density": 5, "duration": 4, "equilibration": 0}


def fluid(name: str, values: tuple[Any, ...], criterion: Criterion = FLUID_TEMPERATURE) -> Axis:
    return Axis(name, "bulk", values, lambda value: SHORT | {name: value}, (criterion,))


@pytest.mark.parametrize(
    ("value", "error", "state"),
    [
        (1.02, 0.01, "stable"),
        (1.02, 0.3, "open"),
        (1.2, 0.01, "inaccurate"),
        (1.2, 0.09, "stable"),
        (0.4, 0.01, "broken"),
        (0.4, 0.09, "inaccurate"),
        (float("inf"), 0.01, "broken"),
    ],
)
def test_states_are_told_by_the_whole_interval(value: float, error: float, state: str) -> None:
    assert state_of(COLLOID_TEMPERATURE, Estimate(value, error)) == state


def test_a_point_has_the_worst_of_its_states() -> None:
    point = Point(fluid("density", (5,)), 5)
    for state in ("open", "inaccurate", "stable"):
        point.worsen(state)
    assert point.state == "inaccurate"


def test_what_is_refused_has_no_run_and_is_told(tmp_path: Path) -> None:
    good, refused = points(tmp_path, (fluid("density", (5, -1)),))
    assert (good.state, good.told) == ("stable", [])
    assert good.run is not None
    assert (refused.state, refused.run) == ("refused", None)
    assert "density = -1" in refused.told[0]
    assert map_table([good, refused]).endswith("| density | temperature | 5 |  |  |  | -1 |")


def test_the_exit_code_tells_of_what_breaks_without_a_word(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The same run is right by its temperature, and broken, silently, by another criterion."""
    page = tmp_path / "page.md"
    page.write_text("<!-- map -->\n<!-- end of map -->\n")
    options = Namespace(out=tmp_path, axis=None, jobs=1, page=page)
    axis = fluid("thermostat", ("rescale",))
    assert draw_map((axis,), options, "map") == 0
    assert "| thermostat | temperature | rescale |" in page.read_text()
    double = Criterion("temperature", 0.1, 0.2, over("temperature", 2.0))
    assert draw_map((fluid("thermostat", ("rescale",), double),), options, "map") == 1
    assert "broken without a word: thermostat = rescale" in capsys.readouterr().err

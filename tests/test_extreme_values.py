"""Whatever is given for a field ends in a scene or in a message, at once."""

import json
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from lammps_inputs import SceneError, all_engines, all_scenes, make_scene, parse_assignment
from lammps_inputs.deck import check_engine, warnings
from lammps_inputs.manifest import manifest
from narrows.cli import app
from srd_driver import Simulation

DEEP: list[Any] = []
for _ in range(5000):
    DEEP = [DEEP]
VALUES = {
    "1e308": 1e308,
    "-1e308": -1e308,
    "1e-308": 1e-308,
    "5e-324": 5e-324,
    "1e20": 1e20,
    "1e9": 1e9,
    "1e-9": 1e-9,
    "0": 0,
    "-0.0": -0.0,
    "5000 digits": 10**5000,
    "5000 digits of text": "1" * 5000,
    "2^63": 2**63,
    "nan": float("nan"),
    "inf": float("inf"),
    "none": None,
    "true": True,
    "list": [],
    "table": {},
    "5000 deep": DEEP,
    "terminal": "\x1b[2J",
    "two lines": "1\n2",
}
LATTICE = str(
    Path(__file__).parent.parent / "docs" / "examples" / "lattice" / "internal_state.toml"
)


@pytest.mark.parametrize("value", VALUES.values(), ids=VALUES)
@pytest.mark.parametrize("name", all_scenes())
def test_a_scene_is_made_or_refused(name: str, value: Any) -> None:
    for field in [*all_scenes()[name].model_fields, "nonesuch", "name", "cls", "self", "\x1b\n"]:
        try:
            scene = make_scene(name, **{field: value})
            for engine in all_engines():
                try:
                    check_engine(scene, engine)
                except SceneError as error:
                    assert_plain(error)
                    continue
                json.dumps(manifest(scene, engine))
                list(warnings(scene, engine))
        except SceneError as error:
            assert_plain(error)


def assert_plain(error: SceneError) -> None:
    for problem in error.problems:
        assert problem.isprintable()
        assert len(problem) < 2000


@pytest.mark.parametrize("text", ["a=" + "1" * 5000, "a=" + "[" * 5000, "a=1e99999", "a=\x1b"])
def test_an_assignment_is_read_whatever_it_holds(text: str) -> None:
    assert parse_assignment(text)[0] == "a"


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (["deck", "channel", "--set", "length=1e7"], "needs 1.76e+11 bytes of memory"),
        (
            ["run", "channel", "--set", "duration=1e9", "--set", "length=1e4"],
            "would take 2.11 years on 1 process",
        ),
        (["sweep", "channel", "--repeats", "1000000000000"], "1e+12 runs: a sweep has at most"),
        (
            [
                "sweep",
                "channel",
                *(w for f in "ab" for w in ("--over", f + "=" + "1," * 999 + "1")),
            ],
            "1e+06 runs: a sweep has at most 100000",
        ),
    ],
)
def test_what_takes_too_much_is_refused_with_how_much(
    words: list[str], complaint: str, tmp_path: Path
) -> None:
    done = CliRunner().invoke(app, [*words, "--out", str(tmp_path / "run")])
    assert done.exit_code == 2
    assert complaint in done.stderr
    assert done.stderr.count("\n") == 1
    assert not (tmp_path / "run").exists()


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (["check", LATTICE, "--sites", "1000"], "need 1e479 bytes of memory"),
        (["check", LATTICE, "--sites", "40"], "bytes of memory"),
        (["simulate", LATTICE, "--replicas", "1000000"], "bytes of memory"),
        (["hydro", LATTICE, "--times", "1e9", "--cells", "10000"], "years"),
        (["hydro", LATTICE, "--times", "1e300"], "must be between 0 and 1e+09"),
    ],
)
def test_a_lattice_that_takes_too_much_is_refused(words: list[str], complaint: str) -> None:
    done = CliRunner().invoke(app, ["lattice", *words])
    assert done.exit_code == 2
    assert complaint in done.stderr
    assert done.stderr.count("\n") == 1


@pytest.mark.parametrize("interval", [float("inf"), 1e308, 5e-324, 0.0])
def test_any_checkpoint_interval_is_a_whole_number_of_outputs(
    interval: float, tmp_path: Path
) -> None:
    scene = make_scene("bulk", length=4, width=4, duration=2.0)
    with Simulation(scene, "reference", tmp_path, False, interval) as run:
        run.finish()
    with pytest.raises(SceneError, match="checkpoint_interval = nan"):
        Simulation(scene, "reference", tmp_path / "other", False, float("nan"))

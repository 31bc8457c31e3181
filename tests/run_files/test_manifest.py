"""`manifest.json`: the present one, that of narrows 0.1, and damaged ones."""

import json
from pathlib import Path
from typing import Any

import pytest

from lammps_inputs import make_scene
from lammps_inputs.manifest import manifest
from run_files import RunDirectoryError
from run_files.manifest import FORMAT, read_manifest
from tests.analysis.run_writer import Json, channel

# written by narrows 0.1 (commit db42856): its three scenes, its three engines, 2D and 3D
OF_0_1: list[Json] = json.loads(Path(__file__).with_name("manifests_of_0_1.json").read_text())
NEVER_TOLD = {"interactions": [], "motion": {"class": "VelocityVerlet"}}


def written(path: Path, content: Any) -> Path:
    (path / "manifest.json").write_text(json.dumps(content))
    return path


def hand_made() -> Json:
    return {
        "format": FORMAT,
        "engine": "mpc",
        "scene": "mine",
        "fields": {},
        "units": {},
        "system": channel(3),
        "seeds": {},
    }


@pytest.mark.parametrize("old", OF_0_1, ids=lambda old: f"{old['scene']} {old['engine']}")
def test_a_manifest_of_0_1_is_read_as_the_present_one(old: Json, tmp_path: Path) -> None:
    """All but the potentials, of which 0.1 told nothing, and fields that it did not have."""
    scene = make_scene(old["scene"], **old["fields"])
    present = json.loads(json.dumps(manifest(scene, old["engine"])))
    present["fields"] = {name: present["fields"][name] for name in old["fields"]}
    present["system"] |= NEVER_TOLD
    for wall in present["system"]["walls"]:
        wall["potentials"] = []
    read = read_manifest(written(tmp_path, old)).model_dump(mode="json")
    assert read["versions"]["narrows"] == "0.1.0"
    assert read["command"] == f"narrows run {old['scene']}"
    del read["versions"], read["command"], read["ranks"]
    assert sorted(map(str, read["system"].pop("measures"))) == sorted(
        present["system"].pop("measures")
    )
    assert read == present


@pytest.mark.parametrize("missing", ["box", "fields", "colloids", "seeds", "sample_steps"])
def test_a_damaged_manifest_of_0_1_is_refused(missing: str, tmp_path: Path) -> None:
    damaged = {name: value for name, value in OF_0_1[0].items() if name != missing}
    assert refused(written(tmp_path, damaged)).startswith(
        f"manifest.json: neither of this narrows nor of 0.1: KeyError('{missing}')"
    )


def refused(directory: Path) -> str:
    """The message without the directory, one line."""
    with pytest.raises(RunDirectoryError) as error:
        read_manifest(directory)
    message = str(error.value)
    assert "\n" not in message
    return message.removeprefix(str(directory)).lstrip("/:").lstrip()


def test_what_holds_no_run(tmp_path: Path) -> None:
    assert refused(tmp_path / "nowhere") == "no such directory"
    assert refused(tmp_path) == "not a run directory, manifest.json is missing"


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        ([], "not a JSON object"),
        ({}, "neither of this narrows nor of 0.1: KeyError('fields')"),
        ({"fields": [], "colloids": 1}, "neither of this narrows nor of 0.1: KeyError('box')"),
        (hand_made() | {"format": 3}, "format 3: of a newer narrows; this one reads format 2, and"),
        (
            hand_made() | {"format": "x"},
            "format 'x': of a newer narrows; this one reads format 2, ",
        ),
        (hand_made() | {"engine": "../mpc"}, "engine: String should match pattern"),
        (hand_made() | {"fields": []}, "fields: should be a valid dictionary"),
        (hand_made() | {"colour": "red"}, "colour: Extra inputs are not permitted"),
    ],
)
def test_a_damaged_manifest_is_refused(content: Any, reason: str, tmp_path: Path) -> None:
    assert refused(written(tmp_path, content)).startswith(f"manifest.json: {reason}")


@pytest.mark.parametrize(
    ("part", "change", "reason"),
    [
        ("box", {"sizes": [1.0]}, "system.box.sizes: Tuple should have at least 2 items"),
        ("box", {"sizes": [1.0] * 4}, "system.box.sizes: Tuple should have at most 3 items"),
        ("box", {"periodic": [True]}, "system.box: sizes and periodic must have an entry for each"),
        ("box", {"sizes": [40.0, -1.0]}, "system.box.sizes.1: should be greater than 0"),
        ("box", {"sizes": [40.0, "ten"]}, "system.box.sizes.1: should be a valid number"),
        ("box", {"sizes": [40.0, None]}, "system.box.sizes.1: should be a valid number"),
        ("box", {"sizes": [40.0, float("nan")]}, "system.box.sizes.1: should be a finite number"),
        ("clock", {"sample_steps": 0}, "system.clock.sample_steps: should be greater than 0"),
        ("clock", {"sample_steps": 15}, "system.clock: sample_steps must be a multiple of look_st"),
        ("clock", {"total_steps": "many"}, "system.clock.total_steps: should be a valid integer"),
        ("clock", {"equilibration_steps": -1}, "system.clock.equilibration_steps: should be great"),
        ("clock", {"time_step": 0}, "system.clock.time_step: should be greater than 0"),
        ("clock", {"look_steps": 0}, "system.clock.look_steps: should be greater than 0"),
        ("solvent", {"density": 0}, "system.solvent.density: should be greater than 0"),
    ],
)
def test_a_wrong_part_is_named(part: str, change: Json, reason: str, tmp_path: Path) -> None:
    content = hand_made()
    content["system"][part] |= change
    assert refused(written(tmp_path, content)).startswith(f"manifest.json: {reason}")


@pytest.mark.parametrize("file", ["../up.dat", "/etc/passwd", ".hidden", "", "a b"])
def test_no_output_leaves_the_directory(file: str, tmp_path: Path) -> None:
    content = hand_made()
    content["system"]["outputs"][1] = content["system"]["outputs"][1] | {"file": file}
    assert refused(written(tmp_path, content)).startswith("manifest.json: system.outputs.1.file: ")


def test_variables_of_the_command_line_win(tmp_path: Path) -> None:
    written(tmp_path, hand_made())
    variables = {"total_steps": 200, "sample_steps": 20, "gravity": 0.7, "colour": 3}
    (tmp_path / "variables.json").write_text(json.dumps(variables))
    system = read_manifest(tmp_path).system
    assert (system.clock.total_steps, system.clock.sample_steps) == (200, 20)
    assert [drive.magnitude for drive in system.drives] == [0.7]
    assert system.clock.look_steps == 10


@pytest.mark.parametrize(
    ("variables", "reason"),
    [
        ('{"gravity": "much"}', "variables.json: gravity: must be a number"),
        ('{"gravity": NaN}', "variables.json: gravity: must be a number"),
        ('{"sample_steps": 15}', "variables.json: system.clock: sample_steps must be a multiple"),
        ('{"total_steps": 0}', "variables.json: system.clock.total_steps: should be greater than"),
        ("{", "variables.json: not JSON: "),
    ],
)
def test_damaged_variables_are_refused(variables: str, reason: str, tmp_path: Path) -> None:
    written(tmp_path, hand_made())
    (tmp_path / "variables.json").write_text(variables)
    assert refused(tmp_path).startswith(reason)

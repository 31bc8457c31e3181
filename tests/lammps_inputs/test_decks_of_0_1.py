"""Decks are byte for byte those of narrows 0.1, but for the lines listed here with their reason."""

import hashlib
import json
import math
import re
from pathlib import Path
from typing import Any

import pytest

from lammps_inputs import make_scene
from lammps_inputs.deck import script, write_deck
from lammps_inputs.engines.engine import Start
from lammps_inputs.scenes.channel import Channel

DECKS = json.loads((Path(__file__).parent / "decks_of_0_1.json").read_text())["decks"]
READ = {"in.lammps", "scene.toml", "manifest.json"}  # not among the files that the script reads


def present(old: str, case: dict[str, Any]) -> str:
    """An old script as it must be now."""
    lines = old.splitlines()
    look = next(int(line.split()[4]) for line in lines if " ave/time " in line)
    lines = [_any_sample(line, look) for line in lines]
    lines = _with_check_of_sample(lines, look)
    if case["fields"].get("gravity") == 0:
        lines = _with_drive_at_zero(lines, case)
    if case["engine"] == "mpc" and case["scene"] != "channel":
        # there are no colloids to make a group of
        lines = [line for line in lines if line != "group colloids type 1"]
    if case["engine"] == "mpc":
        lines = _with_lists_at_collisions(lines, case)
    return "\n".join(lines) + "\n"


def _any_sample(line: str, look: int) -> str:
    """`-var sample` was averaged over the last part of the interval only: looks follow it."""
    return re.sub(
        r"(ave/time|ave/chunk) (\d+) \d+ \$\{sample\}",
        lambda match: f"{match[1]} {match[2]} $(v_sample/{look}:%.0f) ${{sample}}",
        line,
    )


def _with_check_of_sample(lines: list[str], look: int) -> list[str]:
    """A sample that looks do not divide is refused."""
    at = next(i for i, line in enumerate(lines) if line.startswith("print '{"))
    check = (
        f'if "${{sample}} < {2 * look} || $(v_sample%{look}) != 0" then '
        f'"print \'ERROR: sample must be a multiple of {look}, at least twice that\'" "quit 1"'
    )
    return [*lines[:at], check, *lines[at:]]


def _with_lists_at_collisions(lines: list[str], case: dict[str, Any]) -> list[str]:
    """Lists were built, and places wrapped, at steps of checkpoints too, which then showed.

    They must hold for a collision interval in which two colloids may come closer.
    """
    every = next(line.split()[4] for line in lines if line.startswith("fix solvent all mpc "))
    old = "neigh_modify delay 0 every 1 check yes"
    new = [
        "# when lists are built and places wrapped shows in last digits: at each collision",
        f"neigh_modify delay 0 every {every} check no",
    ]
    if case["scene"] == "channel":
        scene = Channel.make(**case["fields"])
        mass = math.pi * scene.colloid_radius**2 * scene.density
        skin = max(0.5, 2 * scene.collision_time * (1 + 10 / math.sqrt(mass)))
        lines = [line.replace("neighbor 0.5 bin", f"neighbor {skin:.6g} bin") for line in lines]
    return [now for line in lines for now in (new if line == old else [line])]


def _with_drive_at_zero(lines: list[str], case: dict[str, Any]) -> list[str]:
    """A drive of 0 has its variable too: `-var gravity 0.2` had no effect and said nothing."""
    target = "colloids" if case["scene"] == "channel" else "fluid"
    text = "\n".join(lines)
    text = text.replace("-var steps 1000", "-var gravity 0.2")
    variable = f"variable gravity index 0.0 # acceleration of the {target} along x\n"
    text = text.replace("variable steps index", variable + "variable steps index")
    text = text.replace("${sample}}' file", '${sample}, "gravity": ${gravity}}\' file')
    if target == "colloids":
        fix = "fix gravity colloids gravity ${gravity} vector 1 0 0"
        text = re.sub(r"(\nfix wall colloids [^\n]*)", lambda m: f"{m[1]}\n{fix}", text)
    elif case["engine"] == "mpc":
        text = text.replace("hydro on", "hydro on field ${gravity} 0 0")
    else:
        pull = "fix gravity fluid set 1 0 group fluid vx v_pulled # fix srd ignores forces"
        lines_of_drive = f"variable pulled atom vx+v_gravity*dt\n{pull}\n"
        text = re.sub(r"(\ntimestep [^\n]*\n)", lambda m: m[1] + lines_of_drive, text)
    return text.splitlines()


@pytest.mark.parametrize(
    "case", DECKS, ids=lambda case: f"{case['engine']}-{case['scene']}-{case['fields']}"
)
def test_scripts_and_files_are_those_of_0_1(case: dict[str, Any], tmp_path: Path) -> None:
    scene = make_scene(case["scene"], **case["fields"])
    write_deck(scene, tmp_path, case["engine"])
    assert (tmp_path / "in.lammps").read_text() == present(case["script"], case)
    if "resumed" in case:
        resumed = script(scene, case["engine"], Start(1500, "checkpoint.1500.restart"))
        assert resumed == present(case["resumed"], case)
    digests = {
        path.name: hashlib.sha256(path.read_bytes()).hexdigest()
        for path in tmp_path.iterdir()
        if path.name not in READ
    }
    assert digests == case["files"]

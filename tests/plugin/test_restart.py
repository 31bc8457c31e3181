"""Restart files of plain LAMMPS continue on any number of processes.

To the last bit on the same number: test_resume.py. On another the sums of the forces round
differently, as in test_against_reference.py.
"""

from pathlib import Path

import pytest

from lammps_inputs import make_scene
from lammps_inputs.deck_lines import Start
from tests.conftest import Run
from tests.plugin.fluid import State, largest_difference, run_mpc

SCENES = {
    "channel": make_scene("channel", colloids=3, length=21, gravity=2.0),
    "slit": make_scene("poiseuille", length=12, width=9.5, gravity=0.02, thermostat="andersen"),
}
HALF = 17  # collisions: between two outputs
WHOLE = 32
TOLERANCE = 1e-9


@pytest.fixture(scope="module")
def uninterrupted() -> dict[str, State]:
    """By scene, filled by its first test."""
    return {}


@pytest.mark.parametrize(
    ("scene", "before", "after"),
    [("channel", 2, 1), ("channel", 2, 3), ("channel", 1, 2), ("slit", 2, 3)],
)
def test_continues_on_other_processes(
    scene: str,
    before: int,
    after: int,
    uninterrupted: dict[str, State],
    tmp_path: Path,
    command: Run,
) -> None:
    of = SCENES[scene]
    step = HALF * of.steps_per_collision
    assert step % of.sample_steps
    if scene not in uninterrupted:
        uninterrupted[scene] = run_mpc(of, WHOLE, tmp_path / "whole", command)
    parts = tmp_path / "parts"
    half = run_mpc(of, HALF, parts, command, before, end="write_restart half.restart\n")
    end = run_mpc(of, WHOLE, parts, command, after, start=Start(step, "half.restart"))
    assert largest_difference(half, end, of) > 0.1
    assert largest_difference(end, uninterrupted[scene], of) < TOLERANCE

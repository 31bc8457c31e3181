"""Restart files of plain LAMMPS continue on any number of processes.

To the last bit on the same number: test_resume.py. On another the sums of the forces round
differently, as in test_against_reference.py.
"""

from pathlib import Path

import numpy as np
import pytest

from lammps_inputs import make_scene
from lammps_inputs.deck import script
from lammps_inputs.engines.engine import Start
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
    clock = of.system.clock
    step = HALF * clock.steps_per_collision
    assert step % clock.sample_steps
    if scene not in uninterrupted:
        uninterrupted[scene] = run_mpc(of, WHOLE, tmp_path / "whole", command)
    parts = tmp_path / "parts"
    half = run_mpc(of, HALF, parts, command, before, end="write_restart half.restart\n")
    end = run_mpc(of, WHOLE, parts, command, after, start=Start(step, "half.restart"))
    assert largest_difference(half, end, of) > 0.1
    assert largest_difference(end, uninterrupted[scene], of) < TOLERANCE


@pytest.mark.parametrize(("hydrodynamics", "ranks"), [("bath", 1), ("bath", 2), ("shuffle", 1)])
def test_a_random_solvent_continues_to_the_last_bit(
    hydrodynamics: str, ranks: int, tmp_path: Path, command: Run
) -> None:
    of = make_scene("poiseuille", length=12, width=9.5, gravity=0.02, hydrodynamics=hydrodynamics)
    whole = run_mpc(of, WHOLE, tmp_path / "whole", command, ranks)
    parts = tmp_path / "parts"
    run_mpc(of, HALF, parts, command, ranks, end="write_restart half.restart\n")
    start = Start(HALF * of.system.clock.steps_per_collision, "half.restart")
    end = run_mpc(of, WHOLE, parts, command, ranks, start=start)
    np.testing.assert_array_equal(end.fluid_positions, whole.fluid_positions)
    np.testing.assert_array_equal(end.fluid_velocities, whole.fluid_velocities)


@pytest.mark.parametrize(
    ("accident", "complaint"),
    [
        ("fix pull all addforce 1e6 0 0", "the choice of near fluid allows"),
        ("displace_atoms all move 2.5 0 0", "inside its core: the time step is too long"),
    ],
)
def test_a_fault_leaves_the_last_checkpoint_intact(
    accident: str, complaint: str, tmp_path: Path, command: Run
) -> None:
    scene = SCENES["channel"]
    whole = run_mpc(scene, 12, tmp_path, command)
    deck = tmp_path / "in.lammps"
    start, run, end = deck.read_text().partition("run ${steps} upto")
    deck.write_text(f"{start}restart 60 checkpoint.*.restart\nrun 120 upto\n{accident}\n{run}{end}")
    done = command("lmp", "-in", "in.lammps", "-var", "steps", "180", cwd=tmp_path, succeed=False)
    assert done.returncode == 1
    assert complaint in done.stdout
    assert "fix mpc: step 12" in done.stdout  # 120, or soon after it

    again = run_mpc(scene, 12, tmp_path, command, start=Start(120, "checkpoint.120.restart"))
    for one, other in zip(vars(again).values(), vars(whole).values(), strict=True):
        np.testing.assert_array_equal(one, other)


@pytest.mark.parametrize(
    ("seed", "offset", "complaint"),
    [("2", None, "restart: of the seed 1, not 2"), ("1", -2000, "restart: damaged")],
)
def test_a_restart_of_another_seed_or_damaged_is_refused(
    seed: str, offset: int | None, complaint: str, tmp_path: Path, command: Run
) -> None:
    of = make_scene("poiseuille", length=8, width=8)
    run_mpc(of, 10, tmp_path, command, end="write_restart half.restart\n")
    if offset:
        file = tmp_path / "half.restart"
        content = bytearray(file.read_bytes())
        content[offset] ^= 1
        file.write_bytes(content)
    deck = script(of, "mpc", Start(10, "half.restart"))
    (tmp_path / "in.lammps").write_text(deck)
    words = ("lmp", "-in", "in.lammps", "-var", "seed", seed, "-var", "steps", "20")
    done = command(*words, cwd=tmp_path, succeed=False)
    assert done.returncode != 0
    assert complaint in done.stdout + done.stderr

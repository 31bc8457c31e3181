"""Saved fluids: what fix mpc and our decks write is read; anything else is one line."""

from pathlib import Path

import numpy as np
import pytest

from lammps_inputs import initial_state, make_scene
from lammps_inputs.engines.mpc import fluid_file
from run_files import RunDirectoryError
from run_files.fluid_file import read_fluid

SCENE = make_scene("bulk", length=4, width=4, density=2)
STATE = initial_state(SCENE.system, 1)
CONTENT = fluid_file(STATE)


def test_what_a_deck_writes_is_read(tmp_path: Path) -> None:
    path = tmp_path / "state.fluid"
    path.write_bytes(CONTENT)
    fluid = read_fluid(path)
    np.testing.assert_array_equal(fluid.positions, STATE.fluid_positions)
    np.testing.assert_array_equal(fluid.velocities, STATE.fluid_velocities)


def test_particles_are_sorted_by_number(tmp_path: Path) -> None:
    rows = np.frombuffer(CONTENT[32:], dtype="<f8").reshape(-1, 5)[::-1]
    path = tmp_path / "state.fluid"
    path.write_bytes(CONTENT[:32] + rows.tobytes())
    np.testing.assert_array_equal(read_fluid(path).positions, STATE.fluid_positions)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "not a fluid"),
        (b"mpcstate" + CONTENT[8:], "not a fluid"),
        (CONTENT[:-8], "bytes do not hold 32 particles in 2 dimensions"),
        (CONTENT[:8] + (7).to_bytes(8, "little") + CONTENT[16:], "in 7 dimensions"),
        (CONTENT[:16] + (-1).to_bytes(8, "little", signed=True) + CONTENT[24:], "hold -1 part"),
        (CONTENT[:32] + CONTENT[32:72] + CONTENT[32:72] + CONTENT[112:], "not numbered from 0"),
        (CONTENT[:40] + np.float64(np.nan).tobytes() + CONTENT[48:], "not all finite"),
    ],
)
def test_damage_is_one_line(content: bytes, message: str, tmp_path: Path) -> None:
    path = tmp_path / "state.fluid"
    path.write_bytes(content)
    with pytest.raises(RunDirectoryError, match=message) as error:
        read_fluid(path)
    assert str(error.value).startswith(f"{path}: ")


def test_a_missing_file_is_one_line(tmp_path: Path) -> None:
    with pytest.raises(RunDirectoryError, match="No such file"):
        read_fluid(tmp_path / "none.fluid")

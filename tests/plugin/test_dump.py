"""The dump of fix mpc: every M-th particle as saved, on any number of processes, for MDAnalysis."""

from pathlib import Path

import MDAnalysis
import numpy as np
import pytest

from run_files.fluid_file import read_fluid
from tests.conftest import Run

DECK = """units lj
dimension {dimension}
boundary p f p
region box block -1 9 2 12 {z}
create_box 1 box
mass 1 1.0
timestep 0.1
fix water all mpc 2 NULL 1.0 1.0 4711 create {count} density 8 dump 4 {one_in} file water.lammpsdump
run 6
fix_modify water save water.fluid
run 2
fix_modify water save last.fluid
"""


def run(folder: Path, command: Run, dimension: int, one_in: int, processes: int = 1) -> None:
    folder.mkdir()
    z, count = ("-0.5 0.5", 800) if dimension == 2 else ("3 7", 3200)
    text = DECK.format(dimension=dimension, z=z, one_in=one_in, count=count)
    (folder / "in.water").write_text(text)
    launcher = ("mpirun", "-np", str(processes)) if processes > 1 else ()
    command(*launcher, "lmp", "-in", "in.water", cwd=folder)


@pytest.mark.parametrize("dimension", [2, 3])
def test_it_is_every_so_many_of_the_saved_fluid(
    dimension: int, tmp_path: Path, command: Run
) -> None:
    run(tmp_path / "run", command, dimension, 7)
    fluid = read_fluid(tmp_path / "run" / "last.fluid")
    universe = MDAnalysis.Universe(str(tmp_path / "run" / "water.lammpsdump"), dt=0.1)
    frames = universe.trajectory
    assert [frame.data["step"] for frame in frames] == [0, 4, 8]
    frame = frames[-1]
    assert list(universe.atoms.ids) == list(range(1, len(fluid.positions) + 1, 7))
    # MDAnalysis counts from the lower corner of the box
    corner = np.array([-1, 2, 3])[:dimension]
    places = frame.positions[:, :dimension]
    np.testing.assert_allclose(places, fluid.positions[::7] - corner, atol=2e-4)
    np.testing.assert_allclose(frame.velocities[:, :dimension], fluid.velocities[::7], atol=2e-5)
    assert universe.dimensions[:2] == pytest.approx([10, 10])


def test_two_processes_write_the_same(tmp_path: Path, command: Run) -> None:
    files = []
    for processes in (1, 2):
        folder = tmp_path / str(processes)
        run(folder, command, 2, 3, processes)
        lines = (folder / "water.lammpsdump").read_text().splitlines()
        files.append([line for line in lines if line.count(" ") == 7 and "ITEM" not in line])
    one, two = (np.array([line.split() for line in lines], dtype=float) for lines in files)
    np.testing.assert_array_equal(one[:, :2], two[:, :2])
    np.testing.assert_allclose(one, two, atol=1e-4)  # sums over cells round, six digits are written


def test_it_is_appended_to_after_a_restart(tmp_path: Path, command: Run) -> None:
    """And has no frame twice."""
    deck = DECK.format(dimension=2, z="-0.5 0.5", one_in=1, count=800)
    first = deck.replace("run 2", "run 2\nwrite_restart half")
    (tmp_path / "in.first").write_text(first)
    fix = next(line for line in deck.splitlines() if line.startswith("fix "))
    rest = f"read_restart half\ntimestep 0.1\n{fix.replace(' file ', ' append ')}\nrun 8\n"
    (tmp_path / "in.rest").write_text(rest)
    command("lmp", "-in", "in.first", cwd=tmp_path)
    command("lmp", "-in", "in.rest", cwd=tmp_path)
    lines = (tmp_path / "water.lammpsdump").read_text().splitlines()
    steps = [lines[n + 1] for n, line in enumerate(lines) if line == "ITEM: TIMESTEP"]
    assert steps == ["0", "4", "8", "12", "16"]


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ("3 1 file f", "dump Nevery 3: must be a multiple of N"),
        ("4 0 file f", "dump M 0: must be positive"),
        ("4 1 new f", "dump mode new: must be one of file, append"),
        ("4 1 file no/such/folder", "dump: cannot write no/such/folder"),
        ("4 1 file /dev/full", "dump: cannot write /dev/full"),
    ],
)
def test_what_is_refused(values: str, message: str, tmp_path: Path, command: Run) -> None:
    deck = DECK.format(dimension=2, z="-0.5 0.5", one_in=1, count=800)
    (tmp_path / "in.t").write_text(deck.replace("4 1 file water.lammpsdump", values))
    said = command("lmp", "-in", "in.t", cwd=tmp_path, succeed=False)
    assert message in said.stdout + said.stderr

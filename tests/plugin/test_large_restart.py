"""A fluid too large for LAMMPS's restart file is beside it, shared by the processes."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from lammps_inputs import make_scene
from srd_driver import RunError, Simulation
from tests.conftest import Run
from tests.plugin.fluid import read_fluid

PARTICLES = 120_000
BYTES = 32 + 40 * PARTICLES
FLUID = f"fix fluid all mpc 1 NULL 1 1 7 create {PARTICLES} density 100 tstat layer field 0.01 0 0"
BOX = "region box block -3.1 36.9 0.7 30.7 -0.5 0.5\ncreate_box 1 box\nmass 1 1"
DECK = "units lj\ndimension 2\nboundary p f p\n{start}\ntimestep 0.1\n{fluid}\nrun 6\n"
HALF = "half.restart"
BESIDE = "half.restart.fluid"
IO = Path("/proc/self/io")

COUNT_READ = """
import re, sys
from mpi4py import MPI
from lammps import lammps
def read():
    return int(re.search(r"rchar: (\\d+)", open("/proc/self/io").read())[1])
deck, fluid = open("in.lammps").read().split("timestep 0.1\\n")
one = lammps(cmdargs=["-log", "none", "-screen", "none"])
one.commands_string(deck)
before = read()
one.commands_string("timestep 0.1\\n" + fluid.split("\\n")[0])
counts = MPI.COMM_WORLD.gather(read() - before)
if counts:
    print("read", *counts)
"""


def deck(start: str, end: str = "") -> str:
    return DECK.format(start=start, fluid=FLUID) + end


def run(folder: Path, text: str, ranks: int, command: Run, succeed: bool = True) -> str:
    folder.mkdir(exist_ok=True)
    (folder / "in.lammps").write_text(text)
    words = ("mpirun", "-np", str(ranks), "lmp", "-in", "in.lammps")
    done = command(*words, cwd=folder, succeed=succeed)
    assert (done.returncode == 0) == succeed
    return done.stdout + done.stderr


@pytest.fixture(scope="module")
def half(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where two processes leave a restart, filled by the first test."""
    return tmp_path_factory.mktemp("large") / "half"


def made(half: Path, command: Run) -> Path:
    if not half.exists():
        save = "fix_modify fluid save end.fluid\nwrite_restart end.restart\n"
        run(half, deck(BOX, f"write_restart {HALF}\nrun 6\n{save}"), 2, command)
    return half


def test_the_fluid_is_beside_the_restart(half: Path, command: Run) -> None:
    made(half, command)
    assert (half / HALF).stat().st_size < 10_000
    assert (half / BESIDE).stat().st_size == BYTES


@pytest.mark.parametrize(("ranks", "moved"), [(1, True), (2, False), (2, True), (3, True)])
def test_another_number_of_processes_goes_on(
    ranks: int, moved: bool, half: Path, tmp_path: Path, command: Run
) -> None:
    """To the last bit on the same number; found where it was written, or where LAMMPS runs."""
    made(half, command)
    file = str(half / HALF)
    if moved:
        file = HALF
        for name in (HALF, BESIDE):
            shutil.copy(half / name, tmp_path / name)
    run(tmp_path, deck(f"read_restart {file}", "fix_modify fluid save end.fluid"), ranks, command)
    if ranks == 2:
        assert (tmp_path / "end.fluid").read_bytes() == (half / "end.fluid").read_bytes()
    else:
        for mine, theirs in zip(
            read_fluid(tmp_path / "end.fluid"), read_fluid(half / "end.fluid"), strict=True
        ):
            np.testing.assert_allclose(mine, theirs, rtol=0, atol=1e-9)


@pytest.mark.parametrize(
    ("damage", "complaint"),
    [
        ("missing", f"{BESIDE} is missing"),
        ("truncated", f"{BESIDE}: {BYTES - 1} bytes do not hold {PARTICLES} particles"),
        ("flipped", f"{BESIDE}: damaged, or of another restart file"),
        ("of another", f"{BESIDE}: damaged, or of another restart file"),
        ("empty", f"{BESIDE}: not a fluid in 2 dimensions"),
    ],
)
def test_a_damaged_part_is_named_in_one_line(
    damage: str, complaint: str, half: Path, tmp_path: Path, command: Run
) -> None:
    made(half, command)
    shutil.copy(half / HALF, tmp_path)
    content = (half / ("end.restart.fluid" if damage == "of another" else BESIDE)).read_bytes()
    if damage == "truncated":
        content = content[:-1]
    elif damage == "flipped":
        content = content[:-1000] + bytes([content[-1000] ^ 4]) + content[-999:]
    elif damage == "empty":
        content = b""
    start = f"read_restart {HALF}"
    if damage == "missing":
        (tmp_path / "gone").mkdir()
        run(tmp_path / "gone", deck(BOX, f"write_restart {HALF}"), 1, command)
        shutil.copy(tmp_path / "gone" / HALF, tmp_path)
        shutil.rmtree(tmp_path / "gone")
    else:
        (tmp_path / BESIDE).write_bytes(content)
    said = run(tmp_path, deck(start), 2, command, succeed=False)
    assert said.count(complaint) == 1, said


def test_a_run_keeps_the_fluid_beside_its_checkpoint(tmp_path: Path) -> None:
    fields = {"length": 110, "width": 100, "gravity": 1e-5, "sampling_interval": 0.5}
    scene = make_scene("poiseuille", equilibration=0, duration=2, **fields)
    with Simulation(scene, "mpc", tmp_path / "whole") as whole:
        whole.finish()
    parts = tmp_path / "parts"
    with Simulation(scene, "mpc", parts, checkpoint_interval=0.5) as run:
        run.run(1)
    kept = {path.name for path in parts.glob("checkpoint.*")}
    assert kept == {"checkpoint.10.restart", "checkpoint.10.restart.fluid"}
    for left in ("checkpoint.15.restart", "checkpoint.15.restart.fluid"):  # by a kill
        (parts / left).write_bytes(b"half")
    parts = parts.rename(tmp_path / "moved")

    file = parts / "checkpoint.10.restart.fluid"
    content = file.read_bytes()
    file.write_bytes(content[:-1])
    with pytest.raises(RunError, match=f"{file.name}: .* bytes do not hold") as error:
        Simulation(scene, "mpc", parts, resume=True)
    assert "\n" not in str(error.value)
    file.write_bytes(content)
    with Simulation(scene, "mpc", parts, resume=True) as run:
        assert {path.name for path in parts.glob("checkpoint.*")} == kept
        run.finish()
    for output in ("observables.dat", "fluid_profile.dat"):
        assert (parts / output).read_bytes() == (tmp_path / "whole" / output).read_bytes()


@pytest.mark.skipif(not IO.exists(), reason="counts what processes read, as Linux tells")
def test_each_process_reads_its_share(half: Path, tmp_path: Path, command: Run) -> None:
    made(half, command)
    (tmp_path / "in.lammps").write_text(deck(f"read_restart {half / HALF}"))
    (tmp_path / "count.py").write_text(COUNT_READ)
    said = command("mpirun", "-np", "3", "python", "count.py", cwd=tmp_path).stdout
    counts = [int(word) for word in said.split("read")[1].split()]
    assert len(counts) == 3
    assert max(counts) < BYTES / 3 + 100_000
    assert min(counts) > BYTES / 3 - 100_000

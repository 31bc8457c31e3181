"""Neither checkpoints nor stops nor the program that runs it show in what a run leaves."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from lammps_inputs import make_scene
from lammps_inputs.deck import write_deck
from run_files.progress import is_begun
from srd_driver.resume import newest_step
from tests.conftest import COMMANDS, ROOT, Run

FILES = ("trajectory.lammpsdump", "fluid_profile.dat", "observables.dat")
SCENE = {"length": 24, "equilibration": 0, "gravity": 1}


def words(folder: Path, duration: float, interval: float) -> list[str]:
    fields = [f"{name}={value}" for name, value in (SCENE | {"duration": duration}).items()]
    return [
        *("run", "channel", "--engine", "mpc", "--out", str(folder)),
        *("--checkpoint-interval", str(interval)),
        *(word for field in fields for word in ("--set", field)),
    ]


def differences(one: Path, other: Path) -> list[str]:
    """The outputs that are not the same byte for byte."""
    return [file for file in FILES if (one / file).read_bytes() != (other / file).read_bytes()]


def stopped_at(line: list[str], folder: Path, step: int) -> None:
    """Start or resume a run, and have it stop, with a checkpoint, soon after the step."""
    process = subprocess.Popen(line, env=os.environ | {"PYTHONPATH": str(ROOT)})
    while not is_begun(folder) or newest_step(folder) < step:
        assert process.poll() is None, "the run ended before it was stopped"
        time.sleep(0.005)
    os.kill(int((folder / ".lock").read_text().split()[1]), signal.SIGTERM)
    assert process.wait() == 130


def last_frame(file: Path) -> np.ndarray:
    rows = file.read_text().rsplit("iz\n", maxsplit=1)[1]
    return np.loadtxt(rows.splitlines(), ndmin=2)


@pytest.mark.parametrize(
    ("ranks", "duration", "intervals"), [(1, 150.0, (0.75, 1000.0)), (2, 150.0, (3.0,))]
)
def test_neither_checkpoints_nor_stops_nor_the_program_show(
    ranks: int, duration: float, intervals: tuple[float, ...], tmp_path: Path, command: Run
) -> None:
    mpi = ["mpirun", "-np", str(ranks)] if ranks > 1 else []
    narrows = [*mpi, "python", "-m", "narrows"] if ranks > 1 else ["narrows"]
    by_lmp = tmp_path / "lmp"
    by_lmp.mkdir()
    write_deck(make_scene("channel", duration=duration, **SCENE), by_lmp, "mpc")
    command(*mpi, "lmp", "-in", "in.lammps", "-screen", "none", cwd=by_lmp)
    last = last_frame(by_lmp / "trajectory.lammpsdump")
    assert last[:, 8].max() >= 1  # wrapped
    assert 0 <= last[:, 2].min() <= last[:, 2].max() < 24

    for interval in intervals:
        command(*narrows, *words(tmp_path / str(interval), duration, interval))
        assert differences(by_lmp, tmp_path / str(interval)) == []

    stopped = tmp_path / "stopped"
    program = [str(COMMANDS / "mpirun"), *mpi[1:], sys.executable] if mpi else [sys.executable]
    for part in (1, 2):
        line = words(stopped, duration, 7.5 * part)
        stopped_at(
            [*program, "-m", "narrows", *line, "--resume"], stopped, round(300 * duration) * part
        )
    command(*narrows, *words(stopped, duration, 1000.0), "--resume")
    assert differences(by_lmp, stopped) == []


@pytest.mark.parametrize(
    ("line", "shorter", "complaint"),
    [
        ("pair_coeff", "pair_coeff 1 1 1 1 48 24 1.03", "use comm_modify cutoff"),
        ("neighbor", "neighbor 0.001 bin", "built every 15 steps: use neighbor 0.0"),
    ],
)
def test_lists_and_ghosts_too_short_for_an_interval_are_refused(
    line: str, shorter: str, complaint: str, tmp_path: Path, command: Run
) -> None:
    write_deck(make_scene("channel", length=21, equilibration=0, duration=1.5), tmp_path, "mpc")
    deck = (tmp_path / "in.lammps").read_text()
    long = next(row for row in deck.splitlines() if row.startswith(line))
    deck = deck.replace(long, shorter)
    if line == "pair_coeff":
        deck = deck.replace("mie/cut 4.1", "mie/cut 1.1")
    (tmp_path / "in.lammps").write_text(deck)
    done = command("lmp", "-in", "in.lammps", cwd=tmp_path, succeed=False)
    assert done.returncode != 0
    assert complaint in done.stdout + done.stderr

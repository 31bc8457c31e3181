"""A run that was killed and resumed is, to the last bit, the run that was not."""

import json
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.conftest import ROOT, Run

FILES = ("trajectory.lammpsdump", "fluid_profile.dat", "observables.dat")


def words(folder: Path, scene: str, duration: float) -> list[str]:
    fields = {
        "channel": ["length=24", "equilibration=0", "gravity=1"],
        "poiseuille": ["length=20", "width=15", "equilibration=0", "thermostat=monte_carlo"],
    }[scene]
    fields.append(f"duration={duration}")
    return [
        *("run", scene, "--engine", "mpc", "--out", str(folder), "--checkpoint-interval", "1.5"),
        *(word for field in fields for word in ("--set", field)),
    ]


def progress(folder: Path) -> int:
    """The step of a run's newest checkpoint."""
    file = folder / "progress.json"
    return int(json.loads(file.read_text())["step"]) if file.exists() else 0


def killed_after(line: list[str], folder: Path, step: int, delay: float) -> None:
    """Start or resume a run, and kill it some time [s] after it has a checkpoint of the step."""
    process = subprocess.Popen(
        line, env=os.environ | {"PYTHONPATH": str(ROOT)}, start_new_session=True
    )
    while progress(folder) < step:
        assert process.poll() is None, "the run ended before it was killed"
        time.sleep(0.01)
    time.sleep(delay)
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()


def rows(file: Path) -> list[str]:
    """The lines of an output; LAMMPS repeats the titles of a file it appends to."""
    return [line for line in file.read_text().splitlines() if not line.startswith("#")]


def differences(one: Path, other: Path) -> list[str]:
    existing = [file for file in FILES if (one / file).exists()]
    assert len(existing) >= 2
    return [file for file in existing if rows(one / file) != rows(other / file)]


@pytest.mark.parametrize(("scene", "ranks"), [("channel", 1), ("channel", 2), ("poiseuille", 1)])
def test_a_checkpoint_continues_bit_for_bit(
    scene: str, ranks: int, tmp_path: Path, command: Run
) -> None:
    launcher = ["mpirun", "-np", str(ranks), "python", "-m"] if ranks > 1 else []
    duration = 9.0 if scene == "channel" else 30.0
    command(*launcher, "narrows", *words(tmp_path / "whole", scene, duration))
    command(*launcher, "narrows", *words(tmp_path / "parts", scene, duration / 3))
    command(*launcher, "narrows", *words(tmp_path / "parts", scene, duration), "--resume")
    assert differences(tmp_path / "whole", tmp_path / "parts") == []


def numbers(file: Path) -> list[list[float]]:
    """The rows of numbers of an output."""
    return [[float(word) for word in row.split()] for row in rows(file) if row[0] != "I"]


@pytest.mark.parametrize(("before", "after"), [(1, 2), (2, 1)])
def test_another_number_of_ranks_continues_to_rounding(
    before: int, after: int, tmp_path: Path, command: Run
) -> None:
    """Sums round differently; after 100 collisions the digits written are still the same."""

    def run(folder: str, duration: float, ranks: int, *options: str) -> None:
        launcher = ["mpirun", "-np", str(ranks), "python", "-m"] if ranks > 1 else []
        line = words(tmp_path / folder, "channel", duration)
        command(*launcher, "narrows", *line, *options)

    run("whole", 4.5, 1)
    run("parts", 3.0, before)
    run("parts", 4.5, after, "--resume")
    for file in FILES:
        whole, parts = (numbers(tmp_path / folder / file) for folder in ("whole", "parts"))
        for one, other in zip(whole, parts, strict=True):
            assert one == pytest.approx(other, rel=2e-5, abs=1e-6), file
    steps = [row[0] for row in numbers(tmp_path / "parts" / "observables.dat")]
    assert steps == list(range(750, 4501, 750))


def killed_often(kills: int, duration: float, folder: Path, command: Run) -> list[str]:
    """What differs between a run and one that was killed so many times."""
    command("narrows", *words(folder / "whole", "channel", duration))
    line = [sys.executable, "-m", "narrows", *words(folder / "killed", "channel", duration)]
    total = progress(folder / "whole")
    for kill in range(kills):
        killed_after(
            [*line, "--resume"],
            folder / "killed",
            total * kill // (kills + 1),
            random.SystemRandom().uniform(0.0, 0.2),
        )
    command("narrows", *line[3:], "--resume")
    return differences(folder / "whole", folder / "killed")


def test_kill_and_resume(tmp_path: Path, command: Run) -> None:
    assert killed_often(2, 300.0, tmp_path, command) == []


@pytest.mark.statistics
def test_kill_at_20_random_moments(tmp_path: Path, command: Run) -> None:
    assert killed_often(20, 3000.0, tmp_path, command) == []

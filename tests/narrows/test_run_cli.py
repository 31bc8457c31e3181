"""`narrows deck` and `narrows run` as a user types them."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from tests.conftest import COMMANDS, ROOT, Run
from tests.dumps import frames

SHORT = ["--set", "duration=1.2", "--set", "equilibration=0", "--set", "sampling_interval=0.15"]
THIN = ["--set", "density=0.5", "--set", "duration=10"]


def test_deck_writes_a_folder_that_lmp_runs(tmp_path: Path, command: Run) -> None:
    out = tmp_path / "deck"
    done = command("narrows", "deck", "channel", "--out", out, *SHORT)
    assert "lmp -in in.lammps" in done.stdout
    command("lmp", "-in", "in.lammps", "-var", "steps", "300", cwd=out)
    assert list(frames(out / "trajectory.lammpsdump")) == [0, 150, 300]
    again = command("narrows", "deck", "channel", "--out", out, succeed=False)
    assert again.returncode == 1
    assert "is not empty" in again.stderr


def test_settings_win_over_the_file(tmp_path: Path, command: Run) -> None:
    file = tmp_path / "mine.toml"
    file.write_text('scene = "channel"\ncolloids = 2\ngravity = 0.2\n')
    command(
        *("narrows", "deck", "channel", "--scene", file, "--out", tmp_path / "deck"),
        *("--set", "gravity=0.3"),
    )
    fields = json.loads((tmp_path / "deck" / "manifest.json").read_text())["fields"]
    assert (fields["colloids"], fields["gravity"]) == (2, 0.3)
    other = command(
        *("narrows", "deck", "bulk", "--scene", file, "--out", tmp_path / "x"), succeed=False
    )
    assert other.returncode == 2
    assert "scene = 'channel': the command line says 'bulk'" in other.stderr


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["chanel"], "scene = 'chanel': must be one of bulk, "),
        (["channel", "--set", "length=40.5"], "length = 40.5: a periodic length must be"),
        (["channel", "--set", "length"], "'length': must have the form field=value"),
        (["channel", "--scene", "none.toml"], "none.toml: "),
        (
            ["channel", "--engine", "srd", "--set", "angle=120"],
            "angle = 120.0: fix srd rotates by 90",
        ),
    ],
)
def test_bad_input_is_one_message_and_nothing_is_made(
    arguments: list[str], message: str, tmp_path: Path, command: Run
) -> None:
    done = command("narrows", "run", *arguments, "--out", tmp_path / "run", succeed=False)
    assert done.returncode == 2
    assert done.stderr.startswith(f"narrows: {message}")
    assert done.stdout == ""
    assert not (tmp_path / "run").exists()


def test_a_run_is_quiet_without_a_terminal(tmp_path: Path, command: Run) -> None:
    out = tmp_path / "run"
    done = command("narrows", "run", "channel", "--out", out, *SHORT)
    assert done.stderr == ""
    assert done.stdout == f"{out}: at time 1.2; next: narrows analyze {out}\n"
    refused = command("narrows", "run", "channel", "--out", out, *SHORT, succeed=False)
    assert refused.returncode == 1
    assert f"{out} is not empty: go on with its run by --resume" in refused.stderr
    again = command("narrows", "run", "channel", "--out", out, "--resume")
    assert again.stdout == f"{out}: finished before, at time 1.2\n"
    other = tmp_path / "other"
    begun = command("narrows", "run", "channel", "--out", other, *SHORT, "--resume")
    nothing = f"{other}: nothing to go on from, begins with a duration of 1.2"
    assert begun.stdout.splitlines()[0] == nothing


def test_what_will_be_inaccurate_is_one_warning_and_runs(tmp_path: Path, command: Run) -> None:
    done = command("narrows", "deck", "bulk", "--set", "density=0.5", "--out", tmp_path / "deck")
    assert done.stderr.startswith("warning: density = 0.5: most fluid particles are alone")
    assert all(line.startswith("warning: ") for line in done.stderr.splitlines())
    again = command("narrows", "run", "bulk", *THIN, "--out", tmp_path / "run")
    assert again.stderr == done.stderr
    analysed = command("narrows", "analyze", tmp_path / "run")
    assert analysed.stderr.startswith("warning: the temperature of the fluid is 0.")


def test_two_processes_are_one_run(tmp_path: Path, command: Run) -> None:
    out = tmp_path / "run"
    words = ["-m", "narrows", "run", "channel", "--out", str(out), *SHORT]
    done = command("mpirun", "-np", "2", "python", *words)
    assert done.stdout.count("at time 1.2") == 1
    assert list(frames(out / "trajectory.lammpsdump")) == list(range(0, 1201, 150))
    assert json.loads((out / "manifest.json").read_text())["ranks"] == 2
    serial = command(
        "mpirun", "-np", "2", "python", *words[:-1], "--engine", "reference", succeed=False
    )
    assert serial.returncode != 0


def test_any_process_may_stop_the_run(tmp_path: Path, command: Run) -> None:
    program = (
        "import sys; from lammps_inputs import make_scene; from srd_driver import Simulation\n"
        "with Simulation(make_scene('channel'), directory=sys.argv[1]) as simulation:\n"
        "    simulation.finish(lambda now: now.stop() if now.rank == 1 else None)\n"
        "    print(simulation.step, simulation.finished)\n"
    )
    out = tmp_path / "run"
    told = command("mpirun", "-np", "2", "python", "-c", program, str(out)).stdout.splitlines()
    reached = json.loads((out / "progress.json").read_text())["step"]
    assert told == [f"{reached} False"] * 2


@pytest.mark.parametrize("ranks", [1, 2])
def test_a_signal_to_one_process_stops_the_run_with_a_checkpoint(
    ranks: int, tmp_path: Path, command: Run
) -> None:
    out = tmp_path / "run"
    words = ["-np", str(ranks), "python", "-m", "narrows", "run", "channel", "--out", str(out)]
    words += ["--set", "equilibration=0", "--set", "sampling_interval=0.15"]
    words += ["--checkpoint-interval", "9000"]
    process = subprocess.Popen(
        [COMMANDS / "mpirun", *words, "--set", "duration=10000"],
        env=os.environ | {"PYTHONPATH": str(ROOT), "PATH": f"{COMMANDS}:/usr/bin:/bin"},
        stderr=subprocess.PIPE,
        text=True,
    )
    output = out / "observables.dat"
    while not output.exists() or output.read_text().count("\n") < 3:  # two lines of titles
        assert process.poll() is None
        time.sleep(0.05)
    os.kill(int((out / ".lock").read_text().split()[1]), signal.SIGTERM)
    _, stderr = process.communicate(timeout=300)
    assert process.returncode == 130
    assert stderr == "narrows: interrupted: go on from the newest checkpoint by --resume\n"
    reached = json.loads((out / "progress.json").read_text())["step"]
    assert reached > 0
    assert list(frames(out / "trajectory.lammpsdump"))[-1] == reached
    command("mpirun", *words, "--resume", "--set", f"duration={reached / 1000 + 0.3}")
    steps = list(frames(out / "trajectory.lammpsdump"))
    assert steps == list(range(0, reached + 301, 150))


@pytest.mark.parametrize("engine", ["srd", "reference"])
def test_kill_9_loses_nothing_that_resume_needs(engine: str, tmp_path: Path, command: Run) -> None:
    out = tmp_path / "run"
    words = ["run", "channel", "--engine", engine, "--out", str(out), "--checkpoint-interval", "1"]
    words += ["--set", "duration=12", "--set", "equilibration=0", "--set", "colloids=1"]
    words += ["--set", "sampling_interval=0.15", "--set", "length=20"]
    line = [sys.executable, "-m", "narrows", *words]
    random = np.random.default_rng(5)
    for _ in range(3):  # each goes on from the one before, killed after a random while
        process = subprocess.Popen([*line, "--resume"], env=os.environ | {"PYTHONPATH": str(ROOT)})
        time.sleep(1.5 + 0.5 * random.random())
        process.send_signal(signal.SIGKILL)
        process.wait()
    command("narrows", *words, "--resume")
    progress = json.loads((out / "progress.json").read_text())
    assert progress["finished"]
    trajectory = frames(out / "trajectory.lammpsdump")
    assert list(trajectory) == list(range(0, progress["step"] + 1, 150))
    assert all(rows.shape == (1, 11) for rows in trajectory.values())
    steps = np.loadtxt(out / "observables.dat")[:, 0]
    np.testing.assert_array_equal(steps, list(trajectory)[1:])


def test_a_full_disk_stops_with_a_message_and_resumes(tmp_path: Path, command: Run) -> None:
    """A limit on file sizes stands in for a full disk: the system refuses to write more."""
    out = tmp_path / "run"
    program = (
        "import resource; from srd_driver.parallel import communicator; communicator();"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (450_000, resource.RLIM_INFINITY));"
        "from narrows.cli import app; app()"
    )
    words = ["run", "channel", "--out", str(out), "--set", "equilibration=0"]
    words += ["--checkpoint-interval", "3", "--set", "length=20", "--set", "colloids=1"]
    words += ["--set", "sampling_interval=0.03"]
    done = command("python", "-c", program, *words, "--set", "duration=1000", succeed=False)
    assert done.returncode == 1
    assert done.stderr.count("narrows: stopped after step") == 1
    assert "go on from there by --resume" in done.stderr
    reached = json.loads((out / "progress.json").read_text())["step"]
    assert reached > 0
    command("narrows", *words, "--resume", "--set", f"duration={reached / 1000 + 3}")
    steps = list(frames(out / "trajectory.lammpsdump"))
    assert steps == list(range(0, reached + 3001, 30))

"""`narrows sweep` and `narrows status` as a user types them."""

import json
import os
import shlex
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from lammps_inputs import make_scene
from srd_driver import Simulation
from tests.conftest import ROOT, Run
from tests.dumps import frames

TINY = ["--set", "length=20", "--set", "colloids=1", "--set", "equilibration=0"]
SHORT = [*TINY, "--set", "duration=1.2", "--set", "sampling_interval=0.15"]
LONG = [*TINY, "--set", "duration=600"]


def wait_for(happens: Callable[[], bool]) -> None:
    end = time.monotonic() + 300
    while not happens():
        assert time.monotonic() < end
        time.sleep(0.05)


def start(*words: str | Path) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "narrows", *map(str, words)],
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=heed_interrupts,
    )


def heed_interrupts() -> None:
    """Of a test run in the background of a shell, which its processes would ignore else."""
    signal.signal(signal.SIGINT, signal.default_int_handler)


def checkpointed(folder: Path) -> bool:
    progress = folder / "progress.json"
    return progress.exists() and json.loads(progress.read_text())["step"] > 0


def pid(folder: Path) -> int:
    return int((folder / ".lock").read_text().split()[1])


def test_a_sweep_leaves_runs_and_a_table_and_may_be_extended(tmp_path: Path, command: Run) -> None:
    out = tmp_path / "s"
    words = ["sweep", "channel", "--out", out, *SHORT]
    done = command("narrows", *words, "--over", "gravity=0.2")
    assert done.stderr == ""
    assert done.stdout == f"{out}: 1 of 1 runs finished; 1 points in {out / 'table.csv'}\n"
    before = (out / "gravity=0.2,seed=1" / "summary.json").stat().st_mtime_ns
    command("narrows", *words, "--over", "gravity=0.1,0.2")
    assert (out / "gravity=0.2,seed=1" / "summary.json").stat().st_mtime_ns == before
    rows = (out / "table.csv").read_text().splitlines()
    assert rows[0].startswith("gravity,repeats,temperature,temperature_error,")
    assert [row.split(",")[:2] for row in rows[1:]] == [["0.1", "1"], ["0.2", "1"]]
    told = command("narrows", "status", out).stdout.splitlines()
    assert told[0].split()[:6] == ["gravity=0.2,seed=1", "finished", "1.2", "of", "1.2", "t0"]
    assert told[-1] == "2 runs: 2 finished"


def test_the_commands_make_the_same_runs(tmp_path: Path, command: Run) -> None:
    words = ["sweep", "channel", "--over", "hydrodynamics=on,bath", *SHORT, "--jobs", "2"]
    words += ["--engine", "reference", "--set", "duration=0.45", "--out", "it's here"]
    command("narrows", *words, "--commands", "jobs.txt", cwd=tmp_path)
    assert [path.name for path in (tmp_path / "it's here").iterdir()] == ["sweep.json"]
    environment = {"PYTHONPATH": str(ROOT), "PATH": "/usr/bin:/bin"}
    subprocess.run(["bash", "-e", "jobs.txt"], cwd=tmp_path, check=True, env=environment)
    done = command("narrows", "analyze", "it's here", cwd=tmp_path)
    assert done.stdout.startswith("written: it's here/table.csv: 2 points from 2 of 2 runs")
    for solvent in ("on", "bath"):
        fields = {"length": 20, "colloids": 1, "equilibration": 0, "sampling_interval": 0.15}
        scene = make_scene("channel", **fields, duration=0.45, hydrodynamics=solvent)
        folder = tmp_path / "it's here" / f"hydrodynamics={solvent},seed=1"
        with Simulation(scene, "reference", tmp_path / solvent) as simulation:
            simulation.finish()
        for file in ("trajectory.lammpsdump", "observables.dat", "scene.toml"):
            assert (folder / file).read_bytes() == (tmp_path / solvent / file).read_bytes()
    nothing = command("narrows", *words, "--commands", "-", cwd=tmp_path)
    assert nothing.stdout == ""


def test_a_command_names_every_field_that_is_not_the_default(tmp_path: Path, command: Run) -> None:
    fields = ["gravity=1e-05", "spacing=6.5", "duration=1000.0", "hydrodynamics=shuffle"]
    settings = [word for field in fields for word in ("--set", field)]
    out = tmp_path / "a b"
    done = command("narrows", "sweep", "channel", "--out", out, *settings, "--commands", "-")
    (line,) = done.stdout.splitlines()
    words = shlex.split(line)[3:]
    given = [words[n + 1] for n, word in enumerate(words) if word == "--set"]
    assert "duration=1000.0" in given  # always: the run directory may hold a shorter run
    assert sorted(given) == sorted(fields)
    assert words[:3] == ["run", "channel", "--engine"]
    assert words[-3:] == ["--out", str(out / "seed=1"), "--resume"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--over", "gravity=0.1", "--over", "width=3,10"], "point gravity=0.1,width=3: width = 3"),
        (["--over", "gravity"], "--over 'gravity': must have the form field=value,value,..."),
        (["--over", "gravity=1", "--over", "gravity=2"], "--over 'gravity=2': gravity is swept al"),
        (["--over", "gravity=1", "--set", "gravity=2"], "gravity = 2: is swept by --over; give"),
        (["--over", "seed=1,2", "--repeats", "2"], "repeats = 2: must be 1 where the seed is sw"),
    ],
)
def test_bad_points_are_refused_before_anything_runs(
    arguments: list[str], message: str, tmp_path: Path, command: Run
) -> None:
    out = tmp_path / "s"
    done = command("narrows", "sweep", "channel", *arguments, "--out", out, succeed=False)
    assert done.returncode == 2
    assert done.stderr.startswith(f"narrows: {message}")
    assert done.stdout == ""
    assert not out.exists()


def test_a_killed_run_is_named_and_the_next_time_goes_on(tmp_path: Path, command: Run) -> None:
    out = tmp_path / "s"
    words = ["sweep", "channel", "--repeats", "2", "--jobs", "2", *LONG, "--out", str(out)]
    killed, other = out / "seed=1", out / "seed=2"
    sweep = start(*words)
    wait_for(lambda: checkpointed(killed))
    assert command("narrows", "status", killed).stdout.split()[1] == "running"
    os.kill(pid(killed), signal.SIGKILL)
    stdout, stderr = sweep.communicate(timeout=300)
    assert sweep.returncode == 1
    assert stdout.startswith(f"{out}: 1 of 2 runs finished; 1 points in ")
    assert stderr.endswith(f"narrows: seed=1: killed by SIGKILL (its output: {killed}.log)\n")
    told = command("narrows", "status", out).stdout.splitlines()
    assert told[0].split()[1] == "failed"
    assert told[0].endswith("killed by SIGKILL")
    assert told[1].split()[1] == "finished"
    reached = json.loads((killed / "progress.json").read_text())["step"]
    assert 0 < reached < 600_000
    before = (other / "observables.dat").stat().st_mtime_ns
    command("narrows", *words)
    assert (other / "observables.dat").stat().st_mtime_ns == before
    steps = list(frames(killed / "trajectory.lammpsdump"))
    assert steps == list(range(0, steps[-1] + 1, 750))
    assert steps[-1] >= 600_000
    assert not killed.with_name("seed=1.log").exists()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupt_leaves_checkpoints(
    number: signal.Signals, tmp_path: Path, command: Run
) -> None:
    out = tmp_path / "s"
    words = ["sweep", "channel", "--repeats", "3", "--jobs", "2", *TINY, "--out", str(out)]
    sweep = start(*words)
    wait_for(lambda: checkpointed(out / "seed=1") and checkpointed(out / "seed=2"))
    children = [pid(out / "seed=1"), pid(out / "seed=2")]
    sweep.send_signal(number)
    _, stderr = sweep.communicate(timeout=300)
    assert sweep.returncode == 130
    assert stderr.endswith(  # lines of progress may be before it
        "narrows: interrupted: 0 of 3 runs are finished; give the same command again to go on\n"
    )
    for child in children:
        with pytest.raises(ProcessLookupError):
            os.kill(child, 0)
    told = command("narrows", "status", out).stdout.splitlines()
    assert [line.split()[1] for line in told[:3]] == ["stopped", "stopped", "waiting"]
    for name in ("seed=1", "seed=2"):
        reached = json.loads((out / name / "progress.json").read_text())["step"]
        assert reached >= list(frames(out / name / "trajectory.lammpsdump"))[-1]


def test_a_sweep_is_not_given_under_mpirun(tmp_path: Path, command: Run) -> None:
    words = ["-m", "narrows", "sweep", "channel", "--out", str(tmp_path / "s"), *SHORT]
    refused = command("mpirun", "-np", "2", "python", *words, succeed=False)
    assert "give it without mpirun" in refused.stderr
    command("mpirun", "-np", "1", "python", *words)
    assert (tmp_path / "s" / "table.csv").exists()

"""Runs and sweeps that are killed at random end byte for byte like those that nobody disturbed.

`pytest -m fuzz tests/fuzz/test_kills.py` makes NARROWS_KILLS of them, 100 if it does not say, with
a seed that it prints; without the marker there are a few.
"""

import os
import random
import resource
import shutil
import signal
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import pytest

import lammps_plugin
from run_files.progress import is_begun, read_progress
from tests.conftest import COMMANDS, ROOT

pytestmark = pytest.mark.skipif(not lammps_plugin.folder(), reason="the plugin is not built")

OUTPUTS = (
    *("trajectory.lammpsdump", "observables.dat", "fluid_profile.dat"),
    *("colors.dat", "reactions.dat", "speeds.dat"),
)
KILLS = int(os.environ.get("NARROWS_KILLS", "100"))
DURATION = 30
FIELDS = {"length": 24, "equilibration": 0, "gravity": 1, "duration": DURATION}
ENVIRONMENT = os.environ | {
    "PYTHONPATH": str(ROOT),
    "PATH": f"{COMMANDS}:/usr/bin:/bin",
    "OMP_NUM_THREADS": "1",
}
LANES: Mapping[str, object] = {
    "particles": 224,
    "density": 0.75,
    "rest": 2,
    "sampling_interval": 0.75,
    "duration": 90,
}
OTHERS: dict[str, tuple[str, Mapping[str, object]]] = {  # scene and fields
    "cell": (
        "claylike",
        {"cells": 6, "density": 10, "md_steps_per_collision": 150, "duration": 150, "peclet": 1},
    ),
    "reflection": (
        "claylike",
        {
            "coupling": "reflection",
            "cells": 15,
            "potential": "hertz",
            "duration": 60,
            "peclet": 1,
        },
    ),
    "large fluid": (
        "poiseuille",
        {"length": 110, "width": 100, "gravity": 1e-5, "sampling_interval": 1.5, "duration": 90},
    ),
    "spheres": ("pore", {"particles": 3000, "sampling_interval": 0.75, "duration": 90}),
    "langevin": ("lanes", {**LANES, "thermostat": "langevin"}),
    "dissipative pairs": ("lanes", {**LANES, "thermostat": "dpd"}),
}
RANKS = {"1 rank": 1, "2 ranks": 2, **dict.fromkeys(OTHERS, 1)}
LONGEST = 120.0  # seconds until a run that was killed has a process that ended


def settings(fields: Mapping[str, object]) -> list[str]:
    return [word for item in fields.items() for word in ("--set", "{}={}".format(*item))]


def run_command(directory: Path, interval: float, name: str) -> list[str]:
    ranks = RANKS[name]
    mpi = [str(COMMANDS / "mpirun"), "-np", str(ranks)] if ranks > 1 else []
    scene, fields = OTHERS.get(name, ("channel", FIELDS))
    words = ["run", scene, *settings({"equilibration": 0} | dict(fields))]
    words += ["--checkpoint-interval", str(interval), "--resume"]
    return [*mpi, sys.executable, "-m", "narrows", *words, "--out", str(directory)]


def sweep_command(directory: Path) -> list[str]:
    words = ["sweep", "channel", *settings(FIELDS), "--over", "gravity=0.5,1", "--jobs", "2"]
    del words[words.index("gravity=1") - 1 : words.index("gravity=1") + 1]
    return [sys.executable, "-m", "narrows", *words, "--out", str(directory)]


def disturbed(command: list[str], kind: str, seconds: float, room: int, directory: Path) -> int:
    """Give a command, and disturb it after some time [s], or by files that cannot grow; its code.

    A full disk is a limit on the size of files: writing beyond it fails alike.
    """

    def small_disk() -> None:
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (room, resource.RLIM_INFINITY))

    process = subprocess.Popen(
        command,
        env=ENVIRONMENT,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        preexec_fn=small_disk if kind == "disk" else None,
    )
    try:
        if kind != "disk":
            process.wait(seconds)
    except subprocess.TimeoutExpired:
        if kind == "SIGKILL":
            os.killpg(process.pid, signal.SIGKILL)
        else:
            process.send_signal(signal.Signals[kind])
    try:
        _, said = process.communicate(timeout=LONGEST)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        raise AssertionError(f"{kind} after {seconds:.2f} s: the run did not end") from None
    finally:
        _kill_workers(directory)
    while_it_is_imported = kind == "SIGINT" and said.rstrip().endswith("KeyboardInterrupt")
    assert "Traceback" not in said or while_it_is_imported, said
    return process.returncode


def _kill_workers(directory: Path) -> None:
    """What a sweep left when it was killed at once goes on; it must be gone for the next one."""
    for lock in directory.rglob(".lock"):
        words = lock.read_text().split()
        if len(words) > 1:
            try:
                command = Path(f"/proc/{words[1]}/cmdline").read_bytes()
                if str(directory).encode() in command:
                    os.kill(int(words[1]), signal.SIGKILL)
            except (OSError, ValueError):
                continue


def outputs(directory: Path) -> dict[str, bytes]:
    files = sorted(file for name in OUTPUTS for file in directory.rglob(name))
    return {str(file.relative_to(directory)): file.read_bytes() for file in files}


def wholly(command: list[str]) -> None:
    done = subprocess.run(command, env=ENVIRONMENT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def kills(count: int, chance: random.Random, folder: Path, names: list[str]) -> dict[str, int]:
    """That many disturbances, several to a run; how many there were of each kind."""
    whole: dict[str, dict[str, bytes]] = {}
    for name in dict.fromkeys(names):
        command = (
            sweep_command(folder / f"whole {name}")
            if name == "sweep"
            else run_command(folder / f"whole {name}", 20.0, name)
        )
        wholly(command)
        whole[name] = outputs(Path(command[-1]))
        assert whole[name]
    done: dict[str, int] = {}
    number = 0
    while sum(done.values()) < count:
        number += 1
        name = chance.choice(names)
        directory = folder / f"run {number}"
        for _ in range(chance.randrange(1, 5)):
            kind = chance.choice(["SIGKILL", "SIGKILL", "SIGTERM", "SIGINT", "disk"])
            if name == "sweep" and kind == "disk":
                kind = "SIGTERM"
            interval = chance.choice([0.75, 1.5, 3.0, 7.5, 20.0, 1000.0])
            command = (
                sweep_command(directory)
                if name == "sweep"
                else run_command(directory, interval, name)
            )
            size = max(map(len, whole[name].values()))
            room = chance.randrange(1000, 2 * size)
            disturbed(command, kind, chance.uniform(0.3, 4.0), room, directory)
            done[f"{kind}, {name}"] = done.get(f"{kind}, {name}", 0) + 1
        wholly(command)
        assert outputs(directory) == whole[name], (name, number, done)
        if name != "sweep":
            assert is_begun(directory)
            assert read_progress(directory).finished
        shutil.rmtree(directory)
        print(f"run {number}, {name}: {sum(done.values())} kills so far", flush=True)
    return done


def test_a_few_kills_leave_no_trace(tmp_path: Path) -> None:
    kills(3, random.Random(3), tmp_path, ["1 rank"])


def test_a_few_kills_of_spheres_leave_no_trace(tmp_path: Path) -> None:
    kills(2, random.Random(4), tmp_path, ["spheres"])


@pytest.mark.fuzz
def test_many_kills_leave_no_trace(tmp_path: Path) -> None:
    seed = int(os.environ.get("NARROWS_KILLS_SEED", str(random.SystemRandom().randrange(10**6))))
    print(f"NARROWS_KILLS_SEED={seed}")
    names = ["1 rank", "1 rank", "1 rank", "2 ranks", "sweep", *OTHERS]
    done = kills(KILLS, random.Random(seed), tmp_path, names)
    print("\n".join(f"{kind}: {count}" for kind, count in sorted(done.items())))

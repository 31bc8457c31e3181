"""The plugin's readers of fluids and restarts under the sanitizers, given damage."""

import random
import shutil
import subprocess
from pathlib import Path

import pytest

from tests.conftest import ROOT


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    compiler = shutil.which("g++") or shutil.which("clang++")
    if compiler is None:
        pytest.skip("no C++ compiler")
    program = tmp_path_factory.mktemp("readers") / "fuzz_readers"
    flags = ["-std=c++17", "-Wall", "-Wextra", "-Werror", "-O1", "-g"]
    sanitizers = ["-fsanitize=address,undefined", "-fno-sanitize-recover=all"]
    core = f"-I{ROOT / 'lammps_plugin' / 'core'}"
    source = str(Path(__file__).parent / "fuzz_readers.cpp")
    subprocess.run([compiler, *flags, *sanitizers, core, source, "-o", program], check=True)
    return program


def check(program: Path, cases: int, seed: int) -> None:
    words = [str(program), str(cases), str(seed)]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    print(seed, done.stdout)
    assert done.returncode == 0, f"seed {seed}: {done.stdout}{done.stderr[:3000]}"


def test_damaged_fluids_and_restarts_are_refused(program: Path) -> None:
    check(program, 5000, 1)


@pytest.mark.fuzz
def test_many_damaged_fluids_and_restarts_are_refused(program: Path) -> None:
    check(program, 2_000_000, random.SystemRandom().randrange(10**6))

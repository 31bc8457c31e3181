"""The core's own test program, optimised as in the plugin and under the sanitizers."""

import shutil
import subprocess
from pathlib import Path

import pytest

from tests.conftest import ROOT

BUILDS = {
    "sanitizers": ["-O1", "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"],
    "as built": ["-O3", "-march=native", "-fno-math-errno", "-fno-trapping-math"],
}


@pytest.mark.parametrize("build", BUILDS)
def test_core(build: str, tmp_path: Path) -> None:
    compiler = shutil.which("g++") or shutil.which("clang++")
    if compiler is None:
        pytest.skip("no C++ compiler")
    program = tmp_path / "core_tests"
    sources = [
        f"-I{ROOT / 'lammps_plugin' / 'core'}",
        str(Path(__file__).parent / "core_tests.cpp"),
    ]
    warnings = ["-std=c++17", "-Wall", "-Wextra", "-Werror", "-Wno-psabi", "-ffp-contract=off"]
    subprocess.run([compiler, *warnings, *BUILDS[build], *sources, "-o", program], check=True)
    done = subprocess.run([program], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr

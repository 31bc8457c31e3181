"""The plugin leaves its styles out of a LAMMPS that it was not built for, and says so."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.conftest import COMMANDS

REFUSAL = "this is LAMMPS 20991231: its styles are left out"
LISTING = """
from mpi4py import MPI
from lammps import lammps
instance = lammps(cmdargs=["-log", "none"])
print("ours:", [s for s in instance.available_styles("fix") if s in ("mpc", "wall/lj115")])
instance.commands_string("region box block 0 1 0 1 0 1\\ncreate_box 1 box")
instance.close()
"""


@pytest.fixture
def later(tmp_path: Path) -> dict[str, str]:
    """An environment in which LAMMPS tells plugins that it is of the last day of 2099."""
    compiler = shutil.which("g++") or shutil.which("clang++")
    if compiler is None or sys.platform != "linux":
        pytest.skip("needs a C++ compiler, and a loader that knows LD_PRELOAD")
    source = tmp_path / "later.cpp"
    source.write_text('extern "C" int lammps_version(void *) { return 20991231; }')
    library = tmp_path / "later.so"
    subprocess.run([compiler, "-shared", "-fPIC", source, "-o", library], check=True)
    return {"PATH": os.environ["PATH"], "LD_PRELOAD": str(library)}


def run(words: list[str], folder: Path, environment: dict[str, str]) -> tuple[int, list[str]]:
    """The exit code, and the lines on the screen."""
    done = subprocess.run(words, cwd=folder, env=environment, capture_output=True, text=True)
    return done.returncode, done.stdout.splitlines()


def test_import_lammps_goes_on_without_the_styles(tmp_path: Path, later: dict[str, str]) -> None:
    words = [sys.executable, "-c", LISTING]
    code, lines = run(words, tmp_path, later)
    assert code == 0
    assert len([line for line in lines if line.endswith(REFUSAL)]) == 1
    assert "ours: []" in lines
    code, lines = run(words, tmp_path, {"PATH": os.environ["PATH"]})
    assert not any(REFUSAL in line for line in lines)
    assert "ours: ['mpc', 'wall/lj115']" in lines


@pytest.mark.parametrize("style", ["mpc", "wall/lj115"])
def test_lmp_names_the_missing_style(style: str, tmp_path: Path, later: dict[str, str]) -> None:
    box = "region box block 0 4 0 4 0 4\ncreate_box 1 box\n"
    (tmp_path / "in.box").write_text(box)
    (tmp_path / "in.style").write_text(f"{box}fix 1 all {style}\n")
    lmp = [str(COMMANDS / "lmp"), "-log", "none", "-in"]
    code, lines = run([*lmp, "in.box"], tmp_path, later)
    assert code == 0
    assert len([line for line in lines if line.endswith(REFUSAL)]) == 1
    code, lines = run([*lmp, "in.style"], tmp_path, later)
    assert code == 1  # an error of LAMMPS, no signal
    assert any(f"Unrecognized fix style '{style}'" in line for line in lines)

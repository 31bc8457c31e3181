"""What tests of several packages share: commands of this environment, run as a user would."""

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import hypothesis
import pytest

hypothesis.settings.register_profile("ci", derandomize=True, deadline=None)
if os.environ.get("CI"):
    hypothesis.settings.load_profile("ci")

COMMANDS = Path(sys.executable).parent
ROOT = Path(__file__).parent.parent
PASSED_ON = ("NARROWS_SCENES",)

Run = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture
def command() -> Run:
    """Run a command of this environment, by default for success; output captured as text."""

    def run(
        *words: str | Path, cwd: Path | None = None, succeed: bool = True
    ) -> subprocess.CompletedProcess[str]:
        program, *arguments = map(str, words)
        if program == "narrows":
            line = [sys.executable, "-m", "narrows", *arguments]
        elif program == "mpirun":
            inner = [str(COMMANDS / a) if a in ("lmp", "python") else a for a in arguments]
            line = [str(COMMANDS / program), *inner]
        else:
            line = [str(COMMANDS / program), *arguments]
        environment = {"PYTHONPATH": str(ROOT), "PATH": f"{COMMANDS}:/usr/bin:/bin"}
        environment |= {name: os.environ[name] for name in PASSED_ON if name in os.environ}
        done = subprocess.run(
            line, cwd=cwd, env=environment, capture_output=True, text=True, check=False
        )
        if succeed and done.returncode != 0:
            raise AssertionError(f"{line} failed: {done.stdout}\n{done.stderr}")
        return done

    return run


@pytest.fixture(autouse=True)
def no_open_figures() -> Iterator[None]:
    """Figures that a test leaves open would be counted by the next one in its process."""
    yield
    if pyplot := sys.modules.get("matplotlib.pyplot"):
        pyplot.close("all")

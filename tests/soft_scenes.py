"""Small driven mixtures and sheared fluids, run whole, or killed and resumed."""

import json
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

from lammps_inputs import Scene, make_scene
from lammps_inputs.engines import default_engine
from srd_driver import Simulation
from tests.conftest import ROOT

SMALL = {
    "particles": 120,
    "density": 0.75,
    "rest": 2.0,
    "sampling_interval": 0.25,
    "equilibration": 0.5,
    "duration": 7.5,
}


def lanes(**fields: Any) -> Scene:
    return make_scene("lanes", **(SMALL | {"field": 1.5} | fields))


def shear(**fields: Any) -> Scene:
    return make_scene("shear", **(SMALL | {"dimension": 2, "rate": 1.5} | fields))


def finish(scene: Scene, folder: Path) -> Path:
    with Simulation(scene, default_engine(scene.system), folder) as simulation:
        simulation.finish()
    return folder


def rows(folder: Path, file: str) -> list[str]:
    """Without titles, which LAMMPS repeats when it goes on."""
    return [line for line in (folder / file).read_text().splitlines() if not line.startswith("#")]


def killed_and_resumed(scene: Scene, folder: Path) -> Path:
    """A run in another process, killed amid its work, that goes on here."""
    code = (
        "import sys, json, lammps_inputs; from srd_driver import Simulation\n"
        "scene = lammps_inputs.make_scene(sys.argv[2], **json.loads(sys.argv[3]))\n"
        "Simulation(scene, sys.argv[4], sys.argv[1], checkpoint_interval=1.0).finish()"
    )
    engine = default_engine(scene.system)
    words = [str(folder), scene.name, scene.model_dump_json(), engine]
    process = subprocess.Popen([sys.executable, "-c", code, *words], cwd=ROOT)
    progress = folder / "progress.json"
    while process.poll() is None:
        if progress.exists() and json.loads(progress.read_text())["step"] > 0:
            process.send_signal(signal.SIGKILL)
        time.sleep(0.003)
    assert process.returncode == -signal.SIGKILL, "killed before its end"
    with Simulation(scene, engine, folder, resume=True) as simulation:
        assert simulation.step > 0
        simulation.finish()
    return folder

"""One run of many, in a process of its own: `python -m srd_driver.worker JSON`.

The JSON holds `directory`, `scene`, `engine` and `fields`. What stops the run goes to stderr in one
line, and into the run directory.
"""

import json
import sys
from pathlib import Path
from typing import Any

from lammps_inputs import Scene, SceneError, make_scene
from run_files import RunDirectoryError
from srd_driver.errors import RunError
from srd_driver.signals import stopped_by_signals
from srd_driver.simulation import Simulation


def command(directory: Path, scene: Scene, engine: str) -> list[str]:
    """The command that begins the run or goes on with it; it may be given again and again."""
    task = {
        "directory": str(directory),
        "scene": scene.name,
        "engine": engine,
        "fields": scene.model_dump(mode="json"),
    }
    return [sys.executable, "-m", __name__, json.dumps(task)]


def main(text: str) -> int:
    """Run to the end; the exit code."""
    task: dict[str, Any] = json.loads(text)
    try:
        scene = make_scene(task["scene"], **task["fields"])
        with (
            Simulation(scene, task["engine"], task["directory"], resume=True) as simulation,
            stopped_by_signals(simulation),
        ):
            simulation.finish()
            return 0 if simulation.finished else 130
    except (RunError, SceneError, RunDirectoryError, OSError) as error:
        print(" ".join(str(error).split()), file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))

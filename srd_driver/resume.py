"""A run directory, begun and resumed: what is in it is never lost, and never another run's."""

import json
import os
import shlex
import sys
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, TextIO

from lammps_inputs import Scene
from lammps_inputs.deck import check_engine, has_deck, script, write_deck
from lammps_inputs.manifest import manifest
from run_files.cutting import cut_output
from run_files.manifest import NAME as MANIFEST
from run_files.manifest import read_manifest
from run_files.progress import FAILURE, Progress, is_begun, read_progress, write_progress
from run_files.reading import read_toml
from run_files.writing import replace_text
from srd_driver import run_lock
from srd_driver.errors import RunError

CHANGEABLE = {"duration"}  # a run may be resumed to last longer
SCENE = "scene.toml"


def take(directory: Path, resume: bool) -> TextIO:
    """Take the directory, made if it is missing, for this process until the file is closed.

    Raises:
        RunError: when another process runs there, when it is not empty and not to be resumed, or
            holds no run, or cannot be written.
    """
    try:
        directory.mkdir(parents=True, exist_ok=True)
        if not resume:
            _require_empty(directory)
        elif any(directory.iterdir()) and not (is_begun(directory) or is_half_made(directory)):
            stored_fields(directory)
            raise RunError(f"{directory} is not a run directory: it has no progress.json")
        held = run_lock.lock(directory)
        if not resume:
            _require_empty(directory)  # another process may have been quicker
    except OSError as error:
        raise RunError(f"cannot write {directory}: {error.strerror or error}") from None
    return held


def _require_empty(directory: Path) -> None:
    if any(path.name != run_lock.LOCK for path in directory.iterdir()):
        raise RunError(
            f"{directory} is not empty: go on with its run by --resume, or choose another"
        )


def create(scene: Scene, engine: str, directory: Path, ranks: int) -> Progress:
    """Write the run directory of a new run; over one that a kill left half made.

    Raises:
        SceneError: when the engine cannot run the scene.
        RunError: when the directory cannot be written.
    """
    try:
        check_engine(scene, engine)
        write_scene(scene, engine, directory, ranks)
        if has_deck(engine):
            write_deck(scene, directory, engine)
        return write_progress(directory, Progress())
    except OSError as error:
        raise RunError(f"cannot write {directory}: {error.strerror or error}") from None


def reopen(scene: Scene, engine: str, directory: Path, ranks: int) -> Progress:
    """Take up a run at its newest checkpoint: output written after it is cut off.

    Raises:
        RunError: when the directory holds a run of another scene or engine.
        RunDirectoryError: when it holds none, or a file of it is damaged.
    """
    refuse_another_scene(scene, engine, directory)
    progress = read_progress(directory)
    (directory / FAILURE).unlink(missing_ok=True)
    if progress.checkpoint and not (directory / progress.checkpoint).exists():
        raise RunError(f"{directory}: its checkpoint {progress.checkpoint} is missing")
    if progress.step < scene.system.clock.total_steps:
        try:
            write_progress(directory, progress)  # drops a checkpoint that a kill left half written
            for output in scene.system.outputs:
                cut_output(directory / output.file, output.kind, progress.step)
            if has_deck(engine):
                replace_text(directory / "in.lammps", script(scene, engine))
            write_scene(scene, engine, directory, ranks)
        except OSError as error:
            raise RunError(f"cannot write {directory}: {error.strerror or error}") from None
    return progress


def is_half_made(directory: Path) -> bool:
    """Whether a run was being made in the directory when it was killed."""
    return (directory / run_lock.LOCK).is_file() and not is_begun(directory)


def stored_fields(directory: Path) -> dict[str, Any]:
    """The fields of the scene in a run directory, the scene's name as `scene`.

    Raises:
        RunError: when the directory holds no run.
        RunDirectoryError: when the file is damaged.
    """
    if not (directory / SCENE).is_file():
        raise RunError(f"{directory} is not a run directory: it has no {SCENE}")
    return read_toml(directory / SCENE)


def newest_step(directory: Path) -> int:
    """The last step that the run in the directory has written of, after its newest checkpoint.

    Raises:
        RunDirectoryError: when the directory holds no run.
    """
    step = read_progress(directory).step
    tables = [output.file for output in read_manifest(directory).system.outputs]
    for name in tables:
        if name.endswith(".dat") and (directory / name).is_file():
            step = max(step, _last_label(directory / name))
    return step


def _last_label(path: Path) -> int:
    """The step of the last complete row that has one."""
    with path.open("rb") as file:
        file.seek(max(0, os.fstat(file.fileno()).st_size - 1024))
        rows = file.read().split(b"\n")[1:-1]  # what lies between two line ends is whole
    labels = [row.split()[0] for row in rows if row[:1].isdigit()]
    return int(labels[-1]) if labels and labels[-1].isdigit() else 0


def refuse_another_scene(scene: Scene, engine: str, directory: Path) -> None:
    """Let only the scene and engine of a run directory pass; its duration may change.

    Raises:
        RunError: when the directory holds one of another scene or engine.
        RunDirectoryError: when it holds none.
    """
    there = read_manifest(directory)
    if there.scene != scene.name:
        raise RunError(f"{directory} holds another scene than {scene.name}")
    if there.engine != engine:
        raise RunError(f"{directory} was run by the engine {there.engine}, not {engine}")
    asked = json.loads(scene.model_dump_json())
    other = [
        f"{field} = {there.fields.get(field)!r} there, {asked[field]!r} here"
        for field in asked
        if field not in CHANGEABLE and there.fields.get(field) != asked[field]
    ]
    if other:
        raise RunError(f"{directory} holds another scene: " + "; ".join(other))


def write_scene(scene: Scene, engine: str, directory: Path, ranks: int = 1) -> None:
    """Write scene.toml and manifest.json.

    Raises:
        SceneError: when the engine cannot run the scene.
    """
    versions = {"python": sys.version.split()[0]}
    for name in ("narrows", "lammps", "numpy", "mpi4py", "mpich"):
        try:
            versions[name] = version(name)
        except PackageNotFoundError:
            continue
    command = shlex.join([Path(sys.argv[0]).name, *sys.argv[1:]])
    content = manifest(scene, engine) | {"versions": versions, "command": command, "ranks": ranks}
    replace_text(directory / SCENE, scene.toml())
    replace_text(directory / MANIFEST, json.dumps(content, indent=2) + "\n")

"""A run directory, begun and resumed: what is in it is never lost, and never another run's."""

import json
import os
import shlex
import shutil
import sys
from collections.abc import Iterable
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, TextIO

from lammps_inputs import Scene
from lammps_inputs.deck import check_engine, has_deck, script, write_deck
from lammps_inputs.manifest import manifest
from run_files.checksums import Checksum, GrowingFile
from run_files.cutting import cut_output, kept_bytes
from run_files.manifest import CHANGEABLE, SCENE, read_manifest
from run_files.manifest import NAME as MANIFEST
from run_files.names import is_checkpoint
from run_files.progress import (
    FAILURE,
    FORMAT,
    Progress,
    is_begun,
    read_progress,
    write_progress,
)
from run_files.progress import NAME as PROGRESS
from run_files.reading import refuse
from run_files.writing import draft_of, replace_json, replace_text
from srd_driver import run_lock
from srd_driver.engines import checkpoint_suffix
from srd_driver.errors import RunError

SCRIPT = "in.lammps"
MAKING = ".making"  # a folder for what the engine makes before a run begins


def take(directory: Path, resume: bool) -> TextIO:
    """Take the directory, made if it is missing, for this process until the file is closed.

    Raises:
        RunError: when another process runs there, when it is not empty and not to be resumed, or
            holds no run, or cannot be written.
    """
    require = _require_run if resume else _require_empty
    try:
        directory.mkdir(parents=True, exist_ok=True)
        require(directory)
        held = run_lock.lock(directory)
        require(directory)  # another process may have been quicker
    except OSError as error:
        raise RunError(f"cannot write {directory}: {error.strerror or error}") from None
    return held


def _require_empty(directory: Path) -> None:
    if any(path.name != run_lock.LOCK for path in directory.iterdir()):
        raise RunError(
            f"{directory} is not empty: go on with its run by --resume (in Python resume=True), or "
            "choose another"
        )


def _require_run(directory: Path) -> None:
    if any(directory.iterdir()) and not (is_begun(directory) or is_half_made(directory)):
        stored_fields(directory)
        raise RunError(f"{directory} is not a run directory: it has no {PROGRESS}")


def create(scene: Scene, engine: str, directory: Path, ranks: int) -> Progress:
    """Write the run directory of a new run, or the rest of one that a kill left half made.

    What the run is comes first and whole, so that half a directory tells it. What the engine makes
    is put together in a folder of its own: nothing else may be there.

    Raises:
        SceneError: when the engine cannot run the scene.
        RunError: when the directory cannot be written, is that of another scene or engine, or holds
            what may be data.
        RunDirectoryError: when what there is of it is damaged.
    """
    check_engine(scene, engine)
    if tells_scene(directory):
        refuse_another_scene(scene, engine, directory)
    making = directory / MAKING
    shutil.rmtree(making, ignore_errors=True)
    try:
        making.mkdir()
        if has_deck(engine):
            write_deck(scene, making, engine)
        made = sorted(path.name for path in making.iterdir())
        _require_nothing_but(directory, made)
        write_scene(scene, engine, directory, ranks)
        for name in made:
            os.replace(making / name, directory / name)
        read = {name: Checksum.of_file(directory / name) for name in made if name != SCRIPT}
        progress = Progress(format=FORMAT, run=identity(scene, engine), checksums=read)
        return write_progress(directory, progress)
    except OSError as error:
        raise RunError(f"cannot write {directory}: {error.strerror or error}") from None
    finally:
        shutil.rmtree(making, ignore_errors=True)


def _require_nothing_but(directory: Path, made: Iterable[str]) -> None:
    replaced = [directory / name for name in (SCENE, MANIFEST, PROGRESS)]
    known = {run_lock.LOCK, MAKING, *made}
    known |= {each.name for path in replaced for each in (path, draft_of(path))}
    others = sorted(path.name for path in directory.iterdir() if path.name not in known)
    if others:
        raise RunError(
            f"{directory} has no {PROGRESS} but {', '.join(others)}: nothing is begun over what "
            f"may be data; put {PROGRESS} back, or choose another directory"
        )


def reopen(scene: Scene, engine: str, directory: Path, ranks: int) -> Progress:
    """Take up a run at its newest checkpoint: output written after it is cut off.

    Raises:
        RunError: when the directory holds a run of another scene or engine.
        RunDirectoryError: when it holds none, or a file of it is damaged.
    """
    refuse_another_scene(scene, engine, directory)
    progress = read_progress(directory)
    if progress.checkpoint:
        suffix = checkpoint_suffix(engine)
        if not is_checkpoint(progress.checkpoint, progress.step, suffix):
            refuse(directory / PROGRESS, f"checkpoint {progress.checkpoint}: not one of {engine}")
        if not (directory / progress.checkpoint).is_file():
            raise RunError(f"{directory}: its checkpoint {progress.checkpoint} is missing")
    if progress.run not in (None, identity(scene, engine)):
        refuse(directory / PROGRESS, "of another run: its checkpoint is not taken for this one's")
    if progress.step < scene.system.clock.total_steps:
        for file in progress.checksums:
            progress.require(directory, file)
        kept = _kept(scene, directory, progress)
        progress = progress.model_copy(update={"finished": False, "checksums": kept})
        try:
            (directory / FAILURE).unlink(missing_ok=True)
            write_progress(directory, progress)  # drops a checkpoint that a kill left half written
            for output in scene.system.outputs:
                cut_output(directory / output.file, output.kind, progress.step)
            if has_deck(engine):
                replace_text(directory / SCRIPT, script(scene, engine))
            write_scene(scene, engine, directory, ranks)
        except OSError as error:
            raise RunError(f"cannot write {directory}: {error.strerror or error}") from None
    return progress


def _kept(scene: Scene, directory: Path, progress: Progress) -> dict[str, Checksum]:
    """Checksums of what will be left of the outputs, so that a kill once they are cut does no harm.

    Raises:
        RunDirectoryError: when an output is damaged.
    """
    kept = dict(progress.checksums)
    for output in scene.system.outputs:
        if output.file in kept:
            path = directory / output.file
            size = kept_bytes(path, output.kind, progress.step)
            kept[output.file] = GrowingFile(path).checksum(size)
    return kept


def is_half_made(directory: Path) -> bool:
    """Whether a run was being made in the directory when it was killed, or lost its progress."""
    return (directory / run_lock.LOCK).is_file() and not is_begun(directory)


def tells_scene(directory: Path) -> bool:
    """Whether the directory belongs to a scene and engine, begun or not."""
    return (directory / MANIFEST).is_file()


def stored_fields(directory: Path) -> dict[str, Any]:
    """The fields of the scene in a run directory, the scene's name as `scene`.

    From its manifest, which its scene file must not contradict.

    Raises:
        RunError: when the directory holds no run.
        RunDirectoryError: when the file is damaged.
    """
    if not tells_scene(directory):
        raise RunError(f"{directory} is not a run directory: it has no {MANIFEST}")
    told = read_manifest(directory)
    return {**told.fields, "scene": told.scene}


def newest_step(directory: Path) -> int:
    """The last step that the run in the directory has written of, after its newest checkpoint.

    Raises:
        RunDirectoryError: when the directory holds no run.
    """
    return max(read_progress(directory).step, written_step(directory))


def written_step(directory: Path) -> int:
    """The last step that the tables and profiles of a directory tell of; 0 without any.

    Raises:
        RunDirectoryError: when the directory holds no run.
    """
    outputs = read_manifest(directory).system.outputs
    files = [directory / each.file for each in outputs if each.kind != "trajectory"]
    return max((_last_label(file) for file in files if file.is_file()), default=0)


def _last_label(path: Path) -> int:
    """The step of the last complete row that has one."""
    with path.open("rb") as file:
        file.seek(max(0, os.fstat(file.fileno()).st_size - 1024))
        rows = file.read().split(b"\n")[1:-1]  # what lies between two line ends is whole
    labels = [row.split()[0] for row in rows if row[:1].isdigit()]
    return int(labels[-1]) if labels and labels[-1].isdigit() else 0


def identity(scene: Scene, engine: str) -> str:
    """A digest of all that makes a run the run it is: scene, seed and engine."""
    fields = scene.model_dump(mode="json", exclude=CHANGEABLE)
    content = {"scene": scene.name, "engine": engine, "fields": fields}
    return Checksum.of_text(json.dumps(content, sort_keys=True)).digest


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
    """Write manifest.json and scene.toml.

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
    replace_json(directory / MANIFEST, content)
    replace_text(directory / SCENE, scene.toml())

"""The files of a run (docs/run-directory.md): creating, resuming and never losing them."""

import contextlib
import json
import os
import shlex
import sys
import tomllib
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, TextIO

from lammps_inputs import Scene
from lammps_inputs.deck import Engine, manifest, script, write_deck
from srd_driver import run_lock
from srd_driver.errors import RunError

CHANGEABLE = {"duration"}  # a run may be resumed to last longer
FAILURE = "failure.txt"


@dataclass(frozen=True)
class Progress:
    """How far a run got: its newest checkpoint."""

    step: int = 0
    wall_seconds: float = 0.0
    finished: bool = False
    checkpoint: str | None = None


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


def create(scene: Scene, engine: Engine, directory: Path, ranks: int) -> Progress:
    """Write the run directory of a new run; over one that a kill left half made.

    Raises:
        SceneError: when the engine cannot run the scene.
        RunError: when the directory cannot be written.
    """
    try:
        write_deck(scene, directory, engine)
        _write_manifest(scene, engine, directory, ranks)
        return write_progress(directory, Progress())
    except OSError as error:
        raise RunError(f"cannot write {directory}: {error.strerror or error}") from None


def stored_fields(directory: Path) -> dict[str, Any]:
    """The fields of the scene in a run directory, the scene's name as `scene`.

    Raises:
        RunError: when the directory holds no run.
    """
    try:
        return tomllib.loads((directory / "scene.toml").read_text(encoding="utf-8"))
    except (OSError, tomllib.TOMLDecodeError):
        raise RunError(f"{directory} is not a run directory: it has no scene.toml") from None


def stored_engine(directory: Path) -> Engine:
    """The engine that a run directory belongs to.

    Raises:
        RunError: when the directory holds no run.
    """
    engine: Engine = _read_json(directory / "manifest.json", directory)["engine"]
    return engine


def reopen(scene: Scene, engine: Engine, directory: Path, ranks: int) -> Progress:
    """Take up a run at its newest checkpoint: output written after it is cut off.

    Raises:
        RunError: when the directory holds no run, or one of another scene or engine.
    """
    refuse_another_scene(scene, engine, directory)
    progress = read_progress(directory)
    (directory / FAILURE).unlink(missing_ok=True)
    if progress.checkpoint and not (directory / progress.checkpoint).exists():
        raise RunError(f"{directory}: its checkpoint {progress.checkpoint} is missing")
    if progress.step < scene.total_steps:
        try:
            write_progress(directory, progress)  # drops a checkpoint that a kill left half written
            cut_trajectory(directory / "trajectory.lammpsdump", progress.step)
            cut_table(directory / "observables.dat", progress.step)
            cut_table(directory / "fluid_profile.dat", progress.step)
            replace_text(directory / "scene.toml", scene.toml())
            if engine != "reference":
                replace_text(directory / "in.lammps", script(scene, engine))
            _write_manifest(scene, engine, directory, ranks)
        except OSError as error:
            raise RunError(f"cannot write {directory}: {error.strerror or error}") from None
    return progress


def is_begun(directory: Path) -> bool:
    """Whether the directory holds a run; not so one that was killed while it was made."""
    return (directory / "progress.json").is_file()


def is_half_made(directory: Path) -> bool:
    """Whether a run was being made in the directory when it was killed."""
    return (directory / run_lock.LOCK).is_file() and not is_begun(directory)


def read_progress(directory: Path) -> Progress:
    """How far the run in the directory is for sure: its newest checkpoint.

    Raises:
        RunError: when the directory holds no run.
    """
    return Progress(**_read_json(directory / "progress.json", directory))


def newest_step(directory: Path) -> int:
    """The last step that the run in the directory has written of, after its newest checkpoint.

    Raises:
        RunError: when the directory holds no run.
    """
    step = read_progress(directory).step
    try:
        with (directory / "observables.dat").open("rb") as file:
            file.seek(max(0, os.fstat(file.fileno()).st_size - 1024))
            rows = file.read().split(b"\n")[1:-1]  # what lies between two line ends is whole
    except FileNotFoundError:
        return step
    return max([step, *(int(row.split()[0]) for row in rows[-1:] if not row.startswith(b"#"))])


def write_progress(directory: Path, progress: Progress) -> Progress:
    """Record the newest checkpoint, then drop the older ones; safe against a kill at any moment."""
    replace_text(directory / "progress.json", json.dumps(asdict(progress), indent=2) + "\n")
    for old in directory.glob("checkpoint.*"):
        if old.name != progress.checkpoint:
            old.unlink(missing_ok=True)
    return progress


def write_failure(directory: Path, message: str) -> None:
    """Leave word of what stopped the run, if the disk has room for it; resuming removes it."""
    with contextlib.suppress(OSError):
        (directory / FAILURE).write_text(message + "\n", encoding="utf-8")


def read_failure(directory: Path) -> str | None:
    """What stopped the run, if it was an error."""
    try:
        return (directory / FAILURE).read_text(encoding="utf-8").strip()
    except OSError:
        return None


def replace_text(path: Path, text: str) -> None:
    """Write a file so that a reader, or a kill, meets the old text or the new, never half."""
    draft = path.with_name(f".{path.name}.draft")
    draft.write_text(text, encoding="utf-8")
    os.replace(draft, path)


def cut_trajectory(path: Path, step: int) -> None:
    """Drop the frames of a LAMMPS dump from `step` on; the engine writes that one again."""
    if path.exists():
        _truncate(path, _first_frame(path, step))


def cut_table(path: Path, step: int) -> None:
    """Drop what a `fix ave/time` or `fix ave/chunk` file says of steps after `step`."""
    if path.exists():
        _truncate(path, _first_row(path, step))


def _truncate(path: Path, size: int) -> None:
    with path.open("r+b") as file:
        file.truncate(size)


def _lines(path: Path) -> Iterator[tuple[int, bytes]]:
    """The lines of a file, each with the offset it begins at."""
    offset = 0
    with path.open("rb") as file:
        for line in file:
            yield offset, line
            offset += len(line)


def _first_frame(path: Path, step: int) -> int:
    frame: int | None = None
    for offset, line in _lines(path):
        if line.startswith(b"ITEM: TIMESTEP"):
            frame = offset
        elif frame is not None:
            if not line.endswith(b"\n") or int(line) >= step:
                return frame
            frame = None
    return path.stat().st_size if frame is None else frame


def _first_row(path: Path, step: int) -> int:
    for offset, line in _lines(path):
        if not line.endswith(b"\n"):
            return offset
        if not line.startswith((b"#", b" ")) and int(line.split()[0]) > step:
            return offset
    return path.stat().st_size


def refuse_another_scene(scene: Scene, engine: Engine, directory: Path) -> None:
    """Let only the scene and engine of a run directory pass; its duration may change.

    Raises:
        RunError: when the directory holds no run, or one of another scene or engine.
    """
    stored = stored_fields(directory)
    if stored.pop("scene", None) != scene.name:
        raise RunError(f"{directory} holds another scene than {scene.name}")
    there = _read_json(directory / "manifest.json", directory)
    if there["engine"] != engine:
        raise RunError(f"{directory} was run by the engine {there['engine']}, not {engine}")
    asked = scene.model_dump()
    other = [
        f"{field} = {there['fields'].get(field)!r} there, {asked[field]!r} here"
        for field in asked
        if field not in CHANGEABLE and there["fields"].get(field) != asked[field]
    ]
    if other:
        raise RunError(f"{directory} holds another scene: " + "; ".join(other))


def _write_manifest(scene: Scene, engine: Engine, directory: Path, ranks: int) -> None:
    versions = {"python": sys.version.split()[0]}
    for name in ("narrows", "lammps", "numpy", "mpi4py", "mpich"):
        try:
            versions[name] = version(name)
        except PackageNotFoundError:
            continue
    command = shlex.join([Path(sys.argv[0]).name, *sys.argv[1:]])
    content = manifest(scene, engine) | {"versions": versions, "command": command, "ranks": ranks}
    replace_text(directory / "manifest.json", json.dumps(content, indent=2) + "\n")


def _read_json(path: Path, directory: Path) -> dict[str, Any]:
    try:
        content: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, json.JSONDecodeError):
        raise RunError(f"{directory} is not a run directory: it has no {path.name}") from None
    return content

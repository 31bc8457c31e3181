"""`progress.json`: how far a driven run is for sure; and `failure.txt`, what stopped it."""

import contextlib
from pathlib import Path
from typing import Annotated, Final, Literal, Self

from pydantic import Field, model_validator

from run_files.checksums import Checksum
from run_files.names import BESIDE, FileName, is_checkpoint
from run_files.reading import Part, RunDirectoryError, checked, read_json, read_text
from run_files.writing import replace_json, replace_text

NAME = "progress.json"
FORMAT: Final = 2  # of progress.json
FAILURE = "failure.txt"


class Progress(Part):
    """How far a run got: its newest checkpoint.

    Attributes:
        format: narrows 0.1 wrote no number, and no checksums.
        run: digest of what the run is, so that no other run's checkpoint is taken for its own.
        step: engine steps done.
        wall_seconds: spent on them, in all sessions [s].
        finished: whether the run is at its end.
        checkpoint: name of the newest checkpoint's file; none before the first.
        checksums: of the checkpoint and of the outputs at its step, by file.
    """

    format: Literal[1, 2] = 1
    run: str | None = None
    step: Annotated[int, Field(ge=0, lt=2**63)] = 0
    wall_seconds: Annotated[float, Field(ge=0)] = 0.0
    finished: bool = False
    checkpoint: str | None = None
    checksums: dict[FileName, Checksum] = Field(default_factory=dict)

    @model_validator(mode="after")
    def _is_ours(self) -> Self:
        if self.checkpoint is None:
            if self.step > 0:
                raise ValueError(f"checkpoint: none of step {self.step}")
        elif not is_checkpoint(self.checkpoint, self.step):
            raise ValueError(f"checkpoint {self.checkpoint!r}: not that of step {self.step}")
        if self.format > 1:
            if self.run is None:
                raise ValueError("run: missing")
            if self.checkpoint is not None and self.checkpoint not in self.checksums:
                raise ValueError(f"checksums: none of {self.checkpoint}")
        return self

    def require(self, directory: Path, file: str) -> Path:
        """The path of a file of the run, once it begins with what it held at the checkpoint.

        A checkpoint, or an output of a finished run, must hold no more than that.

        Raises:
            RunDirectoryError: when it does not.
        """
        path = directory / file
        if file in self.checksums:
            self.checksums[file].require(path, whole=self.finished or file == self.checkpoint)
        return path


def is_begun(directory: Path) -> bool:
    """Whether the directory holds a driven run; not so one that was killed while it was made."""
    return (directory / NAME).is_file()


def read_progress(directory: Path) -> Progress:
    """How far the run in the directory is for sure.

    Raises:
        RunDirectoryError: when the directory holds no driven run, or the file is damaged.
    """
    path = directory / NAME
    return checked(Progress, read_json(path), path)


def write_progress(directory: Path, progress: Progress) -> Progress:
    """Record the newest checkpoint, then drop the older ones; safe against a kill at any moment."""
    replace_json(directory / NAME, progress.model_dump(mode="json"))
    for old in directory.glob("checkpoint.*"):
        if old.name.removesuffix(BESIDE) != progress.checkpoint:
            old.unlink(missing_ok=True)
    return progress


def write_failure(directory: Path, message: str) -> None:
    """Leave word of what stopped the run, if the disk has room for it; resuming removes it."""
    with contextlib.suppress(OSError):
        replace_text(directory / FAILURE, message + "\n")


def read_failure(directory: Path) -> str | None:
    """What stopped the run, if it was an error."""
    try:
        return read_text(directory / FAILURE).strip()
    except RunDirectoryError:
        return None

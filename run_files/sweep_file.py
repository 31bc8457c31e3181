"""`sweep.json`: the runs of a sweep, each a run directory beside it."""

from pathlib import Path
from typing import Annotated, Any, Self

from pydantic import Field, model_validator

from run_files.names import is_run_name
from run_files.reading import Part, checked, read_json, refuse
from run_files.writing import replace_json

NAME = "sweep.json"


class SweptRun(Part):
    """A run of a sweep: all fields of its scene, and the steps at which it is finished."""

    fields: dict[str, Any]
    total_steps: Annotated[int, Field(gt=0, lt=2**63)]


class SweepFile(Part):
    """Scene, engine, the swept fields, and the runs by the names of their directories."""

    scene: Annotated[str, Field(max_length=100)]
    engine: Annotated[str, Field(max_length=100)]
    over: tuple[str, ...]
    runs: dict[str, SweptRun]

    @model_validator(mode="after")
    def _names_are_ours(self) -> Self:
        for name in self.runs:
            if not is_run_name(name):
                raise ValueError(f"run {name[:100]!r}: not the name of a folder")
        return self


def is_sweep(directory: Path) -> bool:
    """Whether the directory is that of a sweep."""
    return (directory / NAME).is_file()


def read_sweep(directory: Path) -> SweepFile:
    """The sweep of a directory.

    Raises:
        RunDirectoryError: when it holds none, or a damaged one.
    """
    path = directory / NAME
    if not is_sweep(directory):
        refuse(directory, f"holds no sweep: it has no {NAME}")
    return checked(SweepFile, read_json(path), path)


def write_sweep(directory: Path, sweep: SweepFile) -> None:
    """Write the sweep to its directory."""
    replace_json(directory / NAME, sweep.model_dump(mode="json"))

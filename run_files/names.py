"""Names in our files that become paths: each has one form, and none leaves its directory."""

import re
from pathlib import Path
from typing import Annotated

from pydantic import Field

CHECKPOINT = re.compile(r"checkpoint\.(\d{1,19})\.(restart|npz)")
BESIDE = ".fluid"  # at the end of the name of what a checkpoint of a large fluid has beside it
LONGEST_NAME = 255  # bytes, of most file systems

FileName = Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_.-]*$", max_length=100)]


def checkpoint_name(step: int, suffix: str) -> str:
    """`checkpoint.15000.restart`."""
    return f"checkpoint.{step}.{suffix}"


def is_checkpoint(name: str, step: int, suffix: str | None = None) -> bool:
    """Whether this is the name of a checkpoint of that step, and of that suffix."""
    match = CHECKPOINT.fullmatch(name)
    return match is not None and name == checkpoint_name(step, suffix or match[2])


def is_run_name(name: str) -> bool:
    """Whether this may name a run directory within a sweep: one visible, printable word."""
    return (
        name.isprintable()
        and 0 < len(name.encode()) <= LONGEST_NAME
        and not name.startswith((".", "-"))
        and Path(name).name == name
    )

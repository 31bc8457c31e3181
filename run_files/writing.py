"""Writing a file whole: a reader, or a kill, meets the old content or the new, never half."""

import json
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from run_files.seal import sealed


def draft_of(path: Path) -> Path:
    """Where the new content of a file is written before it takes its place."""
    return path.with_name(f".{path.name}.draft")


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """The draft to write; it takes the place of the file once it is whole and on the disk."""
    draft = draft_of(path)
    yield draft
    reach_disk(draft)
    os.replace(draft, path)


def replace_text(path: Path, text: str) -> None:
    """Write a text file and put it in the place of the old one."""
    with replacing(path) as draft:
        draft.write_text(text, encoding="utf-8", newline="")


def replace_json(path: Path, content: dict[str, Any]) -> None:
    """Write a JSON file with the digest of its content."""
    replace_text(path, json.dumps(sealed(content), indent=1, allow_nan=False) + "\n")


def reach_disk(path: Path) -> None:
    """Wait until the disk holds a file, so that a power cut leaves what later ones tell of it."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)

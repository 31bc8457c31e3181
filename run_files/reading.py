"""Text and JSON of our own files, with one error that names the file."""

import json
import tomllib
from pathlib import Path
from typing import Any, NoReturn, TypeVar

from pydantic import BaseModel, ConfigDict, ValidationError

from run_files.seal import DIGEST, digest_of

LARGEST = 2**26  # bytes of what describes runs; a sweep of 1e5 runs has 5e7


class RunDirectoryError(ValueError):
    """A file that cannot be read as what it should be; the message is one line that names it."""


class Part(BaseModel):
    """Something that a file of ours holds: unknown keys and numbers that are not finite refused."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


Model = TypeVar("Model", bound=BaseModel)


def refuse(path: Path, problem: object) -> NoReturn:
    """Raise the error of a file, in one line.

    Raises:
        RunDirectoryError: always.
    """
    raise RunDirectoryError(f"{path}: {' '.join(str(problem).split())}") from None


def read_text(path: Path, largest: float = LARGEST) -> str:
    """The text of a file of at most so many bytes.

    Raises:
        RunDirectoryError: when it is missing, not UTF-8, or larger.
    """
    try:
        if path.stat().st_size > largest:
            refuse(path, f"more than {largest:g} bytes")
        return path.read_text(encoding="utf-8")
    except FileNotFoundError:
        refuse(path, "missing")
    except (OSError, UnicodeDecodeError) as error:
        refuse(path, error)


def read_json(path: Path) -> dict[str, Any]:
    """The object of a JSON file.

    Raises:
        RunDirectoryError: when it is missing, damaged, or not an object.
    """
    content = _parse_json(path)
    if not isinstance(content, dict):
        refuse(path, "not a JSON object")
    digest = content.pop(DIGEST, None)
    if digest is not None and digest != digest_of(content):
        refuse(path, "damaged, or changed by hand: to keep a change, remove the entry digest")
    return content


def read_json_list(path: Path) -> list[dict[str, Any]]:
    """The objects of a JSON file that lists them.

    Raises:
        RunDirectoryError: when it is missing, damaged, or not a list of objects.
    """
    content = _parse_json(path)
    if not isinstance(content, list) or not all(isinstance(entry, dict) for entry in content):
        refuse(path, "not a JSON list of objects")
    return content


def _parse_json(path: Path) -> Any:
    text = read_text(path)
    try:
        return json.loads(text)
    except (ValueError, RecursionError) as error:  # integers of thousands of digits are the former
        refuse(path, f"not JSON: {error}")


def read_toml(path: Path) -> dict[str, Any]:
    """The table of a TOML file.

    Raises:
        RunDirectoryError: when it is missing or damaged.
    """
    text = read_text(path)
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        refuse(path, f"not TOML: {error}")


def checked(model: type[Model], content: dict[str, Any], path: Path) -> Model:
    """The content of a file as what it should be.

    Raises:
        RunDirectoryError: naming the first entry that it should not be.
    """
    try:
        return model.model_validate(content)
    except (ValidationError, RecursionError) as error:
        if isinstance(error, RecursionError):
            refuse(path, "nested too deep")
        first = error.errors(include_url=False)[0]
        entry = ".".join(str(part) for part in first["loc"])
        reason = first["msg"].removeprefix("Value error, ").removeprefix("Input ")
        refuse(path, f"{entry + ': ' if entry else ''}{reason[:200]}")

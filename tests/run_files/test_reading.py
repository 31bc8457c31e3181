"""A damaged file is one line that names it."""

from collections.abc import Callable
from pathlib import Path

import pytest

from run_files import RunDirectoryError
from run_files.reading import Part, checked, read_json, read_json_list, read_text, read_toml, refuse
from run_files.writing import draft_of, replace_text


def refused(read: Callable[[], object], path: Path) -> str:
    """The message without the path, one line."""
    with pytest.raises(RunDirectoryError) as error:
        read()
    message = str(error.value)
    assert "\n" not in message
    assert message.startswith(f"{path}: ")
    return message.removeprefix(f"{path}: ")


def test_a_refusal_is_one_line(tmp_path: Path) -> None:
    assert refused(lambda: refuse(tmp_path, "two\n  lines"), tmp_path) == "two lines"


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"{", "not JSON: Expecting property name enclosed in double quotes: line 1 column 2"),
        (b"[]", "not a JSON object"),
        (b"\xff{}", "'utf-8' codec can't decode byte 0xff"),
        (b'{"a":' + b"[" * 100_000, "not JSON: "),
        (b"", "not JSON: Expecting value"),
    ],
)
def test_what_is_no_json(content: bytes, reason: str, tmp_path: Path) -> None:
    path = tmp_path / "manifest.json"
    path.write_bytes(content)
    assert refused(lambda: read_json(path), path).startswith(reason)


@pytest.mark.parametrize("content", ["{}", "[1]", '[{}, "a"]', "null"])
def test_a_list_holds_objects(content: str, tmp_path: Path) -> None:
    path = tmp_path / "results.json"
    path.write_text(content)
    assert refused(lambda: read_json_list(path), path) == "not a JSON list of objects"
    path.write_text('[{"a": 1}, {}]')
    assert read_json_list(path) == [{"a": 1}, {}]


def test_what_is_missing_no_file_or_too_large(tmp_path: Path) -> None:
    path = tmp_path / "a"
    assert refused(lambda: read_text(path), path) == "missing"
    assert "Is a directory" in refused(lambda: read_text(tmp_path), tmp_path)
    path.write_text("12345")
    assert read_text(path, largest=5) == "12345"
    assert refused(lambda: read_text(path, largest=4), path) == "more than 4 bytes"


def test_what_is_no_toml(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    path.write_text("gravity = ")
    assert refused(lambda: read_toml(path), path).startswith("not TOML: ")
    path.write_text("gravity = 0.1")
    assert read_toml(path) == {"gravity": 0.1}


class Inner(Part):
    number: float


class Outer(Part):
    inner: Inner


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        ({}, "inner: Field required"),
        ({"inner": {"number": "x"}}, "inner.number: should be a valid number"),
        ({"inner": {"number": float("nan")}}, "inner.number: should be a finite number"),
        ({"inner": {"number": 1, "more": 1}}, "inner.more: Extra inputs are not permitted"),
        ({"inner": {"number": "x" * 10_000}}, "inner.number: "),
    ],
)
def test_the_first_wrong_entry_is_named(
    content: dict[str, object], reason: str, tmp_path: Path
) -> None:
    told = refused(lambda: checked(Outer, content, tmp_path), tmp_path)
    assert told.startswith(reason)
    assert len(told) < 250


def test_a_file_is_replaced_whole(tmp_path: Path) -> None:
    path = tmp_path / "a"
    path.write_text("old")
    draft_of(path).write_text("half of something")  # a kill left it
    replace_text(path, "new\n")
    assert path.read_bytes() == b"new\n"
    assert list(tmp_path.iterdir()) == [path]

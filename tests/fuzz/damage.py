"""Ways to damage the files of a directory, drawn by hypothesis."""

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

from hypothesis import strategies as st

Damage = Callable[[Path, Path], object]  # of a directory, given that of another run

JSON_VALUES: st.SearchStrategy[Any] = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.floats(),
    st.sampled_from([0, -1, 1e308, 5e-324, 2**63, 10**400, "", "\x1b[2J", "../victim", "[/]"]),
    st.text(max_size=20),
    st.lists(st.integers(), max_size=3),
    st.dictionaries(st.text(max_size=5), st.integers(), max_size=3),
)


def _bytes(file: Path, change: Callable[[bytearray], bytes | bytearray]) -> None:
    file.write_bytes(change(bytearray(file.read_bytes())))


def _at(content: bytearray, fraction: float) -> int:
    return int(fraction * len(content))


def _truncate(file: Path, a: float, b: float, data: bytes) -> None:
    _bytes(file, lambda content: content[: _at(content, a)])


def _flip(file: Path, a: float, b: float, data: bytes) -> None:
    def flip(content: bytearray) -> bytes:
        if content:
            content[min(_at(content, a), len(content) - 1)] ^= 1 << int(7.99 * b)
        return bytes(content)

    _bytes(file, flip)


def _cut_out(file: Path, a: float, b: float, data: bytes) -> None:
    low, high = sorted((a, b))
    _bytes(file, lambda content: content[: _at(content, low)] + content[_at(content, high) :])


def _double(file: Path, a: float, b: float, data: bytes) -> None:
    low, high = sorted((a, b))
    _bytes(file, lambda content: content[: _at(content, high)] + content[_at(content, low) :])


def _overwrite(file: Path, a: float, b: float, data: bytes) -> None:
    def overwrite(content: bytearray) -> bytes:
        start = _at(content, a)
        content[start : start + len(data)] = data
        return bytes(content)

    _bytes(file, overwrite)


def _insert(file: Path, a: float, b: float, data: bytes) -> None:
    _bytes(file, lambda content: content[: _at(content, a)] + data + content[_at(content, a) :])


def _replace(file: Path, a: float, b: float, data: bytes) -> None:
    file.write_bytes(data)


def _remove(file: Path, a: float, b: float, data: bytes) -> None:
    file.unlink()


def _a_line(file: Path, a: float, b: float, data: bytes) -> None:
    """A line doubled, emptied or given another word."""
    lines = file.read_bytes().split(b"\n")
    n = min(int(a * len(lines)), len(lines) - 1)
    words = lines[n].split(b" ")
    words[int(b * len(words)) % len(words)] = data
    lines[n : n + 1] = [[lines[n]] * 2, [b""], [b" ".join(words)], []][int(4 * b) % 4]
    file.write_bytes(b"\n".join(lines))


BYTEWISE = (
    *(_truncate, _flip, _flip, _cut_out, _double, _overwrite, _insert, _replace, _remove),
    *(_a_line, _a_line),
)


@st.composite
def damages(draw: st.DrawFn, names: list[str]) -> Damage:
    """A change of one of the files of those names."""
    name = draw(st.sampled_from(names))
    kind = draw(st.sampled_from(["bytes", "bytes", "json", "other run", "other file"]))
    if kind == "json" and name.endswith(".json"):
        path, value = draw(st.lists(st.integers(0, 50), min_size=1, max_size=5)), draw(JSON_VALUES)
        sealed = draw(st.booleans())
        return lambda directory, _: _json(directory / name, path, value, sealed)
    if kind == "other run":
        return lambda directory, other: shutil.copy(other / name, directory / name)
    if kind == "other file":
        source = draw(st.sampled_from(names))
        return lambda directory, _: (directory / name).write_bytes(
            (directory / source).read_bytes()
        )
    change = draw(st.sampled_from(BYTEWISE))
    a, b = draw(st.floats(0, 1)), draw(st.floats(0, 1))
    data = draw(st.one_of(st.binary(max_size=40), st.text(max_size=20).map(str.encode)))
    return lambda directory, _: change(directory / name, a, b, data)


def _json(file: Path, path: list[int], value: Any, sealed: bool) -> None:
    """Another value for an entry, or a new entry; the digest kept, or as of a file by hand."""
    content = json.loads(file.read_text())
    if not sealed:
        content.pop("digest", None)
    entry = content
    for step in path:
        keys = list(entry) if isinstance(entry, dict) else list(range(len(entry)))
        if not keys:
            break
        key = keys[step % len(keys)]
        if not isinstance(entry[key], dict | list) or step == path[-1]:
            entry[key] = value
            break
        entry = entry[key]
    file.write_text(json.dumps(content))

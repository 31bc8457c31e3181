"""Cutting output files back to a step, so that a resumed run leaves no gap and nothing twice."""

from collections.abc import Iterator
from pathlib import Path

from run_files.reading import refuse

FRAME = b"ITEM: TIMESTEP"


def cut_output(path: Path, kind: str, step: int) -> None:
    """Drop what the file of an output says of the time after a step; a missing one is left.

    Raises:
        RunDirectoryError: when the file holds something else.
    """
    if path.exists():
        size = kept_bytes(path, kind, step)
        with path.open("r+b") as file:
            file.truncate(size)


def kept_bytes(path: Path, kind: str, step: int) -> int:
    """How much of the file of an output is kept when a run goes on from a step.

    A trajectory loses the frame of the step too: the engine writes that one again. A table loses
    titles at its end, which LAMMPS repeats when it goes on with a file.

    Raises:
        RunDirectoryError: when the file holds something else.
    """
    return _first_frame(path, step) if kind == "trajectory" else _end_of_rows(path, step)


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
        if line.startswith(FRAME):
            frame = offset
        elif FRAME.startswith(line):  # a kill amid the line
            return offset
        elif frame is not None:
            if not line.endswith(b"\n") or _number(line, path) >= step:
                return frame
            frame = None
    return path.stat().st_size if frame is None else frame


def _end_of_rows(path: Path, step: int) -> int:
    """Where the rows up to a step end; the titles, if there are none."""
    end = 0
    in_titles = True
    for offset, line in _lines(path):
        is_title = line.startswith(b"#")
        in_titles &= is_title
        is_labelled = not line.startswith((b"#", b" "))
        if not line.endswith(b"\n") or (is_labelled and _number(line, path) > step):
            break
        if in_titles or not is_title:
            end = offset + len(line)
    return end


def _number(line: bytes, path: Path) -> int:
    try:
        return int(line.split()[0])
    except (ValueError, IndexError):
        refuse(path, f"{line[:40]!r} where a step should be")

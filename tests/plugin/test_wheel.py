"""A wheel with builds of the plugin by level: LAMMPS gets the best that the processor runs."""

from pathlib import Path, PurePosixPath
from typing import Any

import pytest

import lammps_plugin

NEW = "processor : 0\nflags : fpu abm avx avx2 bmi1 bmi2 f16c fma movbe sse4_2\n"
NEWEST = NEW.replace("avx2", "avx2 avx512f avx512bw avx512cd avx512dq avx512vl")
OLD = "processor : 0\nflags : fpu avx sse4_2\n"
ALL = ["x86-64-v2", "x86-64-v3", "x86-64-v4"]


class Installed(PurePosixPath):
    """A file as the metadata of a distribution have it."""

    def locate(self) -> Path:
        return Path(self)


@pytest.mark.parametrize(
    ("processors", "folders", "chosen"),
    [
        (NEWEST, ALL, "x86-64-v4"),
        (NEW, ALL, "x86-64-v3"),
        (OLD, ALL, "x86-64-v2"),
        (NEWEST + NEW, ALL, "x86-64-v3"),
        (NEW + OLD, ALL, "x86-64-v2"),
        ("", ALL, "x86-64-v2"),
        (OLD, ["lammps_plugin"], "lammps_plugin"),
        (NEW, [], None),
    ],
)
def test_the_processor_decides(
    processors: str,
    folders: list[str],
    chosen: str | None,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for name in folders:
        (tmp_path / name).mkdir()
        (tmp_path / name / "narrowsplugin.so").touch()
    built: list[Any] = [Installed(tmp_path / name / "narrowsplugin.so") for name in folders]
    monkeypatch.setattr(lammps_plugin, "files", lambda name: built)
    monkeypatch.setattr(Path, "read_text", lambda path, encoding: processors)
    assert lammps_plugin.folder() == (str(tmp_path / chosen) if chosen else "")

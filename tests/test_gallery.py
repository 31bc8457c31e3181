"""docs/gallery.md: the page that its script writes, pictures that exist, commands that parse."""

import ast
import importlib.util
import re
import shlex
import sys
from pathlib import Path
from typing import Any

import pytest
import typer.main
from PIL import Image

from lammps_inputs.deck import check_engine
from lammps_inputs.engines import default_engine
from narrows.cli import app
from narrows.papers import papers
from narrows.scene_options import scene_of
from tests.conftest import ROOT

DOCS = ROOT / "docs"


def script() -> Any:
    spec = importlib.util.spec_from_file_location("gallery", DOCS / "gallery.py")
    assert spec
    assert spec.loader
    module = importlib.util.module_from_spec(spec)
    sys.modules["gallery"] = module  # which dataclasses look for
    spec.loader.exec_module(module)
    return module


gallery = script()
COMMANDS = [line for entry in gallery.ENTRIES for line in entry.commands]


def test_the_page_is_what_the_script_writes() -> None:
    assert gallery.PAGE.read_text(encoding="utf-8") == gallery.page()


def test_the_page_shows_ten_pictures_and_each_is_there_and_small() -> None:
    shown = re.findall(r"!\[[^]]+\]\((\S+)\)", gallery.PAGE.read_text(encoding="utf-8"))
    assert len(set(shown)) >= 10
    files = sorted((DOCS / "figures" / "gallery").iterdir())
    assert sorted(DOCS / name for name in shown) == files
    for file in files:
        assert file.stat().st_size <= 150_000
        with Image.open(file) as image:
            assert image.format == "PNG"
            assert 400 <= image.width <= 900


def test_every_paper_has_pictures() -> None:
    assert {entry.paper for entry in gallery.ENTRIES} == set(papers())


def test_with_and_without_hydrodynamics_are_beside_each_other() -> None:
    (entry,) = (each for each in gallery.ENTRIES if each.name == "two_flows")
    first, second, _ = entry.commands
    assert second.replace(" --set hydrodynamics=shuffle", "").replace("without", "with") == first


@pytest.mark.parametrize("line", COMMANDS)
def test_a_command_parses(line: str) -> None:
    program, *words = shlex.split(line)
    if program == "python":
        ast.parse((ROOT / words[0]).read_text(encoding="utf-8"))
        return
    assert program == "narrows"
    command: Any = typer.main.get_command(app)
    context = command.make_context("narrows", list(words), resilient_parsing=False)
    while hasattr(command, "commands"):
        name, command, words = command.resolve_command(
            context, [*context._protected_args, *context.args]
        )
        context = command.make_context(name, words, parent=context)
    given = context.params
    if "settings" in given:
        over = dict(part.split("=") for part in given.get("over") or ())
        firsts = [f"{field}={values.split(',')[0]}" for field, values in over.items()]
        scene = scene_of(given["scene"], None, [*(given["settings"] or ()), *firsts])
        check_engine(scene, given.get("engine") or default_engine(scene.system))


def test_each_picture_is_left_by_a_command_of_its_entry_or_one_before() -> None:
    said = ""
    for entry in gallery.ENTRIES:
        said += " ".join(entry.commands)
        assert str(Path(entry.picture).parent if "/" in entry.picture else entry.picture) in said

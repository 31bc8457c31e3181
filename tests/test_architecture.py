"""The layout is the architecture: who imports whom, and who may say which scene or engine it is."""

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from lammps_inputs import all_engines, all_scenes
from tests.conftest import ROOT

PACKAGES = ("lammps_inputs", "lammps_plugin", "srd_driver", "run_files", "analysis", "narrows")
MAY_IMPORT = {  # docs/design.md has the same table
    "lammps_inputs": set(),
    "lammps_plugin": set(),
    "run_files": set(),
    "lattice": set(),
    "srd_driver": {"lammps_inputs", "lammps_plugin", "run_files"},
    "analysis": {"run_files"},
}
LONGEST_CHAIN = 5  # files
# names of engines stand in the tables that find them, and in the files of the engines themselves
ENGINE_TABLES = ("lammps_inputs/engines/", "srd_driver/engines.py")
SCENE_FILES = ("lammps_inputs/scenes/", "run_files/manifest_0_1.py")
PAPERS = "narrows/papers/"  # they choose scenes, as a user does
FLUIDS = {  # a fluid of its method's name, not the engine
    "lammps_inputs/scenes/lanes.py": {"mpc"},
    "narrows/papers/delhommelle_2005/hydrodynamic_noise.py": {"mpc"},
}


def files(package: str) -> list[Path]:
    return sorted((ROOT / package).rglob("*.py"))


def relative(path: Path) -> str:
    return str(path.relative_to(ROOT))


@cache
def tree(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


def imports(path: Path) -> Iterator[str]:
    """Full names that a file imports when it is loaded, those for types alone left out."""
    for node in ast.walk(tree(path)):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            yield node.module
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def strings(path: Path) -> Iterator[str]:
    """String constants, docstrings left out."""
    docstrings = {
        id(node.body[0].value)
        for node in ast.walk(tree(path))
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef)
        and node.body
        and isinstance(node.body[0], ast.Expr)
    }
    for node in ast.walk(tree(path)):
        text = node.value if isinstance(node, ast.Constant) else None
        if isinstance(text, str) and id(node) not in docstrings:
            yield text


def module_file(name: str) -> Path | None:
    """The file of one of our modules."""
    path = ROOT / name.replace(".", "/")
    return next((p for p in (path.with_suffix(".py"), path / "__init__.py") if p.is_file()), None)


@pytest.mark.parametrize("package", MAY_IMPORT)
def test_packages_import_what_the_table_of_the_design_says(package: str) -> None:
    allowed = MAY_IMPORT[package] | {package}
    for path in files(package):
        ours = {name.partition(".")[0] for name in imports(path)} & {*MAY_IMPORT, "narrows"}
        assert ours <= allowed, relative(path)


def test_the_page_of_the_design_has_the_same_table() -> None:
    page = (ROOT / "docs" / "design.md").read_text(encoding="utf-8")
    for package, allowed in MAY_IMPORT.items():
        names = ", ".join(sorted(allowed)) or "nothing of ours"
        assert f"| `{package}/` | {names} |" in page, package


def test_no_file_asks_which_scene_it_has() -> None:
    scenes = all_scenes()
    classes = {scene.__name__ for scene in scenes.values()}
    for package in PACKAGES:
        for path in files(package):
            place = relative(path)
            if place.startswith((*SCENE_FILES, PAPERS)):
                continue
            names = {node.id for node in ast.walk(tree(path)) if isinstance(node, ast.Name)}
            assert not names & classes, place
            assert not set(strings(path)) & scenes.keys(), place


def test_no_file_asks_which_engine_it_has() -> None:
    for package in PACKAGES:
        for path in files(package):
            if not relative(path).startswith(ENGINE_TABLES):
                named = set(strings(path)) - FLUIDS.get(relative(path), set())
                assert not named & all_engines().keys(), relative(path)


def test_no_import_chain_of_lammps_inputs_is_long() -> None:
    """Followed from file to file, packages of its own left out, none is longer than five files."""

    @cache
    def depth(path: Path) -> int:
        below = {module_file(name) for name in imports(path) if name.startswith("lammps_inputs.")}
        below = {file for file in below if file and file != path}
        return 1 + max((depth(file) for file in below), default=0)

    depths = {relative(path): depth(path) for path in files("lammps_inputs")}
    del depths["lammps_inputs/__init__.py"]  # the door, from outside
    assert max(depths.values()) <= LONGEST_CHAIN, depths


def test_no_file_of_lammps_inputs_imports_through_its_own_door() -> None:
    for path in files("lammps_inputs"):
        if path.parent.name != "lammps_inputs" or path.name != "__init__.py":
            assert "lammps_inputs" not in set(imports(path)), relative(path)

"""The page that lists the fields says what the code says."""

import re
from typing import Any

from lammps_inputs import all_scenes
from tests.conftest import ROOT


def test_scene_page_lists_every_field_with_its_default_and_meaning() -> None:
    """In the scene's section, or in a table that says of which scenes it is."""
    page = (ROOT / "docs" / "scenes.md").read_text(encoding="utf-8")
    _, *sections = page.split("\n## `")
    documented = {section.partition("`")[0]: section for section in sections}
    assert documented.keys() == all_scenes().keys()
    shared = re.findall(r"^\*\*Fields of (.*?)\*\*.*\n\n((?:\|.*\n)+)", page, re.MULTILINE)
    assert len(shared) == 3
    for name, scene in all_scenes().items():
        tables = documented[name] + "".join(
            table for names, table in shared if f"`{name}`" in names
        )
        for field, info in scene.model_fields.items():
            assert f"| `{field}` | {shown(info.default)} | {info.description} |" in tables


def shown(default: Any) -> str:
    if default is None:
        return "none"
    if isinstance(default, tuple):
        return ", ".join(map(shown, default))
    return default if isinstance(default, str) else f"{default:g}"

"""The documentation site: `python -m sphinx -W -b html docs DIR`, with `pip install ".[docs]"`."""

from importlib import metadata
from typing import Any

project = "narrows"
author = "The narrows maintainers"
release = metadata.version("narrows")
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
html_theme = "furo"
html_title = f"narrows {release}"
exclude_patterns = ["notebooks", "results", "examples"]
myst_heading_anchors = 4
default_role = "code"  # as `this` is meant in docstrings
autodoc_member_order = "bysource"


def escape(
    _app: Any, _what: str, _name: str, _object: Any, _options: Any, lines: list[str]
) -> None:
    """Bars of absolute values and of state vectors are no substitutions."""
    lines[:] = [line.replace("|", r"\|") for line in lines]


def setup(app: Any) -> None:
    """Called by Sphinx."""
    app.connect("autodoc-process-docstring", escape)

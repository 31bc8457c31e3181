"""Figures of papers, computed again: `narrows reproduce`. A package here is a paper.

| module | holds |
|---|---|
| `results` | numbers beside the paper's, and when they agree |
| `figure` | what a figure of a paper is: scenes, and what is made of their runs |
| `session` | runs what is missing, makes the figures, writes the files |
| `page` | `index.html` |
| `reproduction_file` | what was asked for in a directory |
| `drawing` | the look of the figures |
| `tabatabaei_2009` | the thesis on colloids in a narrow channel |
| `hecht_2005` | claylike colloids |
"""

import importlib
import pkgutil
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:  # the command line lists papers without loading what makes their figures
    from narrows.papers.figure import Paper

REPRODUCTION = "reproduction.json"  # what was asked for in a directory


def papers() -> list[str]:
    """Names of all papers, as on the command line."""
    return [
        package.name.replace("_", "-")
        for package in pkgutil.iter_modules(__path__)
        if package.ispkg
    ]


def is_reproduction(directory: Path) -> bool:
    """Whether figures of a paper were asked for in the directory."""
    return (directory / REPRODUCTION).is_file()


def paper_named(name: str) -> "Paper":
    """The paper of that name.

    Raises:
        ValueError: for an unknown name.
    """
    if name not in papers():
        raise ValueError(f"{name!r} is not known; there is {', '.join(papers())}")
    module = importlib.import_module(f"{__name__}.{name.replace('-', '_')}")
    paper: Paper = module.PAPER
    return paper

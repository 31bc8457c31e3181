"""`reproduction.json`: what was asked of a paper in a directory, so that its status can be told."""

from pathlib import Path

from narrows.papers import REPRODUCTION, paper_named
from narrows.papers.figure import Quality
from narrows.papers.session import Plan, select
from run_files.reading import Part, checked, read_json, refuse
from run_files.writing import replace_json


class ReproductionFile(Part):
    """A paper, and the figures asked for in each quality."""

    paper: str
    figures: dict[Quality, tuple[str, ...]]


def remember(plan: Plan) -> None:
    """Add what a command asks for to what was asked before.

    Raises:
        RunDirectoryError: when the file is damaged.
        OSError: when it cannot be written.
    """
    path = plan.out / REPRODUCTION
    path.parent.mkdir(parents=True, exist_ok=True)
    before: dict[Quality, tuple[str, ...]] = {}
    if path.is_file():
        content = checked(ReproductionFile, read_json(path), path)
        if content.paper != plan.paper.name:
            refuse(path, f"is of {content.paper}, not {plan.paper.name}: choose another folder")
        before = content.figures
    numbers = (figure.number for figure in plan.figures)
    asked = before | {plan.quality: tuple(dict.fromkeys((*before.get(plan.quality, ()), *numbers)))}
    file = ReproductionFile(paper=plan.paper.name, figures=asked)
    replace_json(path, file.model_dump(mode="json"))


def read_plans(directory: Path) -> list[Plan]:
    """All that was asked for in the directory, a plan for each quality.

    Raises:
        RunDirectoryError: when the file is missing, damaged, or of a paper or figure unknown here.
    """
    path = directory / REPRODUCTION
    content = checked(ReproductionFile, read_json(path), path)
    try:
        paper = paper_named(content.paper)
        return [
            Plan(paper, select(paper, numbers), quality, directory)
            for quality, numbers in content.figures.items()
        ]
    except ValueError as error:
        refuse(path, error)

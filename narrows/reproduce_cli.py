"""`narrows reproduce`: the figures of a paper, computed again, beside the paper's numbers."""

import sys
import time as clock
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from narrows.messages import say, user_errors

if TYPE_CHECKING:
    from srd_driver.sweep import Advance


def reproduce(
    paper: Annotated[str, typer.Argument(metavar="PAPER", help="tabatabaei-2009")],
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="folder of runs and results")],
    figures: Annotated[
        list[str] | None, typer.Argument(metavar="[FIGURE]...", help="as 4.6; default: all")
    ] = None,
    quick: Annotated[
        bool, typer.Option("--quick", help="minutes instead of an hour, with larger errors")
    ] = False,
) -> None:
    """Compute the figures of a paper again and hold them against its numbers.

    Writes figures, data, results.json and index.html into DIR. Run again it goes on where it was.
    """
    from narrows.reproduce.page import count_verdicts
    from narrows.reproduce.session import Plan, carry_out, cores, select
    from narrows.reproduce.tabatabaei_2009 import PAPER

    if paper != PAPER.name:
        raise typer.BadParameter(f"{paper!r} is not known; there is {PAPER.name}")
    try:
        chosen = select(PAPER, figures or [])
    except ValueError as error:
        raise typer.BadParameter(str(error)) from None
    with user_errors():
        began = clock.perf_counter()
        plan = Plan(PAPER, chosen, "quick" if quick else "full", out)
        jobs = cores()
        missing = len(plan.runs) - plan.finished()
        say(
            f"{PAPER.name}, {plan.quality} quality: {len(chosen)} figures from {len(plan.runs)} "
            f"runs, {missing} of them to do, {jobs} at a time"
        )
        with _progress_bar() as report:
            done = carry_out(plan, jobs, report)
        minutes, seconds = divmod(round(clock.perf_counter() - began), 60)
        counts = count_verdicts(done.results)
        verdicts = (
            f"{counts['agrees']} agree, {counts['disagrees']} disagree, {counts['open']} open"
        )
        say(f"{len(done.results)} results, {verdicts}; {minutes} min {seconds} s")
        say(f"open {out / 'index.html'}")
    for line in done.left_out:
        typer.echo(f"narrows: {line}", err=True)
    if done.left_out:
        raise typer.Exit(1)


@contextmanager
def _progress_bar() -> Iterator["Callable[[Advance], None] | None"]:
    """A bar over all runs together, on a terminal."""
    if not sys.stderr.isatty():
        yield None
        return
    with Progress(
        TextColumn("runs"),
        BarColumn(),
        TextColumn("{task.description}"),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
        console=Console(stderr=True),
    ) as progress:
        task = progress.add_task("", total=1.0)

        def report(advance: "Advance") -> None:
            text = f"{advance.finished} of {advance.runs}"
            if advance.failed:
                text += f", {advance.failed} failed"
            progress.update(task, completed=advance.work, description=text)

        yield report

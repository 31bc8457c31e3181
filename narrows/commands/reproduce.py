"""`narrows reproduce`: the figures of a paper, computed again, beside the paper's numbers."""

import time as clock
from pathlib import Path
from typing import Annotated

import typer

from narrows.messages import complain, say, user_errors
from narrows.papers import paper_named, papers
from narrows.progress import progress_of_runs
from srd_driver.signals import interrupted_by_signals
from srd_driver.sweep import available_cores


def _complete_paper(incomplete: str) -> list[str]:
    return [name for name in papers() if name.startswith(incomplete)]


def reproduce(
    paper: Annotated[
        str,
        typer.Argument(metavar="PAPER", autocompletion=_complete_paper, help=" or ".join(papers())),
    ],
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="folder of runs and results")],
    figures: Annotated[
        list[str] | None, typer.Argument(metavar="[FIGURE]...", help="as 4.6; default: all")
    ] = None,
    quick: Annotated[
        bool, typer.Option("--quick", help="minutes instead of hours, with larger errors")
    ] = False,
) -> None:
    """Compute the figures of a paper again and hold them against its numbers.

    Writes figures, data, results.json and index.html into DIR. Run again it goes on where it was;
    `narrows status DIR` tells how far it is.
    """
    from narrows.papers.page import count_verdicts
    from narrows.papers.reproduction_file import remember
    from narrows.papers.session import Plan, carry_out, select

    try:
        asked = paper_named(paper)
        chosen = select(asked, figures or [])
    except ValueError as error:
        raise typer.BadParameter(str(error)) from None
    except ImportError as error:  # of what the smallest installation leaves out
        complain(str(error))
        raise typer.Exit(2) from None
    with user_errors():
        began = clock.perf_counter()
        plan = Plan(asked, chosen, "quick" if quick else "full", out)
        remember(plan)
        jobs = available_cores()
        missing = len(plan.runs) - plan.finished()
        say(
            f"{asked.name}, {plan.quality} quality: {len(chosen)} figures from {len(plan.runs)} "
            f"runs, {missing} of them to do, {jobs} at a time"
        )
        try:
            with interrupted_by_signals(), progress_of_runs() as (report, _):
                done = carry_out(plan, jobs, report)
        except KeyboardInterrupt:
            raise KeyboardInterrupt("give the same command again to go on") from None
        minutes, seconds = divmod(round(clock.perf_counter() - began), 60)
        counts = count_verdicts(done.results)
        verdicts = (
            f"{counts['agrees']} agree, {counts['disagrees']} disagree, {counts['open']} open"
        )
        say(f"{len(done.results)} results, {verdicts}; {minutes} min {seconds} s")
        say(f"open {out / 'index.html'}")
    for line in done.left_out:
        complain(line)
    if done.left_out:
        raise typer.Exit(1)

"""`narrows report`: a run or a sweep on one page."""

from pathlib import Path
from typing import Annotated

import typer

from narrows.messages import say, user_errors
from run_files.sweep_file import is_sweep
from srd_driver.sweep import available_cores


def report(
    directory: Annotated[Path, typer.Argument(metavar="DIR", help="of a run or a sweep")],
) -> None:
    """Write report.html into DIR: pictures, numbers with errors, provenance, what to cite.

    One file, to be sent or kept beside a paper; what is not analysed yet, is.
    """
    from narrows.report import report_run, report_sweep  # here, so that `--help` stays fast

    with user_errors():
        sweep = is_sweep(directory)
        page = report_sweep(directory, available_cores()) if sweep else report_run(directory)
        say(f"open {page}")

"""What the command line says: results on stdout, complaints on stderr, each process group once."""

import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress

import typer

from lammps_inputs import SceneError
from run_files import RunDirectoryError
from srd_driver import RunError
from srd_driver.parallel import communicator


def printable(text: str) -> str:
    """The text without what would steer a terminal: names and notes may come from any file."""
    return "".join(
        sign if sign.isprintable() or sign == "\n" else sign.encode("unicode_escape").decode()
        for sign in text
    )


def say(text: str) -> None:
    """Print a result, on the first process only."""
    if _first_process():
        print(printable(text), flush=True)


def warn(warnings: Iterable[str]) -> None:
    """Tell of what will be inaccurate, one line each on stderr, on the first process only."""
    if _first_process():
        for warning in warnings:
            print(printable(f"warning: {warning}"), file=sys.stderr, flush=True)


@contextmanager
def user_errors() -> Iterator[None]:
    """Turn what a user can mend into one message.

    Exit code 2 for bad input and files that cannot be used, 1 for a stop or a failed write.
    """
    try:
        yield
    except (SceneError, RunDirectoryError) as error:
        complain(str(error))
        raise typer.Exit(2) from None
    except (RunError, OSError) as error:
        complain(str(error))
        raise typer.Exit(1) from None
    except KeyboardInterrupt as interrupt:
        advice = str(interrupt) or "go on from the newest checkpoint by --resume"
        complain(f"interrupted: {advice}")
        if not interrupt.args:
            _end_other_processes()
        raise typer.Exit(130) from None


def complain(text: str) -> None:
    """Say what is wrong, on the first process only."""
    if _first_process():
        print(printable(f"narrows: {text}"), file=sys.stderr, flush=True)


def _end_other_processes() -> None:
    """A signal met this process alone, before or after the run: the others would wait for it."""
    with suppress(RunError):
        if communicator().size > 1:
            communicator().Abort(130)


def _first_process() -> bool:
    try:
        return bool(communicator().rank == 0)
    except RunError:  # without MPI there is only one
        return True

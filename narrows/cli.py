"""The `narrows` command line: thin, each command calls one function of a library package."""

import os
import sys
from importlib.metadata import version
from typing import Annotated

import typer

import lammps_plugin
from narrows.commands.advise import advise
from narrows.commands.analyze import analyze
from narrows.commands.deck import deck
from narrows.commands.diffusivity import diffusivity
from narrows.commands.export import export
from narrows.commands.lattice import app as lattice_app
from narrows.commands.picture import movie, picture
from narrows.commands.report import report
from narrows.commands.reproduce import reproduce
from narrows.commands.run import run
from narrows.commands.scenes import scenes
from narrows.commands.status import status
from narrows.commands.sweep import sweep
from narrows.commands.units import units

app = typer.Typer(
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    help="Particles driven through narrow spaces: scenes, LAMMPS decks, runs and their analysis.",
)
COMMANDS = (
    scenes,
    advise,
    deck,
    run,
    sweep,
    status,
    analyze,
    report,
    picture,
    movie,
    export,
    diffusivity,
    reproduce,
    units,
)
for command in COMMANDS:
    app.command()(command)
app.add_typer(lattice_app, name="lattice")


def _tell_version(asked: bool) -> None:
    if asked:
        styles = "built" if lammps_plugin.folder() else "not built"
        typer.echo(
            f"narrows {version('narrows')}, LAMMPS {version('lammps')}, compiled styles {styles}"
        )
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool,
        typer.Option("--version", callback=_tell_version, is_eager=True, help="tell it and leave"),
    ] = False,
) -> None:
    pass


def main() -> None:
    """Run the command; a full disk or memory is one line, not a traceback."""
    try:
        try:
            app(prog_name="narrows")
        finally:
            sys.stdout.flush()
    except OSError as error:  # nothing can be said on stdout, now or when Python ends
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(f"narrows: cannot write the output: {error.strerror or error}")
    except MemoryError:
        sys.exit("narrows: not enough memory")

"""The `narrows` command line: thin, each command calls one function of a library package."""

import typer

from narrows.commands.analyze import analyze
from narrows.commands.deck import deck
from narrows.commands.lattice import app as lattice_app
from narrows.commands.reproduce import reproduce
from narrows.commands.run import run
from narrows.commands.status import status
from narrows.commands.sweep import sweep
from narrows.commands.units import units

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    help="Particles driven through narrow spaces: scenes, LAMMPS decks, runs and their analysis.",
)
for command in (deck, run, sweep, status, analyze, reproduce, units):
    app.command()(command)
app.add_typer(lattice_app, name="lattice")

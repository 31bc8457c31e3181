"""The `narrows` command line: thin, each command calls one function of a library package."""

import typer

from narrows.analyze_cli import analyze
from narrows.lattice_cli import app as lattice_app
from narrows.reproduce_cli import reproduce
from narrows.run_cli import deck, run
from narrows.sweep_cli import status, sweep

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    help="Particles driven through narrow spaces: scenes, LAMMPS decks, runs and their analysis.",
)
for command in (deck, run, sweep, status, analyze, reproduce):
    app.command()(command)
app.add_typer(lattice_app, name="lattice")

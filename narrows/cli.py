"""The `narrows` command line: thin, each command calls one function of a library package."""

import typer

from narrows.lattice_cli import app as lattice_app

app = typer.Typer(no_args_is_help=True, add_completion=False, help=__doc__)
app.add_typer(lattice_app, name="lattice")

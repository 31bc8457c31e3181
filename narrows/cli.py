"""The `narrows` command line: thin, each command calls one function of a library package."""

import typer

app = typer.Typer(no_args_is_help=True, add_completion=False, help=__doc__)

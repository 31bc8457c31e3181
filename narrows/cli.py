"""The `narrows` command line: thin, each command calls one function of a library package."""

import typer

from narrows.analyze_cli import analyze

app = typer.Typer(no_args_is_help=True, add_completion=False, help=__doc__)
app.command()(analyze)


@app.callback()
def _commands() -> None:
    """Keeps `narrows COMMAND` when there is only one command."""

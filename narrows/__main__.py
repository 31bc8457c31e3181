"""`python -m narrows` is the `narrows` command."""

from narrows.cli import main

main()

"""`narrows diffusivity`: the diffusivity profile of anybody's trajectory."""

from pathlib import Path
from typing import Annotated

import typer

from narrows.messages import complain, say, user_errors, warn


def diffusivity(
    trajectory: Annotated[
        Path, typer.Argument(metavar="TRAJECTORY", help="LAMMPS, GROMACS, DCD: as MDAnalysis reads")
    ],
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="folder of table and figure")],
    topology: Annotated[
        Path | None, typer.Option(metavar="FILE", help="particles, if the trajectory has none")
    ] = None,
    axis: Annotated[str, typer.Option(metavar="x|y|z", help="across the slit")] = "z",
    select: Annotated[str, typer.Option(help="atoms, in MDAnalysis's words")] = "all",
    dt: Annotated[
        float | None,
        typer.Option(help="time between frames, in a unit of yours, if the file has none"),
    ] = None,
    low: Annotated[
        float | None,
        typer.Option(help="lower surface, in units of the file; default: near the end"),
    ] = None,
    high: Annotated[float | None, typer.Option(help="upper surface; likewise")] = None,
    bins: Annotated[
        int, typer.Option(help="of the likelihood; fewer where too few cross from one to the next")
    ] = 20,
    estimators: Annotated[
        str, typer.Option("--by", metavar="LIST", help="of color, bayes, first-passage")
    ] = "color,bayes,first-passage",
) -> None:
    """Estimate D across a slit from a trajectory, by colours, likelihood and first passage."""
    from analysis.diffusivity import DiffusivityError  # here, so that `--help` stays fast
    from analysis.diffusivity.trajectory import (
        estimate_all,
        in_the_middle,
        open_trajectory,
        write,
    )

    with user_errors():
        try:
            atoms = open_trajectory(trajectory, topology, select, dt)
            names = tuple(name.strip() for name in estimators.split(","))
            found, missing = estimate_all(atoms, axis, low, high, names, bins=bins)
        except DiffusivityError as error:
            complain(str(error))
            raise typer.Exit(2) from None
        warn(missing)
        for each in found:
            middle = len(each.positions) // 2
            say(
                f"{each.estimator}: D = {each.diffusivity[middle]:.4g} +- {each.error[middle]:.2g} "
                f"at {axis} = {each.positions[middle]:.4g}; {each.remark}"
            )
        say(f"displacements from the middle third: {in_the_middle(atoms, axis)}")
        say(f"written: {', '.join(map(str, write(found, axis, out)))}")

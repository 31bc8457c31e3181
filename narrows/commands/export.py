"""`narrows export`: the flow field of a run for other programs."""

from pathlib import Path
from typing import Annotated

import typer

from lammps_inputs import SceneError
from narrows.messages import say, user_errors


def export(
    run: Annotated[
        Path,
        typer.Argument(
            metavar="RUN", help="a run with a flow_interval, or the file of a deck's own flow"
        ),
    ],
    file: Annotated[
        Path, typer.Argument(metavar="FILE", help="ending .vti (ParaView, OVITO) or .npz (numpy)")
    ],
    skip: Annotated[
        int, typer.Option(min=0, help="of a file: averages left out of the mean at the start")
    ] = 0,
) -> None:
    """Write the flow field: .vti, its mean after the equilibration; .npz, every average.

    Of a file of `flow` of fix mpc, the mean of all but what --skip leaves out.
    """
    with user_errors():
        import numpy as np

        from analysis import RunDirectory  # here, so that `narrows --help` stays fast
        from analysis.flow_export import SUFFIXES
        from analysis.flow_export import export as write
        from analysis.flow_grid import read_flow

        if file.suffix not in SUFFIXES:
            raise SceneError([f"{file}: must end with {' or '.join(SUFFIXES)}"])
        if run.is_file():
            field = read_flow(run)
            if skip >= len(field.steps):
                raise SceneError([f"skip = {skip}: {run} has {len(field.steps)} averages"])
            used = np.arange(len(field.steps)) >= skip
        elif skip:
            raise SceneError([f"skip = {skip}: only of a file; a run leaves its equilibration out"])
        else:
            opened = RunDirectory(run)
            field = opened.field()
            used = opened.flow_used(field)
        content = f"averages: {len(field.steps)}"
        if file.suffix == ".vti":
            content = f"mean of averages: {np.count_nonzero(used)}"
            field = field.mean(used)
        write(field, file)
        shape = " x ".join(map(str, field.counts[0].shape))
        say(f"{file}: {shape} bins, {content}")

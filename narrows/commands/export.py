"""`narrows export`: the flow field of a run for other programs."""

from pathlib import Path
from typing import Annotated

import typer

from lammps_inputs import SceneError
from narrows.messages import say, user_errors


def export(
    directory: Annotated[Path, typer.Argument(metavar="RUN", help="a run with a flow_interval")],
    file: Annotated[
        Path, typer.Argument(metavar="FILE", help="ending .vti (ParaView, OVITO) or .npz (numpy)")
    ],
) -> None:
    """Write the flow field: .vti, its mean after the equilibration; .npz, every average."""
    with user_errors():
        from analysis import RunDirectory  # here, so that `narrows --help` stays fast
        from analysis.flow_export import SUFFIXES
        from analysis.flow_export import export as write

        if file.suffix not in SUFFIXES:
            raise SceneError([f"{file}: must end with {' or '.join(SUFFIXES)}"])
        run = RunDirectory(directory)
        field = run.field()
        if file.suffix == ".vti":
            field = field.mean(run.flow_used(field))
        write(field, file)
        shape = " x ".join(map(str, field.counts[0].shape))
        say(f"{file}: averages of {shape} bins: {len(field.steps)}")

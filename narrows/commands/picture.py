"""`narrows picture` and `narrows movie`: a run to be seen."""

from pathlib import Path
from typing import Annotated

import typer

from lammps_inputs import SceneError
from narrows.messages import say, user_errors
from narrows.progress import progress_of_pictures

Directory = Annotated[Path, typer.Argument(metavar="RUN", help="a run with particles")]


def picture(
    directory: Directory,
    time: Annotated[
        float | None, typer.Option(help="of which output, in t0; default: the last")
    ] = None,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="FILE", help="default: RUN/picture.png")
    ] = None,
) -> None:
    """Draw the particles in their box: PNG, PDF or SVG, by the ending of FILE."""
    from analysis.run_directory import RunDirectory  # here, so that `narrows --help` stays fast
    from analysis.system_picture import draw, frame_at

    with user_errors():
        run = RunDirectory(directory)
        figure = draw(run, frame_at(run, time))
        file = out or directory / "picture.png"
        try:
            figure.savefig(file, dpi=150)
        except ValueError as error:  # an ending that is no format
            raise SceneError([f"{file}: {error}"]) from None
        say(f"written: {file}")


def movie(
    directory: Directory,
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="FILE", help="ending .gif or .mp4; default: RUN/movie.gif"),
    ] = None,
    pictures: Annotated[
        int, typer.Option(min=2, max=10_000, help="at most so many, evenly spaced in time")
    ] = 150,
) -> None:
    """Draw the whole run as a movie, 15 pictures a second; .mp4 needs imageio-ffmpeg."""
    from analysis.movie import SUFFIXES, write_movie
    from analysis.run_directory import RunDirectory

    with user_errors():
        file = out or directory / "movie.gif"
        if file.suffix not in SUFFIXES:
            raise SceneError([f"{file}: must end with {' or '.join(SUFFIXES)}"])
        run = RunDirectory(directory)
        try:
            with progress_of_pictures() as report:
                write_movie(run, file, pictures, report)
        except ImportError:
            raise SceneError(
                [f"{file}: needs an encoder: pip install imageio-ffmpeg; or ask for .gif"]
            ) from None
        say(f"written: {file}")

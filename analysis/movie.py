"""A run as a movie: its pictures one after the other, as GIF, or as MP4 where an encoder is."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from numpy.typing import NDArray
from PIL import Image

from analysis.run_directory import RunDirectory
from analysis.system_picture import draw
from run_files.writing import replacing

PICTURES_A_SECOND = 15
DOTS = 90  # an inch
SUFFIXES = (".gif", ".mp4")

Picture = NDArray[np.uint8]
Report = Callable[[int, int], None]


def write_movie(run: RunDirectory, path: Path, pictures: int, report: Report | None = None) -> None:
    """Write a movie of evenly spaced outputs, the first and the last among them.

    Args:
        path: ending `.gif` or `.mp4`; the latter needs imageio-ffmpeg.
        pictures: at most so many.
        report: called with the pictures drawn and all.

    Raises:
        RunDirectoryError: when the run has no particles, or its trajectory cannot be read.
        ImportError: for .mp4 without imageio-ffmpeg.
        OSError: when it cannot be written.
    """
    count = len(run.particles().steps)
    frames = np.unique(np.linspace(0, count - 1, min(pictures, count)).round().astype(int))

    def drawn() -> Iterator[Picture]:
        for number, frame in enumerate(frames, start=1):
            yield _picture(run, int(frame))
            if report:
                report(number, len(frames))

    write = _write_mp4 if path.suffix == ".mp4" else _write_gif
    with replacing(path) as draft:
        write(draft, drawn())


def _picture(run: RunDirectory, frame: int) -> Picture:
    """RGB, height and width even, as encoders want them: (H, W, 3)."""
    figure = draw(run, frame)
    figure.set_dpi(DOTS)
    canvas: Any = FigureCanvasAgg(figure)
    canvas.draw()
    pixels = np.asarray(canvas.buffer_rgba())[:, :, :3]
    height, width = (size // 2 * 2 for size in pixels.shape[:2])
    return np.ascontiguousarray(pixels[:height, :width])


def _write_gif(path: Path, pictures: Iterator[Picture]) -> None:
    images = [Image.fromarray(each).quantize(64) for each in pictures]
    images[0].save(
        path,
        format="GIF",
        save_all=True,
        append_images=images[1:],
        duration=1000 // PICTURES_A_SECOND,
        loop=0,
    )


def _write_mp4(path: Path, pictures: Iterator[Picture]) -> None:
    import imageio_ffmpeg

    first = next(pictures)
    height, width = first.shape[:2]
    writer = imageio_ffmpeg.write_frames(
        str(path),
        (width, height),
        fps=PICTURES_A_SECOND,
        macro_block_size=2,
        output_params=["-f", "mp4"],
    )
    writer.send(None)
    writer.send(first.tobytes())
    for each in pictures:
        writer.send(each.tobytes())
    writer.close()

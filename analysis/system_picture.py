"""The particles in their box, to be seen: in 2D between their walls, in 3D from outside."""

import math
from itertools import product

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray

from analysis.arrays import Array
from analysis.chain import head_order
from analysis.periodic import wrapped
from analysis.run_directory import RunDirectory
from run_files import RunDirectoryError

LONGEST_ROW = 16.0  # length over width; longer slits go on in the next row
WIDTH = 9.0  # of a 2D picture [inches]
POINT = 0.25  # drawn for a particle without a radius [a0]
VIEW = (math.radians(25), math.radians(20))  # in 3D: turned about z, then looked at from above
FAR = 0.55  # how pale the farthest particles are


def frame_at(run: RunDirectory, time: float | None) -> int:
    """Number of the frame nearest to a time, of the last one for None.

    Raises:
        RunDirectoryError: for a time that lies more than a sampling interval from all.
    """
    times = run.times(run.particles().steps)
    if time is None:
        return len(times) - 1
    frame = int(np.argmin(np.abs(times - time)))
    if not abs(times[frame] - time) <= run.interval:
        raise RunDirectoryError(
            f"{run.path}: no output at time {time:g}; they are from 0 to {times[-1]:g} t0"
        )
    return frame


def draw(run: RunDirectory, frame: int = -1, colours: Array | None = None) -> Figure:
    """The particles of a frame as circles of their radii.

    Several species have a colour each; of a single one the head of the chain is dark, the tail
    light, by their order at the start.

    Args:
        run: with particles.
        frame: its number.
        colours: of the particles, (N, 4), in place of those.

    Raises:
        RunDirectoryError: when there are no particles, or the trajectory cannot be read.
    """
    particles = run.particles()
    positions = wrapped(particles.positions[frame], run.box.sizes)
    if colours is None:
        colours = _colours(run, particles.positions[0, :, 0], particles.species)
    radii = np.array([run.species(name).radius or POINT for name in particles.species])
    picture = _flat if run.box.dimensions == 2 else _solid
    figure = picture(run, positions, radii, colours)
    time = run.times(particles.steps)[frame]
    figure.suptitle(f"{run.manifest.scene}, $t$ = {time:.0f} $t_0$", fontsize="medium")
    return figure


def _colours(run: RunDirectory, start: Array, species: NDArray[np.str_]) -> Array:
    names = list(dict.fromkeys(species))
    if len(names) > 1:
        number = np.array([names.index(name) for name in species])
        return np.asarray(colormaps["tab10"](number % 10), dtype=float)
    order = head_order(start, float(run.acceleration(names[0])[0]))
    shade = np.empty(len(order))
    shade[order] = np.linspace(0.05, 0.85, len(order))
    return np.asarray(colormaps["viridis"](shade), dtype=float)


def _flat(run: RunDirectory, positions: Array, radii: Array, colours: Array) -> Figure:
    """Rows of the slit, one above the other, every one to scale."""
    length, width = run.box.sizes
    rows = math.ceil(length / width / LONGEST_ROW)
    row_length = length / rows
    height = rows * (WIDTH - 0.8) * width / row_length + 0.9
    figure = Figure(figsize=(WIDTH, height), layout="constrained")
    shifts = [
        (0.0, -size, size) if periodic else (0.0,)
        for size, periodic in zip(run.box.sizes, run.box.periodic, strict=True)
    ]
    images = np.concatenate([positions + np.array(shift) for shift in product(*shifts)])
    copies = len(images) // len(positions)
    panels = figure.subplots(rows, 1, squeeze=False)[:, 0]
    for row, axes in enumerate(panels):
        _circles(axes, images, np.tile(radii, copies), np.tile(colours, (copies, 1)))
        axes.set(xlim=(row * row_length, (row + 1) * row_length), ylim=(0, width), aspect="equal")
        for wall in run.manifest.system.walls:
            ends = run.box.sizes[wall.axis]
            place = 0.0 if wall.side == "lower" else ends
            line = axes.axvline if wall.axis == 0 else axes.axhline
            line(place, color="0.25", linewidth=4)
    panels[-1].set_xlabel("$x$ [$a_0$]")
    for axes in panels:
        axes.set_ylabel("$y$ [$a_0$]")
    return figure


def _solid(run: RunDirectory, positions: Array, radii: Array, colours: Array) -> Figure:
    """Seen from outside, without perspective; what is farther off is paler and behind."""
    across, up, depth = _view(positions, run.box.sizes).T
    order = np.argsort(-depth)
    pale = FAR * (depth - depth.min()) / max(np.ptp(depth), 1e-9)
    shown = colours.copy()
    shown[:, :3] += (1 - shown[:, :3]) * pale[:, None]
    figure = Figure(figsize=(7, 7), layout="constrained")
    axes = figure.subplots()
    for first, second in _edges(run.box.sizes):
        ends = _view(np.array([first, second]), run.box.sizes)
        axes.plot(ends[:, 0], ends[:, 1], color="0.6", linewidth=0.8, zorder=1)
    _circles(axes, np.column_stack([across, up])[order], radii[order], shown[order])
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.set_axis_off()
    return figure


def _view(points: Array, sizes: tuple[float, ...]) -> Array:
    """Across, up and depth of points as they are looked at, (N, 3)."""
    turn, above = VIEW
    x, y, z = (points - np.array(sizes) / 2).T
    across, behind = (
        math.cos(turn) * x + math.sin(turn) * y,
        math.cos(turn) * y - math.sin(turn) * x,
    )
    up = math.cos(above) * z + math.sin(above) * behind
    return np.column_stack([across, up, math.cos(above) * behind - math.sin(above) * z])


def _edges(sizes: tuple[float, ...]) -> list[tuple[tuple[float, ...], tuple[float, ...]]]:
    """The twelve edges of the box, by their two corners."""
    corners = list(product(*((0.0, size) for size in sizes)))
    return [
        (a, b)
        for number, a in enumerate(corners)
        for b in corners[number + 1 :]
        if sum(p != q for p, q in zip(a, b, strict=True)) == 1
    ]


def _circles(axes: Axes, centres: Array, radii: Array, colours: Array) -> None:
    circles = EllipseCollection(
        2 * radii,
        2 * radii,
        np.zeros(len(radii)),
        units="xy",
        offsets=centres,
        offset_transform=axes.transData,
        facecolors=colours,
        edgecolors="black",
        linewidths=0.4,
        zorder=2,
    )
    axes.add_collection(circles)

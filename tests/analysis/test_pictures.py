"""A run to be seen: pictures, movies, and what a short run does not show."""

from pathlib import Path

import matplotlib.image
import numpy as np
import pytest
from PIL import Image

from analysis import RunDirectory, RunDirectoryError
from analysis.measures import pair_correlation, settling_speed, slit_flow, zigzag
from analysis.movie import write_movie
from analysis.system_picture import draw, frame_at
from tests.analysis import run_writer


def write(path: Path, frames: int = 21, colloids: int = 3, seed: int = 1) -> RunDirectory:
    """Colloids in the slit of 40 x 10, 10 apart, that move by 1 a frame and tremble."""
    random = np.random.default_rng(seed)
    start = np.column_stack([5 + 10.0 * np.arange(colloids), np.full(colloids, 5.0)])
    moved = np.arange(frames)[:, None] * np.array([1.0, 0.0])
    positions = start + moved[:, None] + 0.1 * random.normal(size=(frames, colloids, 2))
    speeds = np.zeros(frames - 1)
    run_writer.write_channel(path, positions, np.zeros_like(positions), speeds)
    return RunDirectory(path)


def test_colloids_are_drawn_where_they_are_with_their_images(tmp_path: Path) -> None:
    run = write(tmp_path)
    figure = draw(run, 12)
    (axes,) = figure.axes
    assert axes.get_xlim() == (0, 40)
    assert axes.get_ylim() == (0, 10)
    (circles,) = axes.collections
    centres = np.asarray(circles.get_offsets())
    here = run.particles().positions[12] % np.array([40, 10])
    assert len(centres) == 9  # each with its images to the left and the right
    np.testing.assert_allclose(centres[:3], here)
    np.testing.assert_allclose(
        sorted(centres[:, 0]), sorted([*here[:, 0], *(here[:, 0] - 40), *(here[:, 0] + 40)])
    )
    walls = [line for line in axes.lines if line.get_linewidth() > 3]
    assert sorted(float(np.asarray(line.get_ydata())[0]) for line in walls) == [0, 10]
    assert "12 $t_0$" in str(figure.get_suptitle())


def test_a_long_slit_goes_on_in_the_next_row(tmp_path: Path) -> None:
    system = run_writer.channel(2)
    system["box"]["sizes"] = [400.0, 10.0]
    run_writer.write_manifest(tmp_path, "channel", system)
    positions = np.array([[[10.0, 5.0], [390.0, 5.0]]] * 2)
    run_writer.write_trajectory(tmp_path, positions, positions * 0, length=400.0)
    run_writer.write_observables(tmp_path, np.ones(1), np.zeros(1))
    limits = [axes.get_xlim() for axes in draw(RunDirectory(tmp_path)).axes]
    assert [low for low, _ in limits] == pytest.approx([0, 400 / 3, 800 / 3])
    assert limits[-1][1] == pytest.approx(400)


def test_three_dimensions_are_seen_from_outside(tmp_path: Path) -> None:
    """The nearest of two spheres is drawn last, and the farther one is paler."""
    from lammps_inputs import make_scene
    from srd_driver import Simulation

    times = {"duration": 0.4, "equilibration": 0, "sampling_interval": 0.2}
    scene = make_scene("pore", particles=30, packing_fraction=0.1, trajectory=1, **times)
    with Simulation(scene, directory=tmp_path) as simulation:
        simulation.finish()
    (axes,) = draw(RunDirectory(tmp_path)).axes
    (circles,) = axes.collections
    assert len(np.asarray(circles.get_offsets())) == 30
    assert len(axes.lines) == 12  # edges of the box
    paleness = np.asarray(circles.get_facecolor())[:, :3].min(axis=1)
    assert paleness[:5].mean() > paleness[-5:].mean()


def test_the_frame_of_a_time(tmp_path: Path) -> None:
    run = write(tmp_path)
    assert frame_at(run, None) == 20
    assert frame_at(run, 7.4) == 7
    with pytest.raises(RunDirectoryError, match="no output at time 99; they are from 0 to 20 t0"):
        frame_at(run, 99.0)


def test_a_movie_shows_the_first_and_the_last_output(tmp_path: Path) -> None:
    run = write(tmp_path)
    told: list[tuple[int, int]] = []
    write_movie(run, tmp_path / "m.gif", 5, lambda done, total: told.append((done, total)))
    assert told == [(1, 5), (2, 5), (3, 5), (4, 5), (5, 5)]
    with Image.open(tmp_path / "m.gif") as movie:
        assert getattr(movie, "n_frames", 1) == 5
        width, height = movie.size
        movie.seek(4)
        last = np.asarray(movie.convert("RGB"), dtype=float)
    draw(run, 20).savefig(tmp_path / "last.png", dpi=90)
    picture = 255 * matplotlib.image.imread(tmp_path / "last.png")[:height, :width, :3]
    assert np.abs(last - picture).mean() < 4  # of 255: 64 colours stand for all


def test_an_mp4_where_its_encoder_is(tmp_path: Path) -> None:
    pytest.importorskip("imageio_ffmpeg")
    write_movie(write(tmp_path), tmp_path / "m.mp4", 3)
    assert b"ftyp" in (tmp_path / "m.mp4").read_bytes()[:16]


def test_a_short_run_of_few_colloids_has_no_picture_of_noise(tmp_path: Path) -> None:
    """Neither g(x) nor a chain of one row; both are said."""
    run = write(tmp_path)
    found = pair_correlation.measure(run)
    assert not found.figures
    (line,) = found.left_out
    assert line.startswith("g(x): noise of ")
    assert "; run longer, at least" in line
    (picture,) = zigzag.measure(run).figures.values()
    assert len(picture.axes) == 1
    assert zigzag.measure(run).left_out == (
        "zigzag about each colloid: a picture takes 5 colloids",
    )
    (whole,) = zigzag.measure(write(tmp_path / "more", colloids=4)).figures.values()
    assert len(whole.axes) == 1
    (chain,) = zigzag.measure(write(tmp_path / "chain", colloids=5)).figures.values()
    assert len(chain.axes) == 3  # the whole, about each colloid, and its colours


def test_noise_of_the_pair_correlation_is_its_scatter() -> None:
    """Of independent points it is Poisson's: one over the root of the pairs in a bin."""
    random = np.random.default_rng(3)
    x = random.uniform(0, 40, (400, 10))
    pairs = 400 * 10 * 9 / 2 / 200  # in a bin of 0.1 of half the length
    noise = pair_correlation.between_halves(x, 40.0)
    assert noise == pytest.approx(1 / np.sqrt(pairs), rel=0.15)


def test_the_profile_has_error_bars_and_the_speed_its_scale(tmp_path: Path) -> None:
    run = write(tmp_path, frames=61)
    (profile,) = slit_flow.measure(run).figures.values()
    assert profile.axes[0].containers  # error bars
    found = settling_speed.measure(run)
    low, high = found.figures["settling_speed.png"].axes[0].get_ylim()
    speed = found.entries["settling_speed"]
    assert low < 0 < speed["value"] < high < 2 * speed["value"]

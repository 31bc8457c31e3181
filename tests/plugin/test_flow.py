"""The flow field of fix mpc: what numpy makes of the saved fluid, on any number of processes."""

import base64
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from numpy.typing import NDArray

from analysis import RunDirectory, RunDirectoryError
from analysis.flow_grid import FlowField, read_flow
from lammps_inputs import Scene, SceneError, make_scene
from lammps_inputs.deck import check_engine
from lammps_inputs.engines.engine import Start
from srd_driver import Simulation
from srd_driver.resume import write_scene
from tests.conftest import Run
from tests.plugin.fluid import run_mpc

COLLISIONS = 8
FIELDS = {"sampling_interval": 0.03, "equilibration": 0, "duration": 0.12, "flow_interval": 0.12}


def channel(around: int = 0, **more: float) -> Scene:
    fields = FIELDS | {"length": 21, "flow_bin": 1.5, "flow_around": around} | more
    return make_scene("channel", colloids=3, **fields)


def bins_of(scene: Scene, positions: NDArray[np.float64]) -> NDArray[np.int64]:
    flow = scene.system.flow
    assert flow
    edges = np.array(scene.system.box.sizes) / flow.bins
    rows = np.minimum((positions // edges).astype(int), np.array(flow.bins) - 1)
    return np.asarray(np.ravel_multi_index(tuple(rows.T), flow.bins))


def field_of(scene: Scene, folder: Path) -> FlowField:
    write_scene(scene, "mpc", folder)
    return RunDirectory(folder).field()


@pytest.mark.parametrize(("around", "processes"), [(0, 1), (2, 1), (2, 2)])
def test_it_is_the_mean_over_what_was_saved(
    around: int, processes: int, tmp_path: Path, command: Run
) -> None:
    scene = channel(around)
    clock, flow = scene.system.clock, scene.system.flow
    assert flow
    looks = range(clock.look_steps, clock.total_steps + 1, clock.look_steps)
    total = np.zeros((int(np.prod(flow.bins)), 4))
    for step in looks:  # each is a run of its own, of which the last state is saved
        at = run_mpc(scene, step // clock.steps_per_collision, tmp_path / str(step), command)
        positions = at.fluid_positions.copy()
        if around:
            centre = at.colloid_positions[around - 1, 0]
            positions[:, 0] = (positions[:, 0] - centre + 10.5) % 21
        bins = bins_of(scene, positions)
        velocity = at.fluid_velocities
        for column, weight in enumerate((None, *velocity.T, (velocity**2).sum(axis=1) / 2)):
            total[:, column] += np.bincount(bins, weight, minlength=len(total))
    folder = tmp_path / "run"
    run_mpc(scene, COLLISIONS, folder, command, processes)
    field = field_of(scene, folder)
    shape = flow.bins
    np.testing.assert_allclose(field.counts[0], total[:, 0].reshape(shape) / len(looks), rtol=1e-5)
    occupied = np.maximum(total[:, 0], 1)[:, None]
    np.testing.assert_allclose(
        field.velocity[0], (total[:, 1:3] / occupied).reshape(*shape, 2), atol=2e-5
    )
    np.testing.assert_allclose(
        field.temperature[0], (total[:, 3:] / occupied).reshape(shape), rtol=1e-5
    )
    middle = -21 / 2 if around else 0.0
    np.testing.assert_allclose(field.axes[0], middle + 1.5 * (np.arange(14) + 0.5), rtol=1e-5)


def test_an_average_under_way_goes_on(tmp_path: Path) -> None:
    scene = channel(1, duration=0.24)
    with Simulation(scene, directory=tmp_path / "whole") as whole:
        whole.finish()
    with Simulation(scene, directory=tmp_path / "parts") as first:
        first.run(0.06)  # half of the first average
        first.checkpoint()
    with Simulation(scene, directory=tmp_path / "parts", resume=True) as second:
        second.finish()
    texts = [(tmp_path / name / "flow.dat").read_bytes() for name in ("whole", "parts")]
    assert texts[0] == texts[1]
    assert len(RunDirectory(tmp_path / "parts").field().steps) == 2


def test_on_other_processes_it_goes_on_too(tmp_path: Path, command: Run) -> None:
    scene = channel(1)
    run_mpc(scene, COLLISIONS, tmp_path / "whole", command)
    parts, half = tmp_path / "parts", COLLISIONS // 2
    run_mpc(scene, half, parts, command, 2, end="write_restart half.restart\n")
    step = half * scene.system.clock.steps_per_collision
    run_mpc(scene, COLLISIONS, parts, command, start=Start(step, "half.restart"))
    whole, gone_on = (field_of(scene, tmp_path / name) for name in ("whole", "parts"))
    np.testing.assert_allclose(gone_on.velocity, whole.velocity, atol=1e-5)
    np.testing.assert_array_equal(gone_on.counts, whole.counts)


def test_in_three_dimensions(tmp_path: Path, command: Run) -> None:
    fields = {"dimension": 3, "length": 6, "width": 4, "height": 4, "flow_bin": 2.0}
    scene = make_scene(
        "bulk", **fields, collision_time=0.03, **FIELDS | {"sampling_interval": 0.06}
    )
    run_mpc(scene, 4, tmp_path, command)
    field = field_of(scene, tmp_path)
    assert field.counts.shape == (1, 3, 2, 2)
    assert field.counts.sum() == pytest.approx(10 * 6 * 4 * 4, rel=1e-5)
    momentum = (field.counts[..., None] * field.velocity).sum(axis=(0, 1, 2, 3))
    np.testing.assert_allclose(momentum, 0, atol=0.05)  # printed to six digits
    np.testing.assert_allclose(field.axes[2], [1, 3])


def numbers(array: ElementTree.Element) -> NDArray[np.float64]:
    """What a DataArray of a .vti file holds: its length in bytes, then the numbers."""
    assert array.text
    content = base64.b64decode(array.text)
    assert int.from_bytes(content[:8], "little") == len(content) - 8
    return np.frombuffer(content[8:], dtype="<f8")


def test_the_flow_of_a_deck_of_ones_own_is_read_and_exported(tmp_path: Path, command: Run) -> None:
    """As that of a run directory is: it is the same file."""
    scene = channel(1, duration=0.24)
    run_mpc(scene, 2 * COLLISIONS, tmp_path / "run", command)
    whole = field_of(scene, tmp_path / "run")
    alone = tmp_path / "alone.dat"
    alone.write_bytes((tmp_path / "run" / "flow.dat").read_bytes() + b"480 98 9\n 1 -9.75 0.7")
    field = read_flow(alone)
    for name in ("steps", "counts", "velocity", "temperature"):
        np.testing.assert_array_equal(getattr(field, name), getattr(whole, name))
    np.testing.assert_array_equal(field.axes[1], whole.axes[1])
    command("narrows", "export", alone, tmp_path / "a.vti", "--skip", "1")
    image = ElementTree.parse(tmp_path / "a.vti").getroot()[0]
    np.testing.assert_array_equal(numbers(image[0][0][0]), whole.counts[1].ravel(order="F"))
    refused = command("narrows", "export", alone, tmp_path / "a.vti", "--skip", "2", succeed=False)
    assert "skip = 2: " in refused.stderr
    assert "has 2 averages" in refused.stderr


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "not a flow field of fix mpc"),
        ("# Chunk Coord1 Ncount density/number vx temp\n", "not a flow field of fix mpc"),
        ("{head}", "no complete sampling interval yet"),
        ("{head}8 2 9\n 1 0 0 1 1 0 0 1\n", "no complete sampling interval yet"),
        ("{head}8 1 9\n 1 0 0 1 1 x 0 1\n", "holds text among numbers"),
        ("{head}8 1 9\n 1 0 0 1 1 nan 0 1\n", "not finite"),
        ("{head}8 0 9\n", "0 bins"),
        ("{head}8 3 9\n 1 0 0 1 1 0 0 1\n 2 0 1 1 1 0 0 1\n 3 1 0 1 1 0 0 1\n", "no grid"),
    ],
)
def test_what_is_no_flow_is_refused(text: str, message: str, tmp_path: Path) -> None:
    file = tmp_path / "flow.dat"
    file.write_text(text.format(head="# Chunk Coord1 Coord2 Ncount density/number vx vy temp\n"))
    with pytest.raises(RunDirectoryError, match=message):
        read_flow(file)


def test_it_is_drawn_and_exported(tmp_path: Path, command: Run) -> None:
    run = tmp_path / "run"
    scene = channel(2, duration=0.24)
    with Simulation(scene, directory=run) as simulation:
        simulation.finish()
    command("narrows", "analyze", run)
    assert (run / "flow.png").is_file()
    command("narrows", "export", run, tmp_path / "flow.npz")
    arrays = np.load(tmp_path / "flow.npz")
    field = RunDirectory(run).field()
    np.testing.assert_array_equal(arrays["velocity"], field.velocity)
    np.testing.assert_array_equal(arrays["y"], field.axes[1])
    command("narrows", "export", run, tmp_path / "flow.vti")
    image = ElementTree.parse(tmp_path / "flow.vti").getroot()[0]
    assert image.attrib["WholeExtent"] == "0 14 0 7 0 1"
    spacing = [float(each) for each in image.attrib["Spacing"].split()]
    assert spacing == pytest.approx([1.5, 10 / 7, 1], abs=1e-4)  # of printed places
    assert image.attrib["Origin"].split()[::2] == ["-10.5", "0.0"]
    arrays = {each.attrib["Name"]: numbers(each) for each in image[0][0]}
    mean = field.mean()
    np.testing.assert_array_equal(arrays["count"], mean.counts[0].ravel(order="F"))  # x is fastest
    np.testing.assert_array_equal(arrays["temperature"], mean.temperature[0].ravel(order="F"))
    velocity = arrays["velocity"].reshape(-1, 3)
    np.testing.assert_array_equal(velocity[:, 1], mean.velocity[0, ..., 1].ravel(order="F"))
    assert not velocity[:, 2].any()
    named = image[0][0].find("*[@Name='velocity']")
    assert named is not None  # OVITO selects components by name
    assert [named.attrib[f"ComponentName{n}"] for n in range(3)] == ["X", "Y", "Z"]
    refused = command("narrows", "export", run, tmp_path / "flow.csv", succeed=False)
    assert "must end with .vti or .npz" in refused.stderr


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"flow_around": 4}, "flow_around = 4: must be at most 3, the last colloid"),
        ({"flow_bin": 0.001}, "flow_bin = 0.001: makes more than 1000000 bins"),
        ({"flow_interval": 0.2}, "flow_interval = 0.2: no whole average of the run's 0.12 t0"),
    ],
)
def test_what_the_scene_refuses(fields: dict[str, float], message: str) -> None:
    with pytest.raises(SceneError) as error:
        make_scene("channel", colloids=3, length=21, **FIELDS | fields)
    assert message in str(error.value)
    with pytest.raises(SceneError, match="engine srd tells no flow field"):
        check_engine(channel(), "srd")

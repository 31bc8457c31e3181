"""docs/examples/mpc: every deck runs as it stands and shows what its first lines say."""

import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from analysis.flow_grid import read_flow
from lammps_inputs.viscosity import viscosity
from run_files.fluid_file import read_fluid
from tests.conftest import ROOT, Run
from tests.dumps import frames

DECKS = sorted((ROOT / "docs" / "examples" / "mpc").glob("in.*"))
HEIGHT = 20.0  # of the slits


def run_deck(name: str, folder: Path, command: Run, *settings: str) -> str:
    """What LAMMPS said of a deck, which must be no warning."""
    shutil.copy(ROOT / "docs" / "examples" / "mpc" / name, folder)
    words = [word for setting in settings for word in ("-var", *setting.split("="))]
    said = command("lmp", "-in", name, *words, cwd=folder).stdout
    assert "WARNING" not in said
    return said


def thermo(said: str) -> NDArray[np.float64]:
    """The rows of the last run's thermo output."""
    table = re.findall(r"^ *Step.*\n((?: +[-\d].*\n)+)", said, re.MULTILINE)[-1]
    return np.array([line.split() for line in table.splitlines()], dtype=float)


def profile(file: Path) -> NDArray[np.float64]:
    """Mean of the blocks after the first two: rows of chunk, y, count, density, vx, temp."""
    rows = [line.split() for line in file.read_text().splitlines() if line.startswith("  ")]
    bins = int(file.read_text().splitlines()[3].split()[1])
    blocks = np.array(rows, dtype=float).reshape(-1, bins, 6)
    return np.asarray(blocks[2:].mean(axis=0))


def test_a_fluid_in_2d(tmp_path: Path, command: Run) -> None:
    step, temperature, *momentum, particles = thermo(run_deck("in.fluid2d", tmp_path, command)).T
    assert step[-1] == 1000
    np.testing.assert_allclose(momentum, 0, atol=1e-9)
    np.testing.assert_allclose(temperature, 1, atol=0.02)  # of 64 layers, each about its own flow
    assert set(particles) == {10240}


def test_a_fluid_in_3d(tmp_path: Path, command: Run) -> None:
    _, temperature, *momentum = thermo(run_deck("in.fluid3d", tmp_path, command)).T
    np.testing.assert_allclose(momentum, 0, atol=1e-8)
    np.testing.assert_allclose(temperature, 1, atol=0.02)
    fluid = read_fluid(tmp_path / "fluid3d.fluid")
    assert fluid.positions.shape == (40960, 3)
    # components of 40960 unit normals: their variance is known to 0.7 %
    np.testing.assert_allclose(fluid.velocities.var(axis=0), 1, atol=0.03)


def test_poiseuille_flow(tmp_path: Path, command: Run) -> None:
    """The height of the parabola is that of kinetic theory's viscosity: seeds scatter by 1.8 %."""
    gravity = 0.008
    run_deck("in.poiseuille", tmp_path, command, f"gravity={gravity}")
    _, y, _, density, velocity, _ = profile(tmp_path / "poiseuille.profile").T
    shape = 4 * y * (HEIGHT - y) / HEIGHT**2
    slip, height = np.polynomial.polynomial.polyfit(shape, velocity, 1)
    expected = gravity * HEIGHT**2 / (8 * viscosity(10, 0.1, 90))
    assert height == pytest.approx(expected, rel=0.08)
    assert 0 < slip < 0.15 * height
    np.testing.assert_allclose(density, 10, rtol=0.1)


def test_couette_flow(tmp_path: Path, command: Run) -> None:
    """A line from -U to U, less the slip of 0.2 cells at either wall: seeds scatter by 2.2 %."""
    run_deck("in.couette", tmp_path, command, "U=0.2")
    _, y, _, _, velocity, _ = profile(tmp_path / "couette.profile").T
    middle, slope = np.polynomial.polynomial.polyfit(y - HEIGHT / 2, velocity, 1)
    assert slope == pytest.approx(2 * 0.2 / (HEIGHT + 2 * 0.2), rel=0.09)
    assert abs(middle) < 0.05


def test_colloids_settle_and_a_restart_goes_on_to_the_last_bit(
    tmp_path: Path, command: Run
) -> None:
    said = run_deck("in.colloids", tmp_path, command)
    assert thermo(said)[1:, 2].mean() > 0  # along the pull
    run_deck("in.restart", tmp_path, command)
    halves = frames(tmp_path / "restarted.lammpsdump")
    run_deck("in.colloids", tmp_path, command, "steps=60000")
    whole = frames(tmp_path / "colloids.lammpsdump")
    assert list(whole) == list(range(0, 60001, 3000))
    for step, rows in halves.items():
        np.testing.assert_array_equal(rows, whole[step])
    start, end = whole[0], whole[60000]
    assert not np.array_equal(start, end)


def test_the_fluid_flows_along_with_a_colloid(tmp_path: Path, command: Run) -> None:
    """None is inside, and before and behind it the fluid is faster than half a box away."""
    run_deck("in.flow", tmp_path, command)
    rows = [line.split() for line in (tmp_path / "flow.dat").read_text().splitlines()]
    bins = np.array([row for row in rows if len(row) == 8 and row[0] != "#"], dtype=float)
    _, x, y, count, _, vx, *_ = bins.reshape(-1, 80 * 20, 8)[1:].transpose(2, 0, 1)
    from_middle = x**2 + (y - 5) ** 2
    assert count[from_middle < 1].max() < 0.1
    near = (np.abs(x) < 4) & (np.abs(y - 5) < 2) & (count > 0.5)
    far = np.abs(x) > 14
    speeds = [np.average(vx[where], weights=count[where]) for where in (near, far)]
    assert speeds[0] > 2 * speeds[1]


def test_the_page_of_the_style_names_every_deck_first() -> None:
    page = (ROOT / "docs" / "fix_mpc.md").read_text(encoding="utf-8")
    before, _, _ = page.partition("## Syntax")
    assert len(DECKS) >= 6
    for deck in DECKS:
        assert f"(examples/mpc/{deck.name})" in before


PURE = (
    "units lj\ndimension 2\nboundary p f p\nregion box block 0 10 0 10 -0.5 0.5\n"
    "create_box 2 box\nmass * 1.0\ntimestep 0.1\n"
)
TWO_TYPES = (
    "create_atoms 1 single 3 5 0\ncreate_atoms 2 single 8 5 0\nmass * 12.6\n"
    "pair_style lj/cut 2.5\npair_coeff * * 1 1\ngroup big type 1 2\n"
    "neigh_modify delay 0 every 1 check no\ncomm_modify cutoff 4.0\n"
    "fix move big nve\n"
)


@pytest.mark.parametrize(
    ("deck", "warning"),
    [
        ("fix f all mpc 1 NULL 1 1 1 create 1000 density 10", None),
        (
            "fix f all mpc 1 NULL 1 1 1 create 1000 density 5",
            "density 5: the fluid has 10 particles in a cell",
        ),
        (
            f"{TWO_TYPES}fix f all mpc 1 big 1 1 1 create 936 density 10 force 1 1.0 1.0",
            "groupbig: the fluid does not feel atoms of type 2",
        ),
        (
            f"{TWO_TYPES}fix f all mpc 1 big 1 1 1 create 936 density 10 "
            "force 1 1.0 1.0 force 2 1.0 1.0",
            None,
        ),
        (f"{TWO_TYPES}fix f all mpc 1 big 1 1 1 create 1000 density 10 collide yes", None),
    ],
    ids=["pure", "density", "unfelt", "felt", "collide"],
)
def test_silent_mistakes_are_warned_of(
    deck: str, warning: str | None, tmp_path: Path, command: Run
) -> None:
    (tmp_path / "in.t").write_text(f"{PURE}{deck}\nrun 2\n")
    said = command("lmp", "-in", "in.t", cwd=tmp_path).stdout
    told = [line for line in said.splitlines() if "WARNING: fix mpc" in line]
    assert len(told) == (warning is not None)
    assert warning is None or warning in told[0]
    if deck.startswith("fix"):
        assert said.count("WARNING") == len(told)  # none of ghosts or sorting


def test_a_fluid_that_nobody_reads_is_warned_of(tmp_path: Path, command: Run) -> None:
    fluid = "fix {} all mpc 1 NULL 1 1 1 create 1000 density 10\nrun 2\n"
    (tmp_path / "in.a").write_text(f"{PURE}{fluid.format('water')}write_restart r\n")
    command("lmp", "-in", "in.a", cwd=tmp_path)
    for name, warned in (("water", False), ("fluid", True)):
        (tmp_path / "in.b").write_text(f"read_restart r\ntimestep 0.1\n{fluid.format(name)}")
        said = command("lmp", "-in", "in.b", cwd=tmp_path).stdout
        remedy = "ID fluid: the restart file holds the fluid of ID water, which is not read"
        assert (remedy in said) == warned


def test_the_sphere_for_ovito_and_the_python_of_its_page(
    tmp_path: Path,
    command: Run,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Shorter; sphere and fluid at the same steps, the fluid ahead of the sphere flows along."""
    run_deck("in.ovito", tmp_path, command, "steps=10000", "average=5000")
    sphere, fluid = (frames(tmp_path / f"{name}.lammpsdump") for name in ("sphere", "fluid"))
    assert list(sphere) == list(fluid) == list(range(0, 10001, 500))
    assert {len(rows) for rows in fluid.values()} == {3056}
    flow = read_flow(tmp_path / "flow.dat").mean()
    x, y, z = np.meshgrid(*flow.axes, indexing="ij")
    from_middle = np.sqrt(x**2 + y**2 + z**2)
    assert flow.counts[0][from_middle < 1].max() < 0.5
    page = (ROOT / "docs" / "ovito.md").read_text(encoding="utf-8")
    (block,) = re.findall(r"^```python\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    monkeypatch.chdir(tmp_path)
    exec(compile(block, "ovito.md", "exec"), {})
    assert "mean velocity" in capsys.readouterr().out
    assert (tmp_path / "flow.png").is_file()

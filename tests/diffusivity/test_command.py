"""`narrows diffusivity` on files of a known walk, in formats of others, and on bad input."""

import csv
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.conftest import Run
from tests.diffusivity import walks


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The same walk as GROMACS, DCD and LAMMPS files."""
    folder = tmp_path_factory.mktemp("walk")
    universe: Any = walks.universe(walks.walk(100, 1500, seed=3))
    universe.dimensions = [10, 10, 10, 90, 90, 90]
    universe.add_TopologyAttr("name", ["A"] * 100)
    for name in ("walk.gro", "walk.xtc", "walk.dcd"):
        frames = None if name == "walk.gro" else universe.trajectory
        for frame in universe.trajectory:
            frame.dimensions = [10, 10, 10, 90, 90, 90]
        universe.atoms.write(str(folder / name), frames=frames)
    with (folder / "walk.lammpsdump").open("w") as file:
        for number, frame in enumerate(universe.trajectory):
            file.write(f"ITEM: TIMESTEP\n{50 * number}\nITEM: NUMBER OF ATOMS\n100\n")
            file.write("ITEM: BOX BOUNDS pp pp pp\n0 10\n0 10\n0 10\nITEM: ATOMS id type x y z\n")
            for i, row in enumerate(frame.positions.tolist(), start=1):
                file.write(f"{i} 1 {row[0]} {row[1]} {row[2]}\n")
    return {path.suffix[1:]: path for path in folder.iterdir()}


def profiles(folder: Path, by: str) -> dict[str, np.ndarray[Any, Any]]:
    with (folder / "diffusivity.csv").open() as file:
        rows = list(csv.DictReader(file))
    return {
        name: np.array(
            [
                [float(row[key]) for key in ("z", "diffusivity", "error")]
                for row in rows
                if row["estimator"] == name
            ]
        ).T
        for name in by.split(",")
    }


@pytest.mark.parametrize(
    ("kind", "by", "given"),
    [
        ("xtc", "color,bayes", ()),
        ("dcd", "color", ("--dt", str(walks.FRAME))),
        ("lammpsdump", "color", ("--dt", str(walks.FRAME))),
    ],
)
def test_a_trajectory_of_others(
    files: dict[str, Path],
    kind: str,
    by: str,
    given: tuple[str, ...],
    tmp_path: Path,
    command: Run,
) -> None:
    told = command(
        *("narrows", "diffusivity", files[kind]),
        *(() if kind == "lammpsdump" else ("--topology", files["gro"])),
        *("--axis", "z", "--out", tmp_path, "--by", by, *given),
    )
    assert all(f"{name}: D = " in told.stdout for name in by.split(","))
    middle = re.search(r"displacements from the middle third: D = (\S+) \+- (\S+),", told.stdout)
    assert middle
    # D is 0.5 in the middle and 0.75 a quarter of the width away
    assert 0.45 < float(middle[1]) < 0.75
    assert (tmp_path / "diffusivity.png").stat().st_size > 1000
    for name, (z, d, _) in profiles(tmp_path, by).items():
        middle = abs(z - walks.LENGTH / 2) < 1.2
        ratio = d[middle] / walks.diffusivity(z[middle])
        assert np.median(ratio) == pytest.approx(1, abs=0.2), name


BAD = [
    (["nowhere.xtc"], "nowhere.xtc: no such file"),
    (["{xtc}", "--topology", "nowhere.gro"], "nowhere.gro: no such file"),
    ([__file__], "MDAnalysis cannot read it"),
    (["{xtc}", "--dt", "-1"], "dt = -1: must be positive"),
    (["{gro}"], "1 frames; at least 2 are needed"),
    (["{xtc}", "--topology", "{gro}", "--axis", "w"], "axis: 'w'; it must be 'x', 'y' or 'z'"),
    (["{xtc}", "--topology", "{gro}", "--axis", "x"], "axis = 'x': all particles stay at 5"),
    (["{xtc}", "--topology", "{gro}", "--select", "name B"], "select = 'name B': no atom of 100"),
    (["{xtc}", "--topology", "{gro}", "--select", "nonsense ("], "select = 'nonsense (': "),
    (["{xtc}", "--topology", "{gro}", "--low", "3", "--high", "1"], "low = 3, high = 1: must be"),
    (["{xtc}", "--topology", "{gro}", "--high", "99"], "within the positions"),
    (["{xtc}", "--topology", "{gro}", "--bins", "2", "--by", "bayes"], "bins: 2; at least 3 are"),
    (["{xtc}", "--topology", "{gro}", "--by", "guess"], "estimator = 'guess': must be one of"),
]


@pytest.mark.parametrize(("words", "message"), BAD)
def test_bad_input_is_named(
    words: list[str], message: str, files: dict[str, Path], tmp_path: Path
) -> None:
    from typer.testing import CliRunner

    from narrows.cli import app

    given = [word.format(**{kind: str(path) for kind, path in files.items()}) for word in words]
    done = CliRunner().invoke(app, ["diffusivity", *given, "--out", str(tmp_path / "out")])
    assert done.exit_code == 2
    assert message in " ".join(done.output.split())
    assert not (tmp_path / "out").exists()

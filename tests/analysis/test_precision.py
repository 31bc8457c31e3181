import math
from functools import partial

import numpy as np
import pytest

from analysis import Estimate, correlated_mean
from analysis.precision import MARGIN, MOST_GROWTH, Precision, growth
from tests.analysis.processes import autoregressive

TWO_PERCENT = Precision.of_text("settling_speed=2%")


@pytest.mark.parametrize(
    ("text", "precision", "told"),
    [
        ("settling_speed=2%", TWO_PERCENT, "2 %"),
        ("settling_speed = 2 %", TWO_PERCENT, "2 %"),
        ("temperature=1e-3", Precision("temperature", 0.001, relative=False), "0.001"),
        ("d.p=0.1.middle=5%", Precision("d.p=0.1.middle", 0.05, relative=True), "5 %"),
    ],
)
def test_forms(text: str, precision: Precision, told: str) -> None:
    assert Precision.of_text(text) == precision
    assert str(precision) == told


@pytest.mark.parametrize(
    "text",
    [
        "",
        "speed",
        "=2%",
        "speed=",
        "speed=%",
        "speed=2 percent",
        "speed=0%",
        "speed=-1",
        "speed=nan",
    ],
)
def test_other_forms_are_refused(text: str) -> None:
    with pytest.raises(ValueError, match="must have the form QUANTITY=ERROR"):
        Precision.of_text(text)


def test_a_relative_error_is_that_of_the_modulus() -> None:
    assert TWO_PERCENT.is_met(Estimate(-0.5, 0.009))
    assert not TWO_PERCENT.is_met(Estimate(-0.5, 0.011))


def test_an_error_that_is_not_known_is_never_small_enough() -> None:
    assert not TWO_PERCENT.is_met(Estimate(1.0, 0.001, "lower bound: run longer"))
    assert TWO_PERCENT.growth(Estimate(1.0, 0.001, "lower bound: run longer")) > 1
    for missing in (Estimate(None, None, "too short"), Estimate(1.0, None), Estimate(0.0, 0.1)):
        assert TWO_PERCENT.reached(missing) == math.inf
        assert TWO_PERCENT.growth(missing) == MOST_GROWTH


def test_an_error_of_few_degrees_of_freedom_counts_by_its_interval() -> None:
    """Student's t of 4 degrees of freedom: 2.776 at 95 %, against 1.960."""
    few = Estimate(1.0, 0.015, None, freedom=4)
    assert few.normal_error == pytest.approx(0.015 * 2.7764 / 1.95996, rel=1e-4)
    assert not TWO_PERCENT.is_met(few)
    assert TWO_PERCENT.is_met(Estimate(1.0, 0.014, None, freedom=4))
    assert Estimate(1.0, 0.1).normal_error == pytest.approx(0.1)


def test_time_grows_as_the_square_of_the_error_in_equal_steps() -> None:
    assert TWO_PERCENT.growth(Estimate(1.0, 0.028)) == pytest.approx(MARGIN * 1.96)
    assert TWO_PERCENT.growth(Estimate(1.0, 0.04)) == pytest.approx(math.sqrt(MARGIN * 4))
    assert TWO_PERCENT.growth(Estimate(1.0, 1e9)) <= MOST_GROWTH


def test_the_quantity_that_needs_most_decides() -> None:
    asked = [TWO_PERCENT, Precision.of_text("temperature=0.001")]
    known = {"settling_speed": Estimate(1.0, 0.01), "temperature": Estimate(1.0, 0.0012)}
    assert growth(asked, known) == pytest.approx(MARGIN * 1.44)
    assert growth(asked[:1], known) == 1
    with pytest.raises(ValueError, match=r"^viscosity: not among .* settling_speed, temperature$"):
        growth([Precision.of_text("viscosity=1")], known)


def stopped(random: np.random.Generator, precision: Precision, first: int) -> tuple[float, float]:
    """Value and error of a run of AR(1) about 1 that is looked at from `first` samples on."""
    length, longest = first, 200_000
    series = 1 + 0.3 * autoregressive(5.0, longest, random)
    while True:
        estimate = correlated_mean.mean(series[:length])
        factor = precision.growth(estimate)
        if factor == 1:
            return estimate.number, estimate.standard_error
        length = math.ceil(length * factor)


def test_runs_that_stop_when_precise_have_the_error_asked_for() -> None:
    """60 runs: their spread is known to 9 %, and a bias of 0.4 errors would be three of its own."""
    run = partial(stopped, np.random.default_rng(5), TWO_PERCENT, 200)
    values, errors = np.array([run() for _ in range(60)]).T
    assert np.all(errors <= 0.02 * values)
    assert values.std(ddof=1) < 0.02 * (1 + 3 * 0.09)
    assert abs(values.mean() - 1) < 3 * values.std(ddof=1) / math.sqrt(60)

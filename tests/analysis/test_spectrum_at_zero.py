"""The model of the slow modes, against closed forms and direct integration."""

import math

import numpy as np
import pytest
from scipy import fft, stats

from analysis.spectrum_at_zero import Fluctuation, _mode_variances, fluctuation_of_mean
from tests.analysis.processes import autoregressive


@pytest.mark.parametrize("time", [3.0, 20.0, 60.0, 200.0])
def test_mode_variances_are_those_of_the_covariance_matrix(time: float) -> None:
    count = 200
    edges, variance = _mode_variances(count, (time,))
    lags = np.abs(np.subtract.outer(np.arange(count), np.arange(count)))
    modes = fft.dct(np.eye(count), norm="ortho", axis=0)
    factor = math.exp(-1 / time)
    spectrum_at_zero = (1 + factor) / (1 - factor)
    exact = np.diag(modes @ factor**lags @ modes.T) / spectrum_at_zero
    assert edges[:9].tolist() == list(range(1, 10))
    # the closed form is that of continuous time: right to order 1/time
    assert variance[0, :5] == pytest.approx(exact[:5], rel=0.15 / time + 0.02)


def test_student_of_one_part_is_that_part() -> None:
    one = Fluctuation(np.array([0.2]), np.array([1.0]), 7.0, np.zeros(1))
    assert one.half_width(0.95) == pytest.approx(0.2 * stats.t.ppf(0.975, 7), rel=1e-3)
    assert one.student() == pytest.approx((0.2, 7.0), rel=1e-2)


def test_mixture_keeps_its_intervals() -> None:
    mixture = Fluctuation(np.array([0.1, 0.3]), np.array([0.8, 0.2]), 50.0, np.zeros(1))
    scale, freedom = mixture.student()
    for confidence in (0.6827, 0.95):
        width = scale * stats.t.ppf((1 + confidence) / 2, freedom)
        assert mixture.half_width(confidence) == pytest.approx(width, rel=0.01)
        tails = [2 * stats.t.sf(width / s, 50) for s in (0.1, 0.3)]
        assert 0.8 * tails[0] + 0.2 * tails[1] == pytest.approx(1 - confidence, rel=0.03)


def test_scale_and_units_do_not_matter() -> None:
    series = autoregressive(10.0, 3000, np.random.default_rng(1))
    one, other = fluctuation_of_mean([series]), fluctuation_of_mean([1e6 + 1e-3 * series])
    assert other.student()[0] == pytest.approx(1e-3 * one.student()[0], rel=1e-3)
    assert other.slow == pytest.approx(one.slow, rel=1e-3)


def test_slow_motion_is_told_where_it_is_likely() -> None:
    none = Fluctuation(np.ones(1), np.ones(1), 7.0, np.array([0.0, 1.0, 2.0, 3.0, 4.0, 50.0]))
    assert none.slower_than(10.0) is None
    assert none.slower_than(3.5) == 27.0


def test_many_samples_are_those_of_their_blocks() -> None:
    series = autoregressive(50.0, 20_000, np.random.default_rng(2))
    blocks = series.reshape(-1, 20).mean(axis=1)
    assert fluctuation_of_mean([series]).student() == pytest.approx(
        fluctuation_of_mean([blocks]).student(), rel=0.05
    )

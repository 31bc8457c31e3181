"""The current of the channel and the ASEP form of the thesis, printed and corrected."""

import numpy as np
import pytest

from analysis.estimate import Estimate
from analysis.flux import asep_form, current

SLOPE, INTERCEPT, FRAME = 5.71, 0.019, 0.12  # Fig. 5.1; any frame faster than c'
RHO = np.linspace(0, 0.025, 11)


def test_erratum_5_3_corrected_form_is_the_current() -> None:
    form = asep_form(SLOPE, INTERCEPT, FRAME)
    assert form.current(RHO) == pytest.approx(RHO * (SLOPE * RHO + INTERCEPT - FRAME))
    assert form.bias < 0
    assert form.current(form.full) == pytest.approx(0.0)


def test_erratum_5_3_printed_form_is_not() -> None:
    p = SLOPE / (FRAME - INTERCEPT)
    rho = RHO[1:6]  # up to 0.0125; the current vanishes again at 0.0177
    printed, current_5_3 = p * rho * (1 - rho), rho * (SLOPE * rho + INTERCEPT - FRAME)
    assert np.all(printed > 0)
    assert np.all(current_5_3 < 0)
    assert np.all(printed > 100 * -current_5_3)


@pytest.mark.parametrize("frame", [-1.0, 0.0, 0.05, 1.0])
def test_current_is_convex_in_every_frame(frame: float) -> None:
    assert np.all(np.diff(asep_form(SLOPE, INTERCEPT, frame).current(RHO), 2) > 0)


def test_current_scales_the_error() -> None:
    found = current(0.02, Estimate(0.13, 0.01))
    assert (found.value, found.error) == pytest.approx((0.0026, 0.0002))

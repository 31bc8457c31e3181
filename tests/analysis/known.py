"""Estimates that must have a value and an error."""

from analysis.estimate import Estimate


def known(estimate: Estimate) -> tuple[float, float]:
    """Value and error; a test fails where either is missing."""
    assert estimate.value is not None
    assert estimate.error is not None
    return estimate.value, estimate.error

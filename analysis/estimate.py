"""A measured number with its error, and the arithmetic of such numbers.

An error from a run is itself measured. `freedom` says how well, in the terms of the Guide to the
expression of uncertainty in measurement (JCGM 100:2008, annex G): (value - truth) / error follows
Student's t with that many degrees of freedom. Arithmetic is to first order in the errors and takes
the numbers as independent; numbers from one run go through `analysis/correlated_mean.py`.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy import special, stats

from analysis.arrays import Array

LEAST_INDEPENDENT = 6  # below, an error from a spread is itself uncertain by a third
SPREAD_BEYOND_ERRORS = 0.01  # chance of a spread of repeats at which their own errors are given up
SHARP = 2  # standard errors from 0 of a divisor; below, the first order in its error means little


@dataclass(frozen=True)
class Estimate:
    """A number and its standard error.

    `reason` says why either is None, or why the error is only a lower bound. `freedom` is the
    degrees of freedom of the error; infinite for a normal distribution.
    """

    value: float | None
    error: float | None
    reason: str | None = None
    freedom: float = math.inf

    @property
    def number(self) -> float:
        """The value.

        Raises:
            ValueError: when there is none, with the reason.
        """
        if self.value is None:
            raise ValueError(f"no value: {self.reason or 'not measured'}")
        return self.value

    @property
    def standard_error(self) -> float:
        """The error.

        Raises:
            ValueError: when there is none, with the reason.
        """
        if self.error is None:
            raise ValueError(f"no error: {self.reason or 'not measured'}")
        return self.error

    def half_width(self, confidence: float = 0.95) -> float:
        """Half of the interval that holds the truth with this probability.

        Raises:
            ValueError: when there is no error, or for a probability outside (0, 1).
        """
        if not 0 < confidence < 1:
            raise ValueError(f"confidence = {confidence!r}: must be between 0 and 1")
        return self.standard_error * float(stats.t.ppf((1 + confidence) / 2, self.freedom))

    @property
    def normal_error(self) -> float:
        """The standard error of a normal distribution whose 95 % interval is as wide.

        With few degrees of freedom it is larger than the standard error.

        Raises:
            ValueError: when there is no error.
        """
        return self.half_width() / float(stats.norm.ppf(0.975))

    def interval(self, confidence: float = 0.95) -> tuple[float, float]:
        """Where the truth lies with this probability, low and high; as `half_width`."""
        half = self.half_width(confidence)
        return self.number - half, self.number + half

    def deviation(self, other: "Estimate | float") -> float:
        """How far this lies from another, independent number, in normal standard deviations.

        The deviate of a normal distribution that is as improbable as the difference is for its
        error and freedom; so 2 means the same with few degrees of freedom as with many.

        Raises:
            ValueError: when a value or an error is missing.
        """
        apart = self - other
        if apart.number == 0:
            return 0.0
        if apart.standard_error == 0:
            return math.copysign(math.inf, apart.number)
        tail = special.stdtr(apart.freedom, -abs(apart.number) / apart.standard_error)
        return math.copysign(-float(special.ndtri(tail)), apart.number)

    def __neg__(self) -> "Estimate":
        return self * -1

    def __add__(self, other: "Estimate | float") -> "Estimate":
        return _combined(lambda a, b: a + b, lambda a, b: (1.0, 1.0), self, other)

    def __sub__(self, other: "Estimate | float") -> "Estimate":
        return _combined(lambda a, b: a - b, lambda a, b: (1.0, -1.0), self, other)

    def __mul__(self, other: "Estimate | float") -> "Estimate":
        return _combined(lambda a, b: a * b, lambda a, b: (b, a), self, other)

    def __truediv__(self, other: "Estimate | float") -> "Estimate":
        divisor = as_estimate(other)
        if divisor.value == 0:
            return Estimate(None, None, _reasons(self, divisor, "division by 0"))
        ratio = _combined(lambda a, b: a / b, lambda a, b: (1 / b, -a / b**2), self, divisor)
        if divisor.value and divisor.error and abs(divisor.value) < SHARP * divisor.error:
            blurred = f"the divisor is 0 within {SHARP} of its errors"
            return replace(ratio, reason=_reasons(ratio, blurred))
        return ratio

    def __radd__(self, other: float) -> "Estimate":
        return self + other

    def __rsub__(self, other: float) -> "Estimate":
        return as_estimate(other) - self

    def __rmul__(self, other: float) -> "Estimate":
        return self * other

    def __rtruediv__(self, other: float) -> "Estimate":
        return as_estimate(other) / self

    def sqrt(self) -> "Estimate":
        """Square root; of 0, the root of the error is its error."""
        if self.value is None:
            return self
        if self.value < 0:
            return Estimate(None, None, _reasons(self, "the square root of a negative number"))
        root = math.sqrt(self.value)
        if self.error is None:
            return replace(self, value=root)
        error = self.error / (2 * root) if root > 0 else math.sqrt(self.error)
        return replace(self, value=root, error=error)

    def scaled(self, factor: float) -> "Estimate":
        """The estimate in other units: value times the factor, error times its modulus."""
        return self * factor

    def as_json(self) -> dict[str, Any]:
        """`{value, error}`, `freedom` where it is finite and `reason` where there is one."""
        entry: dict[str, Any] = {"value": self.value, "error": self.error}
        if math.isfinite(self.freedom):
            entry["freedom"] = self.freedom
        if self.reason is not None:
            entry["reason"] = self.reason
        return entry

    @classmethod
    def of_json(cls, entry: Mapping[str, Any]) -> "Estimate":
        """What `as_json` wrote; other keys are left alone."""
        freedom = entry.get("freedom", math.inf)
        return cls(entry["value"], entry["error"], entry.get("reason"), freedom)


def as_estimate(number: Estimate | float) -> Estimate:
    """An exact number as an estimate with error 0."""
    return number if isinstance(number, Estimate) else Estimate(float(number), 0.0)


def mean_of_independent(samples: ArrayLike) -> Estimate:
    """Mean of independent samples, as of runs that differ in their seed, with its standard error.

    The error s / sqrt(n) has n - 1 degrees of freedom.

    Args:
        samples: (n,).
    """
    values = np.asarray(samples, dtype=float)
    if len(values) == 0:
        return Estimate(None, None, "no samples")
    if len(values) == 1:
        return Estimate(float(values[0]), None, "one sample has no error")
    error = float(values.std(ddof=1) / math.sqrt(len(values)))
    uncertain = None
    if len(values) < LEAST_INDEPENDENT:
        uncertain = f"error from {len(values)} samples, so uncertain itself"
    return Estimate(float(values.mean()), error, uncertain, len(values) - 1)


def mean_of_repeats(repeats: Sequence[Estimate]) -> Estimate:
    """Mean of independent repeats of one measurement, from their own errors and their spread.

    Both tell the error: the repeats' own errors e, sum e^2 / R^2, and their spread, s^2 / R with
    R - 1 degrees of freedom. The two variances are averaged with their degrees of freedom as
    weights, unless the spread is beyond the errors by Fisher's F at `SPREAD_BEYOND_ERRORS`: the
    runs then missed something slow, and the spread alone counts. Repeats without a value are left
    out, and the reason says so; so are errors if one is missing.
    """
    known = [repeat for repeat in repeats if repeat.value is not None]
    if not known:
        return repeats[0] if repeats else Estimate(None, None, "no repeats")
    left_out = "" if len(known) == len(repeats) else f"{len(known)} of {len(repeats)} repeats tell"
    if len(known) == 1:
        return replace(known[0], reason=_reasons(known[0], left_out))
    spread = mean_of_independent([repeat.number for repeat in known])
    within = sum(known[1:], known[0]) / len(known)
    if within.error is None or within.error == 0:
        return replace(spread, reason=_reasons(left_out, spread))
    ratio = (spread.standard_error / within.error) ** 2
    if stats.f.sf(ratio, spread.freedom, min(within.freedom, 1e9)) < SPREAD_BEYOND_ERRORS:
        beyond = "the repeats spread beyond their own errors"
        return replace(spread, reason=_reasons(left_out, spread, beyond))
    if math.isinf(within.freedom):
        return replace(within, reason=_reasons(left_out, within))
    freedom = spread.freedom + within.freedom
    pooled = (spread.freedom * ratio + within.freedom) / freedom
    error = within.error * math.sqrt(pooled)
    return Estimate(spread.value, error, _reasons(left_out, within), freedom)


def jackknife(statistic: Callable[[Any], float], segments: Array) -> Estimate:
    """A statistic of the mean over independent segments, with its delete-one jackknife error.

    Args:
        statistic: of an array (...).
        segments: (S, ...), S at least 2.
    """
    count = len(segments)
    left_out = [statistic(np.delete(segments, n, axis=0).mean(axis=0)) for n in range(count)]
    error = float(np.sqrt((count - 1) * np.var(left_out)))
    return Estimate(float(statistic(segments.mean(axis=0))), error, None, count - 1)


def joint_freedom(shares: Sequence[float], freedoms: Sequence[float]) -> float:
    """Degrees of freedom of a sum of variances, by Welch and Satterthwaite (JCGM 100:2008, G.2b).

    Args:
        shares: the variances, in any unit.
        freedoms: the degrees of freedom of each.
    """
    total = sum(shares)
    if total == 0:
        return math.inf
    inverse = sum((s / total) ** 2 / f for s, f in zip(shares, freedoms, strict=True) if s > 0)
    return 1 / inverse if inverse > 0 else math.inf


def _combined(function: Any, gradient: Any, one: Estimate, other: Estimate | float) -> Estimate:
    """A function of two independent numbers, to first order in their errors."""
    second = as_estimate(other)
    reason = _reasons(one, second)
    if one.value is None or second.value is None:
        return Estimate(None, None, reason or "not measured")
    value = float(function(one.value, second.value))
    if one.error is None or second.error is None:
        return Estimate(value, None, reason)
    slopes = gradient(one.value, second.value)
    parts = [abs(s) * e for s, e in zip(slopes, (one.error, second.error), strict=True)]
    freedom = joint_freedom([part**2 for part in parts], [one.freedom, second.freedom])
    return Estimate(value, math.hypot(*parts), reason, freedom)


def _reasons(*sources: Estimate | str) -> str | None:
    """All that is to be said, each once."""
    texts = [source.reason if isinstance(source, Estimate) else source for source in sources]
    return "; ".join(dict.fromkeys(text for text in texts if text)) or None

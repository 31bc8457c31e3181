"""How precisely a quantity is wanted, and how much longer a run must be to know it so.

A run is looked at, made longer by what its error asks for, and looked at again, until every error
is small enough. It stops only at errors that are known, `reason` None.

A rule that looks often stops at the first error that happens to be too small; and where large
values fluctuate more, at a value that happens to be small. So looks are few and far apart: the last
one, too, is decided by the first half of the run or less. And an error of few degrees of freedom
counts by its interval of 95 %, `Estimate.normal_error`. `benchmarks/precision.py` measures what is
left of bias.
"""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Self

from analysis.estimate import Estimate

LEAST_GROWTH, MOST_GROWTH = 1.25, 2.5  # of the sampled time from one look to the next
MARGIN = 1.2  # of the time that the error asks for, which is itself an estimate


@dataclass(frozen=True)
class Precision:
    """The standard error at which a quantity is known well enough.

    Attributes:
        quantity: as in summary.json, nested ones by their path: `diffusion.exponent`.
        error: in the unit of the quantity, or as a fraction of its value.
        relative: whether it is a fraction.
    """

    quantity: str
    error: float
    relative: bool

    @classmethod
    def of_text(cls, text: str) -> Self:
        """`settling_speed=2%`, or `temperature=0.001` in the unit of the quantity.

        >>> Precision.of_text("settling_speed=2%")
        Precision(quantity='settling_speed', error=0.02, relative=True)

        Raises:
            ValueError: for another form, or an error that is not positive.
        """
        quantity, separator, number = (part.strip() for part in text.rpartition("="))
        relative = number.endswith("%")
        try:
            error = float(number.removesuffix("%")) * (0.01 if relative else 1.0)
        except ValueError:
            error = math.nan
        if not separator or not quantity or not 0 < error < math.inf:
            raise ValueError(
                f"{text!r}: must have the form QUANTITY=ERROR with an error above 0, "
                "as settling_speed=2% or temperature=0.001"
            )
        return cls(quantity, error, relative)

    def __str__(self) -> str:
        return f"{100 * self.error:.3g} %" if self.relative else f"{self.error:.3g}"

    def reached(self, estimate: Estimate) -> float:
        """The normal error of an estimate in these terms, infinite without a value or an error."""
        if estimate.value is None or estimate.error is None:
            return math.inf
        if not self.relative:
            return estimate.normal_error
        return estimate.normal_error / abs(estimate.value) if estimate.value else math.inf

    def is_met(self, estimate: Estimate) -> bool:
        """Whether the error is known, and small enough."""
        return estimate.reason is None and self.reached(estimate) <= self.error

    def growth(self, estimate: Estimate) -> float:
        """By how much the sampled time should be multiplied before the next look; 1: enough.

        Equal steps to the time that the error asks for, none longer than `MOST_GROWTH`.
        """
        if self.is_met(estimate):
            return 1.0
        wanted = MARGIN * (self.reached(estimate) / self.error) ** 2
        if not math.isfinite(wanted):
            return MOST_GROWTH
        steps = max(1, math.ceil(math.log(wanted) / math.log(MOST_GROWTH))) if wanted > 1 else 1
        return float(max(wanted ** (1 / steps), LEAST_GROWTH))

    def told(self, estimate: Estimate) -> str:
        """`settling_speed = 0.0319 +- 0.0012: 3.8 %, 2 % asked`."""
        if estimate.value is None or estimate.error is None:
            return f"{self.quantity} not known yet, {self} asked"
        reached = Precision(self.quantity, self.reached(estimate), self.relative)
        number = f"{self.quantity} = {estimate.value:.4g} +- {estimate.error:.2g}"
        known = "" if estimate.reason is None else f" ({estimate.reason})"
        return f"{number}: {reached}, {self} asked{known}"


def growth(precisions: Iterable[Precision], estimates: Mapping[str, Estimate]) -> float:
    """By how much the time must be multiplied for all of them; 1: every one is met.

    Raises:
        ValueError: for a quantity that is not among the estimates.
    """
    factors = [1.0]
    for precision in precisions:
        if precision.quantity not in estimates:
            known = ", ".join(estimates) or "none"
            raise ValueError(f"{precision.quantity}: not among what the run tells; that is {known}")
        factors.append(precision.growth(estimates[precision.quantity]))
    return max(factors)

"""Numbers beside those of a paper, and whether they agree.

A measured number agrees with a printed one if they differ by no more than twice the joint standard
error plus what the printed digits leave open; of errors with few degrees of freedom, by what is as
improbable by Student's t. A paper's claim without a number (it grows, it does
not depend on phi) is put as one: a measured number that the claim says is positive, or zero.
"""

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path
from typing import Any, Literal

from analysis.estimate import Estimate
from run_files.writing import replace_text

CONFIDENCE = 0.9545  # that of two standard errors of a normal distribution

Sign = Literal["zero", "positive"]


@dataclass(frozen=True)
class PaperNumber:
    """A number as a paper prints it.

    Attributes:
        value: the number.
        reading: what the printed digits leave open, one unit of the last one: papers cut digits off
            as often as they round them.
        error: its standard error, where the paper gives one.
    """

    value: float
    reading: float = 0.0
    error: float | None = None

    @classmethod
    def printed(cls, text: str) -> "PaperNumber":
        """The number from its digits: `0.34` is read to 0.01."""
        exponent = Decimal(text).as_tuple().exponent
        assert isinstance(exponent, int)
        return cls(float(text), 10.0**exponent)


@dataclass(frozen=True)
class Result:
    """One entry of results.json.

    Attributes:
        figure: of the paper, as `4.6`.
        quantity: in words, with its unit.
        measured: ours.
        paper: what the paper prints, where it prints a number.
        claim: what the paper says in words, where it does.
        agrees: None where nothing is compared, or the errors do not decide.
        note: what a reader of the verdict should know.
    """

    figure: str
    quantity: str
    measured: Estimate
    paper: PaperNumber | None = None
    claim: str | None = None
    agrees: bool | None = None
    note: str | None = None

    def as_json(self) -> dict[str, Any]:
        """The entry; numbers that are not known are null."""
        paper, freedom = self.paper, self.measured.freedom
        notes = [note for note in (self.measured.reason, self.note) if note]
        return {
            "figure": self.figure,
            "quantity": self.quantity,
            "value": self.measured.value,
            "error": self.measured.error,
            "freedom": freedom if math.isfinite(freedom) else None,
            "paper": paper.value if paper else None,
            "paper_error": paper.error if paper else None,
            "paper_reading": paper.reading if paper else None,
            "claim": self.claim,
            "agrees": self.agrees,
            "note": "; ".join(notes) or None,
        }


def measured(figure: str, quantity: str, value: Estimate, note: str | None = None) -> Result:
    """A number that the paper does not give."""
    return Result(figure, quantity, value, note=note)


def compared(
    figure: str, quantity: str, value: Estimate, paper: PaperNumber, note: str | None = None
) -> Result:
    """A number beside the paper's."""
    agrees = None
    if value.value is not None and value.error is not None:
        apart = value - Estimate(paper.value, paper.error or 0.0)
        rounding = 1e-9 * abs(paper.value)
        allowed = apart.half_width(CONFIDENCE) + paper.reading + rounding
        agrees = bool(abs(apart.number) <= allowed)
    return Result(figure, quantity, value, paper, None, agrees, note)


def claimed(
    figure: str, quantity: str, value: Estimate, claim: str, sign: Sign, note: str | None = None
) -> Result:
    """A number whose sign, or vanishing, a claim of the paper predicts.

    `positive` holds beyond two errors above zero, fails beyond two below, and is open between;
    `zero` holds within two errors.
    """
    agrees = None
    if value.value is not None and value.error is not None:
        reach = value.half_width(CONFIDENCE)
        if sign == "zero":
            agrees = bool(abs(value.value) <= reach)
        elif abs(value.value) > reach:
            agrees = bool(value.value > 0)
    return Result(figure, quantity, value, None, claim, agrees, note)


def write_results(path: Path, results: Sequence[Result]) -> None:
    """Write results.json."""
    entries = [result.as_json() for result in results]
    replace_text(path, json.dumps(entries, indent=2, allow_nan=False, ensure_ascii=False) + "\n")

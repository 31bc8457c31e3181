import json
from pathlib import Path

import pytest

from analysis.estimate import Estimate
from narrows.papers.page import count_verdicts
from narrows.papers.results import PaperNumber, Sign, claimed, compared, measured, write_results


@pytest.mark.parametrize(
    ("text", "value", "reading"),
    [("0.729", 0.729, 1e-3), ("5.71", 5.71, 1e-2), ("0.6179", 0.6179, 1e-4), ("12", 12.0, 1.0)],
)
def test_what_printed_digits_leave_open(text: str, value: float | None, reading: float) -> None:
    paper = PaperNumber.printed(text)
    assert (paper.value, paper.error) == (value, None)
    assert paper.reading == pytest.approx(reading)


@pytest.mark.parametrize(
    ("value", "error", "paper", "agrees"),
    [
        # two errors of 0.003 and one unit of the last digit, 0.01, reach to 0.016
        (0.355, 0.003, PaperNumber.printed("0.34"), True),
        (0.357, 0.003, PaperNumber.printed("0.34"), False),
        (0.325, 0.003, PaperNumber.printed("0.34"), True),
        (0.323, 0.003, PaperNumber.printed("0.34"), False),
        # errors of 3 and 4 are jointly 5, two of them 10
        (109.0, 3.0, PaperNumber(100.0, error=4.0), True),
        (111.0, 3.0, PaperNumber(100.0, error=4.0), False),
        # digits cut off, not rounded: 0.7556 printed as 0.755
        (0.75556, 0.0, PaperNumber.printed("0.755"), True),
        (0.75601, 0.0, PaperNumber.printed("0.755"), False),
        (0.34, None, PaperNumber.printed("0.34"), None),
        (None, None, PaperNumber.printed("0.34"), None),
    ],
)
def test_agreement_with_a_printed_number(
    value: float | None, error: float | None, paper: PaperNumber, agrees: bool | None
) -> None:
    assert compared("1", "x", Estimate(value, error), paper).agrees is agrees


@pytest.mark.parametrize(
    ("value", "sign", "agrees"),
    [
        (0.21, "positive", True),
        (0.19, "positive", None),
        (-0.19, "positive", None),
        (-0.21, "positive", False),
        (0.19, "zero", True),
        (-0.21, "zero", False),
    ],
)
def test_agreement_with_a_claim(value: float | None, sign: Sign, agrees: bool | None) -> None:
    assert claimed("1", "x", Estimate(value, 0.1), "it grows", sign).agrees is agrees


def test_an_error_of_few_degrees_of_freedom_reaches_further() -> None:
    """Student's t of 3 degrees of freedom: 95.45 % lie within 3.31 errors."""
    for value, agrees in ((0.32, True), (0.34, False)):
        estimate = Estimate(value, 0.1, None, freedom=3)
        assert claimed("1", "x", estimate, "it vanishes", "zero").agrees is agrees
        assert compared("1", "x", estimate, PaperNumber(0.0)).agrees is agrees


def test_results_json(tmp_path: Path) -> None:
    lower_bound = Estimate(0.3, 0.1, "at least: 2 samples are too few")
    results = [
        compared("4.10", "slope", Estimate(0.33, 0.01), PaperNumber.printed("0.34")),
        claimed("4.8", "slope", lower_bound, "no correlation", "zero", "two seeds"),
        measured("4.9", "Reynolds number", Estimate(0.1, None, "one sample has no error")),
    ]
    write_results(tmp_path / "results.json", results)
    found = json.loads((tmp_path / "results.json").read_text())
    assert found[0] == {
        "figure": "4.10",
        "quantity": "slope",
        "value": 0.33,
        "error": 0.01,
        "freedom": None,
        "paper": 0.34,
        "paper_error": None,
        "paper_reading": 0.01,
        "claim": None,
        "agrees": True,
        "note": None,
    }
    assert found[1]["paper"] is None
    assert found[1]["claim"] == "no correlation"
    assert found[1]["agrees"] is False
    assert found[1]["note"] == "at least: 2 samples are too few; two seeds"
    assert (found[2]["paper"], found[2]["agrees"]) == (None, None)
    assert count_verdicts(results) == {"agrees": 1, "disagrees": 1, "open": 0}

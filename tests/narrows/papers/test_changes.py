"""The table of verdicts that changed."""

from pathlib import Path

from analysis.estimate import Estimate
from narrows.papers import changes
from narrows.papers.results import PaperNumber, Result, claimed, compared, write_results


def results(speed: Estimate, slope: Estimate) -> list[Result]:
    return [
        compared("4.6", "v_s", speed, PaperNumber(1.0)),
        claimed("4.8", "slope", slope, "it does not depend on phi", "zero"),
        claimed("4.9", "only now", slope, "it grows", "positive"),
    ]


def test_rows_are_the_verdicts_that_changed(tmp_path: Path) -> None:
    old, new, page = (tmp_path / name for name in ("old.json", "new.json", "page.md"))
    write_results(old, results(Estimate(1.1, 0.02), Estimate(0.1, 0.1))[:2])
    write_results(new, results(Estimate(1.11, 0.06, None, 8), Estimate(0.11, 0.09)))
    page.write_text("before\n<!-- changed -->\n<!-- end of changed -->\nafter\n")
    changes.main(str(old), str(new), str(page), "changed")
    rows = [line for line in page.read_text().splitlines() if line.startswith("| 4")]
    assert rows == [
        "| 4.6 | v_s | 1.10 +- 0.02 | **no** | 1.11 +- 0.06 | yes | "
        "the error is 3 times that before; the error has 8 degrees of freedom |"
    ]


def test_another_sample_is_told() -> None:
    old = {"value": 1.0, "error": 0.1}
    assert changes.reason(old, {"value": 1.3, "error": 0.1}) == "2.1 joint errors from before"
    assert changes.reason(old, {"value": 1.05, "error": 0.1}) == "close to the limit in both"
    many = {"value": 1.05, "error": 0.1, "freedom": 150.0}
    assert changes.reason(old, many) == "close to the limit in both"
    assert changes.reason(old, {"value": None, "error": None}) == "known in one of them only"

